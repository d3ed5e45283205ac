"""Kinds of options, options that several commands share, and groups of them."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from seacage.service._cli._console import refusal

if TYPE_CHECKING:
    from seacage.cage import Cage, Structure
    from seacage.ocean import SeaState
    from seacage.records import Record


InFile = Annotated[Path | None, typer.Option(exists=True, dir_okay=False)]
InFolder = Annotated[Path | None, typer.Option(exists=True, file_okay=False)]
OutFile = Annotated[Path | None, typer.Option(dir_okay=False)]
OutFolder = Annotated[Path | None, typer.Option(file_okay=False)]
Seed = Annotated[int, typer.Option(min=0)]
CageName = Annotated[
    str, typer.Option("--cage", help="A cage that comes with seacage, or the path of a TOML file.")
]
Law = Annotated[
    str,
    typer.Option(
        help="How the water loads the netting: kristiansen-faltinsen, loland, aarsnes, in time "
        "also morison, or an installed law."
    ),
]
Mooring = Annotated[
    Literal["catenary", "springs"],
    typer.Option(help="What holds the frame: buoys and anchor lines, or springs (old campaigns)."),
]
Without = Annotated[
    list[str] | None,
    typer.Option(help="A line that has parted, such as bridle-8; again for each further one."),
]
SpinUp = Annotated[
    float, typer.Option(help="Simulated first and thrown away, s; the waves rise in it.")
]
Workers = Annotated[int | None, typer.Option(min=1, help="Processes. [default: one per core]")]
Columns = Annotated[
    str | None,
    typer.Option(help="Map of the file: a TOML file or a shipped name; else by the header."),
]
ServedCage = Annotated[str, typer.Option("--cage", help="The cage's name there.")]
DataFolder = Annotated[Path, typer.Option(file_okay=False, help="The service's data folder.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class SeaOptions:
    """One sea state.

    Options:
        current_speed: m/s
        current_to: Where the current goes, degrees clockwise from north.
        hs: Significant wave height, m.
        tp: Peak period, s. [default: 5 √hs]
        wave_from: Where the waves come from, degrees clockwise from north.
    """

    current_speed: float
    current_to: float
    hs: float = 0.0
    tp: float | None = None
    wave_from: float = 0.0

    def state(self) -> "SeaState":
        """The sea state that they describe."""
        from seacage.ocean import SeaState

        return SeaState(**asdict(self))


@dataclass(frozen=True, slots=True, kw_only=True)
class LawOptions:
    """What the water does to the netting.

    Options:
        laws: Answer by every law instead of one: lowest, central and highest.
        skin_friction: Drag coefficient of a panel along the flow, of screen laws. [default: the
            law's own]
        lift_factor: Factor on the lift of screen laws.
    """

    laws: Literal["all"] | None = None
    skin_friction: float | None = None
    lift_factor: float = 1.0

    @property
    def changes(self) -> dict[str, float]:
        """What is changed of a law, as `settle` and `simulate` take it."""
        given = {"skin_friction": self.skin_friction, "lift_factor": self.lift_factor}
        return {k: v for k, v in given.items() if v is not None and (k, v) != ("lift_factor", 1.0)}

    def check_files(self, *files: Path | None) -> None:
        """Refuse files where several laws answer: they hold one."""
        if self.laws is not None and any(files):
            raise refusal(
                "--laws all has one answer for each law, and a file holds one. Leave --laws out, "
                "or the file."
            )


def warn(sentences: Iterable[str]) -> None:
    """Print what to know of an answer on stderr."""
    for sentence in sentences:
        typer.echo(f"seacage: warning: {sentence}", err=True)


def read_cage(name: str) -> "Cage":
    """A shipped cage by its name, else a file; what the cage warns of goes to stderr."""
    from seacage.cage import Cage

    found = Cage.read(name) if name.endswith(".toml") else Cage.named(name)
    warn(found.warnings)
    return found


def read_cage_or_structure(name: str) -> "Cage | Structure":
    """The same, or a cage of another topology, whose file is one with rings."""
    from seacage.cage import cage_or_structure
    from seacage.conventions import read_text

    if not name.endswith(".toml"):
        return read_cage(name)
    found = cage_or_structure(read_text(name), source=name)
    warn(found.warnings)
    return found


def warn_of(mooring: str) -> tuple[str, ...]:
    """What a mooring is warned of, also to stderr."""
    from seacage.dynamics import SPRINGS

    warnings = (f"mooring = {mooring}: {SPRINGS}",) if mooring == "springs" else ()
    warn(warnings)
    return warnings


def read_share(text: str | None) -> tuple[int, int]:
    """Which share of how many, from I/N."""
    which, slash, shares = (text or "0/1").partition("/")
    if not (slash and which.isdigit() and shares.isdigit()):
        raise refusal(f"--share {text}: expected I/N, as 0/8 for the first of 8 shares.")
    return int(which), int(shares)


def read_streams(path: Path, **reading: Any) -> "list[Record]":
    """The record of a file, read as ``read_record`` does; of a field record's folder all."""
    from seacage.records import FieldRecord, read_record

    if path.is_dir():
        field = FieldRecord.read(path)
        return [field.buoy, *field.sensors.values()]
    return [read_record(path, **reading)]
