"""Kinds of options, options that several commands share, and groups of them."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

if TYPE_CHECKING:
    from seacage.cage import Cage
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
    Literal["kristiansen-faltinsen", "loland", "aarsnes", "morison"],
    typer.Option(help="How the water loads the netting."),
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

    Parameters
    ----------
    current_speed
        m/s
    current_to
        Where the current goes, degrees clockwise from north.
    hs
        Significant wave height, m.
    tp
        Peak period, s. [default: 5 √hs]
    wave_from
        Where the waves come from, degrees clockwise from north.
    """

    current_speed: float
    current_to: float
    hs: float = 0.0
    tp: float | None = None
    wave_from: float = 0.0

    def state(self) -> "SeaState":
        """The sea state that they describe."""
        from dataclasses import asdict

        from seacage.ocean import SeaState

        return SeaState(**asdict(self))


def read_cage(name: str) -> "Cage":
    """A shipped cage by its name, else a file; what the cage warns of goes to stderr."""
    from seacage.cage import Cage

    cage = Cage.read(name) if name.endswith(".toml") else Cage.named(name)
    for warning in cage.warnings:
        typer.echo(f"seacage: warning: {warning}", err=True)
    return cage


def warn_of(mooring: str) -> tuple[str, ...]:
    """What a mooring is warned of, also to stderr."""
    from seacage.dynamics import SPRINGS

    warnings = (f"mooring = {mooring}: {SPRINGS}",) if mooring == "springs" else ()
    for warning in warnings:
        typer.echo(f"seacage: warning: {warning}", err=True)
    return warnings


def read_share(text: str | None) -> tuple[int, int]:
    """Which share of how many, from I/N."""
    from seacage.conventions import InputError

    which, slash, shares = (text or "0/1").partition("/")
    if not (slash and which.isdigit() and shares.isdigit()):
        raise InputError(f"--share {text}: expected I/N, as 0/8 for the first of 8 shares.")
    return int(which), int(shares)


def read_streams(path: Path, **reading: Any) -> "list[Record]":
    """The record of a file, read as ``read_record`` does; of a field record's folder all."""
    from seacage.records import FieldRecord, read_record

    if path.is_dir():
        field = FieldRecord.read(path)
        return [field.buoy, *field.sensors.values()]
    return [read_record(path, **reading)]
