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


@group.command()
@guarded
def fidelity(
    *,
    out: Annotated[Path, typer.Option(file_okay=False, help="Folder of the report.")] = Path(
        "fidelity"
    ),
    field: Annotated[
        Path | None,
        typer.Option(
            exists=True,
            file_okay=False,
            help="A folder of `seacage field virtual`, truth included; else one is made.",
        ),
    ] = None,
    hidden: Annotated[
        Path | None,
        typer.Option(
            exists=True, dir_okay=False, help="What the field was made with; else as shipped."
        ),
    ] = None,
    cage: Annotated[
        str | None, typer.Option(help="The cage drawn; else the shipped one of the field's name.")
    ] = None,
    windows: Annotated[
        int, typer.Option(min=1, help="10-minute windows that survey the days, about.")
    ] = 600,
    seed: Annotated[int, typer.Option(min=0, help="Of everything that is drawn.")] = 0,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes. [default: one per core]")
    ] = None,
    as_json: Json = False,
) -> None:
    """Hold a virtual field against the rules that keep it honest.

    It ends in one HTML report: low fidelity against the truth per sensor and direction, what its
    best rescaling leaves, that multifidelity gains nothing where there is nothing to gain, and
    the gap as the net grows. Each claim says whether it holds. Stopped, the same command goes on
    where it was.

    Example:
        seacage study fidelity --field field --out fidelity
    """
    from dataclasses import asdict

    from seacage.campaigns import Hidden
    from seacage.service._commands._settle import read_cage
    from seacage.studies import fidelity_study

    with progress_bar() as progress:
        study = fidelity_study(
            out,
            field=field,
            cage=None if cage is None else read_cage(cage),
            hidden=Hidden.read(hidden),
            windows=windows,
            seed=seed,
            workers=workers,
            progress=progress,
        )
    tell(
        {
            "report": str(study.report),
            "scores": str(study.scores),
            "origin": "virtual field",
            "claims": [asdict(claim) for claim in study.claims],
        },
        as_json=as_json,
        rows=[
            *((claim.verdict, f"{claim.claim} {claim.finding}") for claim in study.claims),
            ("Report", f"{study.report} (virtual field)"),
        ],
    )
