"""``seacage train``: from simulations and sensors to a twin."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._cli._console import progress_bar, refusal, report
from seacage.service._cli._options import InFolder, Seed, read_cage

if TYPE_CHECKING:
    from seacage.cage import Cage
    from seacage.records import CampaignRecord, FieldRecord
    from seacage.twin import Twin

_INPUTS: "dict[str, tuple[Literal['current', 'waves', 'profile'], ...]]" = {
    "current": ("current",),
    "current,waves": ("current", "waves"),
    "current,profile": ("current", "profile"),
}


def train(
    *,
    campaign: InFolder = None,
    base: InFolder = None,
    field: InFolder = None,
    parted: Annotated[
        list[Path] | None, typer.Option(exists=True, file_okay=False, metavar="DIR")
    ] = None,
    out: Annotated[Path, typer.Option(file_okay=False)],
    cage: str | None = None,
    inputs: Literal["current", "current,waves", "current,profile"] | None = None,
    points: Annotated[int, typer.Option(min=20, max=5000)] = 300,
    choice: Literal["spread", "paper"] = "spread",
    days: Annotated[float, typer.Option(min=0.1)] = 25.0,
    seed: Seed = 0,
    sign: Annotated[Path | None, typer.Option(metavar="KEYFILE")] = None,
) -> None:
    """Train a twin from simulations and sensors.

    Simulations teach loads and shape; each sensor then corrects what it measures. The twin's
    folder holds JSON and safetensors sealed by SHA-256 sums; reading it runs no code. With
    --sign a service that has the same key takes it, and no other.

    Example:
        seacage train --campaign ace.zarr --field field --out twin

    Options:
        campaign: Simulations, as `campaign run` left.
        base: A twin whose level 1 is taken, instead of --campaign: only sensors that moved, or are
            new, are trained at level 2.
        field: A field record; else level 1 alone.
        parted: What `campaign run --parted-lines` left, or a campaign without one line, in seas of
            --campaign: what would be left if a line parted is learned too. Again for each.
        out: Folder of the twin.
        cage: Where sensors have moved: a TOML file. [default: as simulated]
        inputs: What the twin is asked with. [default: the current, with its profile where
            simulations and field have one; the base's]
        points: Readings that each sensor teaches with.
        choice: spread over currents and time, or the paper's few minutes or seconds.
        days: Longest that a sensor teaches; the rest can judge.
        seed: Of the choice and the searches.
        sign: Sign the twin with this key.
    """
    from seacage.conventions import NonsenseError
    from seacage.records import FieldRecord, read_campaign
    from seacage.twin import Training, read_key
    from seacage.twin import train as trained

    drawn, simulated, begun = _level_one(campaign, base)
    record = FieldRecord.read(field) if field else None
    training = Training(
        inputs=_INPUTS[inputs] if inputs else _usual_inputs(simulated, begun, record),
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
                record,
                parted=[read_campaign(store) for store in _stores(parted or [])],
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
    kinds = twin.models.parted.kinds if twin.models.parted else ()
    lines = twin.models.line_upper
    left_out = _gaps(simulated.simulator, twin) if simulated and simulated.simulator else []
    report(
        {"written": out, "origin": twin.origin, "cases": twin.provenance.cases}
        | {"level": levels, "points": counts, "travel_time": twin.travel_time}
        | {"calibrated": {name: window.calibrated for name, window in windows.items()}}
        | {"parted": {one.line: [one.learned, one.simulated] for one in kinds}}
        | {"line_loads": lines, "left_out": left_out, "unlike": twin.unlike},
        rows=[
            ("Written", f"{out} ({twin.origin})"),
            ("Level 1", f"{twin.provenance.cases} simulations, {twin.provenance.law}"),
            ("Travel time", _travel_time(twin)),
            *(
                (f"Without {one.line}", f"{one.learned} of {one.simulated} simulations")
                for one in kinds
            ),
            *((name, f"level {level}, {counts[name]} readings") for name, level in levels.items()),
            *(
                (f"{name}, its line", f"level 2, {one.windows} windows, {one.rate}")
                for name, one in lines.items()
            ),
            *(("Left out", sentence) for sentence in left_out),
            *([("Unlike others", twin.unlike)] if twin.unlike else []),
        ],
    )


def _usual_inputs(
    campaign: "CampaignRecord | None", base: "Twin | None", field: "FieldRecord | None"
) -> "tuple[Literal['current', 'waves', 'profile'], ...]":
    """Inputs that are not chosen: the base's, or the current with its profile if all have one."""
    from seacage.records import current_bins

    if base is not None or campaign is None:
        return base.models.inputs if base else ("current",)
    there = any(sea.current_shear for sea in campaign.seas)
    seen = field is None or len(current_bins(field.buoy.values)) > 1
    return _INPUTS["current,profile" if there and seen else "current"]


def _travel_time(twin: "Twin") -> str:
    travel = twin.travel_time
    if not travel.distance_m:
        return f"none found from {twin.buoy} to the cage"
    limit = f"{travel.longest_s / 60.0:g} min at most"
    return f"{travel.distance_m:g} m from {twin.buoy} to the cage, at the current's speed, {limit}"


def _gaps(simulator: str, twin: "Twin") -> list[str]:
    """What a twin of another program's results lacks, or has of seacage's simulations."""
    loads = twin.models.loads
    found = ["What is left if a line parts: seacage learns it from its own simulations alone."]
    if loads is None:
        found.append(
            "Loads of lines in waves, wear and largest loads: they need std, maximum, mpm_3h and "
            "expected_3h of every line in 20 cases with waves or more, of many periods."
        )
    else:
        found.append("Symmetry: loads in waves are learned without the images of each case.")
    if loads is None or loads.motion is None:
        found.append("How far depths swing in waves: it needs these loads and node_position_std.")
    if twin.models.net is not None:
        found.append(
            "Intervals of the net at level 2, and probabilities of clearance: those that seacage's "
            f"simulations have (decisions 78 and 99); none were measured with {simulator}."
        )
    return found


def _stores(folders: list[Path]) -> list[Path]:
    """Stores of campaigns: the folders themselves, or what is in them."""
    return [
        store
        for folder in folders
        for store in ([folder] if (folder / "zarr.json").exists() else sorted(folder.glob("[!.]*")))
    ]


def _level_one(
    campaign: Path | None, base: Path | None
) -> "tuple[Cage, CampaignRecord | None, Twin | None]":
    """The cage as simulated, and what teaches level 1 or has it."""
    from seacage.cage import Cage
    from seacage.records import read_campaign
    from seacage.twin import Twin

    if campaign and not base:
        simulated = read_campaign(campaign)
        return Cage.from_toml(simulated.cage_toml), simulated, None
    if base and not campaign:
        begun = Twin.read(base)
        return begun.cage, None, begun
    raise refusal("train: give either --campaign, which teaches level 1, or --base.")
