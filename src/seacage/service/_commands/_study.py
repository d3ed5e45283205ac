"""``seacage study``: whole experiments."""

from pathlib import Path
from typing import Annotated

import typer

from seacage.service._commands._score import error_rows, error_table
from seacage.service._console import Json, guarded, progress_bar, tell

group = typer.Typer(help="Whole experiments, from simulations to one HTML report.")


@group.command()
@guarded
def paper(
    *,
    out: Annotated[Path, typer.Option(file_okay=False, help="Folder of the report.")] = Path(
        "study"
    ),
    quick: Annotated[
        bool, typer.Option("--quick/--full", help="400 simulations, or the paper's 1,000.")
    ] = True,
    seed: Annotated[int, typer.Option(min=0, help="Of everything that is drawn.")] = 0,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes. [default: one per core]")
    ] = None,
    as_json: Json = False,
) -> None:
    """Repeat the paper's study with a virtual field.

    It ends in one HTML report. Per sensor: both fidelities against the sensor on days that did
    not teach, as density scatters, time series and errors; level 1 against held-out
    simulations. Stopped, the same command goes on where it was.

    Example:
        seacage study paper --quick --out study
    """
    from seacage.studies import paper_study

    with progress_bar() as progress:
        study = paper_study(out, quick=quick, seed=seed, workers=workers, progress=progress)
    tell(
        {"report": str(study.report), "scores": str(study.scores)}
        | {"sensors": error_table(study.sensors)},
        as_json=as_json,
        rows=[*error_rows(study.sensors), ("Report", str(study.report))],
    )
