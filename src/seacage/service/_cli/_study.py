"""``seacage study``: whole experiments."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._cli._console import progress_bar, refusal, report
from seacage.service._cli._options import InFile, InFolder, Seed, Workers, read_cage
from seacage.service._cli._score import error_rows

if TYPE_CHECKING:
    from seacage.studies import BenchStudy, FidelityStudy, PaperStudy, ShapeScore

ReportFolder = Annotated[Path, typer.Option(file_okay=False, help="Folder of the report.")]


def paper(
    *,
    out: ReportFolder = Path("study"),
    quick: Annotated[bool, typer.Option("--quick/--full")] = True,
    campaign: Annotated[Path | None, typer.Option(exists=True)] = None,
    field: InFolder = None,
    loads: Annotated[Path | None, typer.Option(exists=True)] = None,
    days: Annotated[float, typer.Option(min=4.0, max=400.0)] = 48.0,
    one_in: Annotated[int, typer.Option(min=1)] = 1,
    networks: bool | None = None,
    seed: Seed = 0,
    workers: Workers = None,
) -> None:
    """Repeat the paper's study with a virtual field.

    It ends in one HTML report: the paper's figures of loads, depths and shapes on held-out days
    and simulations, what else the twin may be trained with, and which of the paper's statements
    these numbers repeat. Stopped, the same command goes on where it was.

    Example:
        seacage study paper --quick --out study
        seacage study paper --full --campaign campaign.zarr --field field --out study

    Options:
        quick: 400 equilibria without waves, or the paper's 1,000 half-hours and a field in time.
        campaign: A finished campaign to take; its last 100 cases judge.
        field: A folder of `seacage field virtual` to take, truth included.
        loads: A finished campaign of `--plan loads` to take, for the loads in waves.
        days: Of a field made with --full.
        one_in: With --full: simulate one hour in so many, and those of the shackles.
        networks: Train graph networks too (JAX). [default: with --full]
        seed: Of everything that is drawn.
    """
    from seacage.studies import paper_study

    with progress_bar() as progress:
        study = paper_study(
            out,
            quick=quick,
            campaign=campaign,
            field=field,
            loads=loads,
            days=days,
            one_in=one_in,
            networks=networks,
            seed=seed,
            workers=workers,
            progress=progress,
        )
    rows = [
        *error_rows(study.sensors),
        *((one.model, _shape_line(one)) for one in study.shapes),
        *((claim.verdict, claim.claim) for claim in study.claims),
    ]
    _report_virtual(
        study,
        rows,
        sensors=study.sensors,
        shapes=[_shape_entry(one) for one in study.shapes],
        claims=study.claims,
        wave_loads=study.loads,
    )


def _report_virtual(
    study: "PaperStudy | FidelityStudy | BenchStudy", rows: list[tuple[str, str]], **answer: object
) -> None:
    """Print what a study of virtual fields found, and where its report is."""
    files = {"report": study.report, "scores": study.scores, "origin": "virtual field"}
    report(files | answer, rows=[*rows, ("Report", f"{study.report} (virtual field)")])


def _shape_entry(score: "ShapeScore") -> dict[str, object]:
    return {
        "model": score.model,
        "inputs": score.inputs,
        "mae_m": score.axis_mae,
        "p99_m": score.p99,
        "worst_node_m": score.worst,
        "mae_without_drift_m": score.mae_without_drift,
        "p99_without_drift_m": score.p99_without_drift,
        "worst_node_without_drift_m": score.worst_without_drift,
        "coverage": score.coverage,
        "crps_m": score.crps,
        "fit_cpu_s": score.fit_cpu_s,
        "predict_ms": score.predict_ms,
    }


def _shape_line(score: "ShapeScore") -> str:
    return (
        f"MAE {score.mae:.3g} m, 99 % of nodes within {score.p99:.3g} m, worst "
        f"{score.worst:.3g} m (without drift {score.mae_without_drift:.3g}, "
        f"{score.p99_without_drift:.3g} and {score.worst_without_drift:.3g} m); "
        f"inputs: {score.inputs} (computed)"
    )


def fidelity(
    *,
    out: ReportFolder = Path("fidelity"),
    field: InFolder = None,
    hidden: InFile = None,
    cage: str | None = None,
    windows: Annotated[int, typer.Option(min=1)] = 600,
    seed: Seed = 0,
    workers: Workers = None,
) -> None:
    """Hold a virtual field against the rules that keep it honest.

    It ends in one HTML report: low fidelity against the truth per sensor and direction, what its
    best rescaling leaves, that multifidelity gains nothing where there is nothing to gain, and
    the gap as the net grows. Each claim says whether it holds. Stopped, the same command goes on
    where it was.

    Example:
        seacage study fidelity --field field --out fidelity

    Options:
        field: A folder of `seacage field virtual`, truth included; else one is made.
        hidden: What the field was made with; else as shipped.
        cage: The cage drawn; else the shipped one of the field's name.
        windows: 10-minute windows that survey the days, about.
        seed: Of everything that is drawn.
    """
    from seacage.campaigns import TruthParameters
    from seacage.studies import fidelity_study

    with progress_bar() as progress:
        study = fidelity_study(
            out,
            field=field,
            cage=None if cage is None else read_cage(cage),
            hidden=TruthParameters.read(hidden),
            windows=windows,
            seed=seed,
            workers=workers,
            progress=progress,
        )
    rows = [(claim.verdict, f"{claim.claim} {claim.finding}") for claim in study.claims]
    _report_virtual(study, rows, claims=study.claims)


def benchmarks(
    *,
    out: ReportFolder = Path("benchmarks-report"),
    peers: InFolder = None,
    seeds: str = "0-9",
    quick: Annotated[bool, typer.Option("--quick/--full")] = False,
    fresh: Annotated[bool, typer.Option("--fresh")] = False,
    kept: Annotated[bool, typer.Option("--kept")] = False,
) -> None:
    """Compare our learners with other people's on published problems.

    It ends in one HTML report: errors, spreads and cost of each method on each problem, and for
    each promise whether it holds. Stopped, the same command goes on where it was.

    Example:
        seacage study benchmarks --peers .venv-peers --out benchmarks-report

    Options:
        peers: The environment of `make bench-peers`; else ours alone.
        seeds: First and last seed; those below 5 tune and decide nothing.
        quick: Two seeds of each kind, no cage-size problem.
        fresh: Time the cage-size problem again, all in one run.
        kept: Run nothing; write the page from what is there.
    """
    from seacage.studies import benchmark_study

    with progress_bar() as progress:
        study = benchmark_study(
            out,
            peers=peers,
            seeds=_numbers("seeds", seeds),
            quick=quick,
            fresh=fresh,
            kept=kept,
            progress=progress,
        )
    rows = [(one.verdict, f"{one.claim} {one.finding}") for one in study.verdicts]
    report(
        {"report": study.report, "scores": study.scores, "origin": "computed"}
        | {"verdicts": study.verdicts},
        rows=[*rows, ("Report", study.report)],
    )


def bench(
    *,
    out: ReportFolder = Path("bench"),
    quick: Annotated[bool, typer.Option("--quick/--full")] = True,
    truths: str = "1-2",
    water: Literal["tame", "coastal", "shallow"] | None = None,
    current: InFile = None,
    row: list[Path] | None = None,
    surrogate: list[str] | None = None,
    seed: Seed = 0,
    unseal: Annotated[bool, typer.Option("--unseal")] = False,
    workers: Workers = None,
) -> None:
    """Score methods, yours too, on hidden cages in five tasks.

    Mean load, peak, shape, alarm and calibration, on virtual fields whose truth is opened when all
    predictions are on disk. It ends in one HTML report. Stopped, the same command goes on where it
    was.

    Example:
        seacage study bench --quick --out bench
        seacage study bench --quick --out bench --row my-method

    Options:
        quick: A coarse net and less of everything, or the whole net.
        truths: First and last number of the family of hidden cages.
        water: One of the three; else all.
        current: A record of a buoy's current; else generated ones. Half of its days train.
        row: A folder of predictions by another method; its name is the row's.
        surrogate: A surrogate of another package, for the mean loads.
        seed: Of weather, noise, faults and waves.
        unseal: Take sealed truths, for a judgement that is the last.
    """
    from seacage.campaigns import WATERS
    from seacage.studies import bench_study

    with progress_bar() as progress:
        study = bench_study(
            out,
            quick=quick,
            truths=_numbers("truths", truths),
            waters=WATERS if water is None else (water,),
            current=current,
            rows=row or (),
            surrogates=surrogate or (),
            seed=seed,
            unseal=unseal,
            workers=workers,
            progress=progress,
        )
    rows = [(f"{one.task}, {one.row}", f"{one.error:.3g} {one.unit}") for one in study.means]
    _report_virtual(study, rows, cases=study.cases, means=study.means)


def _numbers(option: str, written: str) -> range:
    """The numbers of ``5``, or of ``0-9``."""
    first, dash, last = written.partition("-")
    if not first.isdecimal() or (dash and not last.isdecimal()):
        raise refusal(f"--{option} {written} is not a range. Write 0-9, or a single number.")
    return range(int(first), int(last or first) + 1)
