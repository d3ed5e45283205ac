"""``seacage train``: from simulations and sensors to a twin."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._cli._console import Json, guard, progress_bar, report
from seacage.service._cli._settle import read_cage

if TYPE_CHECKING:
    from seacage.cage import Cage
    from seacage.records import CampaignRecord
    from seacage.twin import Twin


@guard
def train(
    *,
    campaign: Annotated[
        Path | None,
        typer.Option(exists=True, file_okay=False, help="Simulations, as `campaign run` left."),
    ] = None,
    base: Annotated[
        Path | None,
        typer.Option(
            exists=True,
            file_okay=False,
            help="A twin whose level 1 is taken, instead of --campaign: only sensors that moved, "
            "or are new, are trained at level 2.",
        ),
    ] = None,
    field: Annotated[
        Path | None,
        typer.Option(exists=True, file_okay=False, help="A field record; else level 1 alone."),
    ] = None,
    out: Annotated[Path, typer.Option(file_okay=False, help="Folder of the twin.")],
    cage: Annotated[
        str | None,
        typer.Option(help="Where sensors have moved: a TOML file. [default: as simulated]"),
    ] = None,
    inputs: Annotated[
        Literal["current", "current,waves"], typer.Option(help="What the twin is asked with.")
    ] = "current",
    points: Annotated[
        int, typer.Option(min=20, max=5000, help="Readings that each sensor teaches with.")
    ] = 300,
    choice: Annotated[
        Literal["spread", "paper"],
        typer.Option(help="spread over currents and time, or the paper's few minutes or seconds."),
    ] = "spread",
    days: Annotated[
        float, typer.Option(min=0.1, help="Longest that a sensor teaches; the rest can judge.")
    ] = 25.0,
    seed: Annotated[int, typer.Option(min=0, help="Of the choice and the searches.")] = 0,
    sign: Annotated[
        Path | None, typer.Option(metavar="KEYFILE", help="Sign the twin with this key.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Train a twin from simulations and sensors.

    Simulations teach loads and shape; each sensor then corrects what it measures. The twin's
    folder holds JSON and safetensors sealed by SHA-256 sums; reading it runs no code. With
    --sign a service that has the same key takes it, and no other.

    Example:
        seacage train --campaign ace.zarr --field field --out twin
    """
    from seacage.conventions import NonsenseError
    from seacage.records import FieldRecord
    from seacage.twin import Training, read_key
    from seacage.twin import train as trained

    drawn, simulated, begun = _level_one(campaign, base)
    training = Training(
        inputs=("current", "waves") if inputs == "current,waves" else ("current",),
        high_fidelity_points=points,
        choice=choice,
        days=days,
        seed=seed,
    )
    key = read_key(sign) if sign else None
    try:
        with progress_bar() as progress:
            twin = trained(
                read_cage(cage) if cage else drawn,
                simulated,
                FieldRecord.read(field) if field else None,
                base=begun,
                training=training,
                progress=progress,
            )
    except NonsenseError as error:
        given = " with ".join(str(path) for path in (field, campaign or base) if path)
        raise NonsenseError(f"{given}: {error}") from error
    twin.write(out, key=key)
    windows = twin.provenance.training_windows
    levels = {name: 2 if name in windows else 1 for name in twin.sensor_names}
    counts = {name: windows[name].points if name in windows else 0 for name in levels}
    report(
        {"written": str(out), "origin": str(twin.origin), "cases": twin.provenance.cases}
        | {"level": levels, "points": counts}
        | {"calibrated": {name: window.calibrated for name, window in windows.items()}},
        as_json=as_json,
        rows=[
            ("Written", f"{out} ({twin.origin})"),
            ("Level 1", f"{twin.provenance.cases} simulations, {twin.provenance.law}"),
            *((name, f"level {level}, {counts[name]} readings") for name, level in levels.items()),
        ],
    )


def _level_one(
    campaign: Path | None, base: Path | None
) -> "tuple[Cage, CampaignRecord | None, Twin | None]":
    """The cage as simulated, and what teaches level 1 or has it."""
    from seacage.cage import Cage
    from seacage.conventions import InputError
    from seacage.records import read_campaign
    from seacage.twin import Twin

    if campaign and not base:
        simulated = read_campaign(campaign)
        return Cage.from_toml(simulated.cage_toml), simulated, None
    if base and not campaign:
        begun = Twin.read(base)
        return begun.cage, None, begun
    raise InputError("train: give either --campaign, which teaches level 1, or --base.")
