"""``seacage score`` and ``seacage if-parted``: how good a twin is, and what it says of damage."""

from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._cli._console import Exit, exit_with, report
from seacage.service._cli._options import OutFolder, SeaOptions, Seed

if TYPE_CHECKING:
    from seacage.service._schemas._cages import LineLoad, PartedLine
    from seacage.studies import BaselineScore, SensorScore


def score(
    *,
    twin: Annotated[Path, typer.Option(exists=True, file_okay=False)],
    field: Annotated[Path, typer.Option(exists=True, file_okay=False)],
    out: OutFolder = None,
    surrogate: str | None = None,
    seed: Seed = 0,
) -> None:
    """Score a twin on readings that did not teach it.

    Mean absolute errors of simulation alone and of the twin, the gain with its 95 % interval
    (paired block bootstrap), and how many readings the twin's own interval holds.

    Example:
        seacage score --twin twin --field field --out scores

    Options:
        twin: Folder of the twin.
        field: Folder of a field record.
        out: Folder for tables and figures.
        surrogate: A surrogate of another package to score beside the twin, and baselines.
        seed: Of the bootstrap.
    """
    from seacage.records import FieldRecord
    from seacage.studies import score_record, score_surrogate
    from seacage.twin import Twin

    read, record = Twin.read(twin), FieldRecord.read(field)
    others = score_surrogate(read, record, surrogate) if surrogate else ()
    scores = score_record(read, record, out=out, seed=seed)
    rows = error_rows(scores) + [row for one in others for row in _baseline_rows(one)]
    report(
        {"sensors": scores, "written": out, "baselines": others},
        rows=rows if out is None else [*rows, ("Written", str(out))],
    )


def error_rows(scores: "Iterable[SensorScore]") -> list[tuple[str, str]]:
    """One line per sensor, on single readings."""
    return [
        (
            score.sensor,
            (
                f"MAE {score.raw.low_mae:.3g} {score.unit} simulated, {score.raw.multi_mae:.3g} "
                f"{score.unit} twin; gain {score.raw.gain:.3g} "
                f"({score.raw.gain_low:.3g} to {score.raw.gain_high:.3g}); "
                f"{score.raw.coverage:.0%} inside the interval ({score.origin})"
            ),
        )
        for score in scores
    ]


def _baseline_rows(score: "BaselineScore") -> list[tuple[str, str]]:
    """A line for each other learner, on ten-minute means."""
    twin = f"{score.unit}, less the twin's {score.mae['twin']:.3g}:"
    return [
        (
            f"{score.sensor}, {name}",
            f"MAE {score.mae[name]:.3g} {twin} {o.mean:+.3g} ({o.low:+.3g} to {o.high:+.3g})",
        )
        for name, o in score.gain.items()
    ]


def if_parted(
    *, sea: SeaOptions, twin: Annotated[Path, typer.Option(exists=True, file_okay=False)]
) -> None:
    """Say what the other lines would bear if each line parted, the worst first.

    Once the transient has died, by level 1. The twin must have been trained with --parted.

    Example:
        seacage if-parted --twin twin --current-speed 0.5 --current-to 90 --hs 2 --tp 7

    Options:
        twin: Folder of the twin.
    """
    from seacage.service._live._answers import what_if_parted
    from seacage.twin import Answered, Metocean, Twin

    read, water = Twin.read(twin), Metocean.of(sea.state())
    answered = Answered(
        t=datetime.now(UTC), answer=read.predict(water), metocean=water, input_age_s=0.0
    )
    found = what_if_parted(read.cage.name, read, answered)
    if not found.lines:
        raise exit_with(f"if-parted: {found.reason}", Exit.FAILED)
    about = found.model_dump(mode="json", include={"level", "lines"})
    report(
        {"twin": str(twin), "origin": str(read.origin), **about},
        rows=[(f"Without {line.parted}", _sentence(line)) for line in found.lines],
    )


def _sentence(line: "PartedLine") -> str:
    share, second = line.utilisation, line.second_would_part
    return "; ".join(
        (
            f"mean {_load(line.largest_mean)}, 3 h {_load(line.largest_maximum_3h)}",
            "capacity not known" if share is None else f"{share:.0%} of a capacity",
            f"a second {'may part' if second is None else 'parts' if second else 'holds'}",
            f"volume {line.volume_share}, {line.clearance_m} m clear, drift {line.drift_m} m",
        )
    )


def _load(one: "LineLoad | None") -> str:
    return "not known" if one is None else f"{one.kn:.0f} kN ({one.line})"
