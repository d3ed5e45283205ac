"""``seacage score``: a twin against a record that did not teach it."""

from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._cli._console import guard, report
from seacage.service._cli._options import OutFolder, Seed

if TYPE_CHECKING:
    from seacage.studies import SensorScore


@guard
def score(
    *,
    twin: Annotated[Path, typer.Option(exists=True, file_okay=False)],
    field: Annotated[Path, typer.Option(exists=True, file_okay=False)],
    out: OutFolder = None,
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
        seed: Of the bootstrap.
    """
    from seacage.records import FieldRecord
    from seacage.studies import score_record
    from seacage.twin import Twin

    scores = score_record(Twin.read(twin), FieldRecord.read(field), out=out, seed=seed)
    rows = error_rows(scores)
    report(
        {"sensors": [asdict(one) for one in scores], "written": None if out is None else str(out)},
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
