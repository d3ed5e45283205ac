"""The bench study: cases, rows of predictions, the seal, and scores, each kept on disk."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import WATERS, Plan, TruthParameters, Water
from seacage.conventions import InputError, Origin, Progress, load_extension, no_progress
from seacage.records import Record, read_record
from seacage.studies._bench._cases import Given, Size, check_days, make_case
from seacage.studies._bench._report import BenchMean, means_of, page_values
from seacage.studies._bench._rows import LOW, NO_TREES, LevelOne, write_rows
from seacage.studies._bench._scores import Arrays, BenchScore, score_row
from seacage.studies._bench._seal import Predictions, note_hashes, open_truth, read_predictions
from seacage.studies._chain import TRAINING
from seacage.studies._page import write_report
from seacage.studies._stages import SIMULATION, Stages, code_sha256, count
from seacage.twin import Training, train

LEDGER = "predictions.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchStudy:
    """Where the study's report is, and what it found."""

    # The HTML page and the same numbers as JSON
    report: Path
    scores: Path
    means: tuple[BenchMean, ...]  # of each row in each task
    cases: Mapping[str, Path]  # folder of what a learner may see of each case, by its name


def bench_study(
    out: str | Path,  # as for ``paper_study``, as are ``workers`` and ``progress``
    *,
    quick: bool = False,  # a coarse net, and less of everything: minutes on one core
    truths: Sequence[int] = (1, 2),  # numbers of the family
    waters: Sequence[Water] = WATERS,
    # A record of a buoy's current to take in place of generated ones; half of its days train
    current: str | Path | None = None,
    # Folders of predictions by other methods, a file for each case; a folder's name is the row's
    rows: Sequence[str | Path] = (),
    surrogates: Sequence[str] = (),  # of other packages, by entry point, for the mean loads
    seed: int = 0,
    unseal: bool = False,  # numbers of the family that are sealed, for a judgement that is the last
    workers: int | None = None,
    progress: Progress | None = None,
) -> BenchStudy:
    """Score methods in five tasks on hidden cages of the family, into one HTML page.

    All predictions are on disk, and their hashes noted, before a truth is opened.

    Raises InputError: a truth, a record, a surrogate or a folder of predictions that is none.
    """
    out, notify = Path(out), progress or no_progress
    record = None if current is None else read_record(current)
    if record is not None:
        check_days(record)
    hidden = {
        f"{water}-{number}": TruthParameters.of_family(number, water=water, unseal=unseal)
        for water in waters
        for number in truths
    }
    size = _size(quick=quick)
    stages = Stages(folder=out / "stages", workers=workers, progress=notify)
    cases = {
        name: _ensure_case(stages, size, name, one, record, seed)
        for name, one in count(list(hidden.items()), "cases", notify)
    }
    files = {
        case.name: _ensure_rows(stages, size, case, surrogates)
        for case in count(list(cases.values()), "rows", notify)
    }
    for folder in map(Path, rows):
        _add_row(files, folder)
    arrays = _read_rows(size, files, cases)
    hashes = note_hashes(out / LEDGER, files)  # before any truth is opened
    scores = tuple(_scores(out / LEDGER, cases, files, arrays))
    means = means_of(scores)
    found = {
        "origin": Origin.VIRTUAL_FIELD,
        "recipe": _recipe(size, cases, record),
        "provenance": _provenance(size, seed),
        "means": means,
        "scores": scores,
        "predictions_sha256": hashes,
    }
    report, numbers = write_report(out, "bench.html", found, page_values(means, scores))
    places = {case.name: case / "given" for case in cases.values()}
    return BenchStudy(report=report, scores=numbers, means=means, cases=places)


def _size(*, quick: bool) -> Size:
    cage = Cage.named("ace")
    if not quick:
        return Size(cage=cage)
    # Four rings and sixteen meridians settle and move in a fraction of the time.
    coarse = cage.altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
    return Size(cage=coarse, wave_cases=100, stretches=6, seas=32)


def _ensure_case(
    stages: Stages,
    size: Size,
    name: str,
    hidden: TruthParameters,
    current: Record | None,
    seed: int,
) -> Path:
    own = 1000 * seed + int(name.rpartition("-")[2])

    def make(begun: Path) -> None:
        # Of one number all waters meet the same cage.
        kept = stages.folder / f"responses-{own}-{code_sha256(SIMULATION)[:10]}"
        workers = stages.workers
        make_case(begun, size, hidden, current=current, seed=own, kept=kept, workers=workers)

    settings = {
        **size.settings,
        "hidden_sha256": hidden.sha256,
        "current_sha256": current and current.sha256,
        "seed": own,
    }
    return stages.ensure(name, settings, make, rooms=(*SIMULATION, "records", "studies"))


def _ensure_rows(
    stages: Stages, size: Size, case: Path, surrogates: Sequence[str]
) -> dict[str, Path]:
    """Files of our rows, and of other packages' surrogates, by row."""
    learners = [load_extension("surrogates", name, Callable) for name in surrogates]
    given = Given(folder=case / "given", cage=size.cage)

    def make(begun: Path) -> None:
        write_rows(begun, given, _level_one(stages, size), learners)

    settings = {
        "case": case.name,
        "surrogates": [one.source for one in learners],
        "scikit-learn": _scikit_learn(),
    }
    name = f"rows-{case.name.rpartition('-')[0]}"
    made = stages.ensure(name, settings, make, rooms=(*TRAINING, "studies"))
    return {path.stem: path for path in sorted(made.glob("*.npz"))}


@cache
def _level_one(stages: Stages, size: Size) -> LevelOne:
    """Level 1 of all cases: what a learner may know of the cage by simulation."""
    settled = Plan.sample(0, size.cases, hs=(0.0, 0.0), name="current")
    in_waves = Plan.named("loads", 0, size.wave_cases, duration=900.0)
    campaigns = (
        stages.ensure_campaign("campaign", size.cage, settled, second_moment=True),
        stages.ensure_campaign("loads", size.cage, in_waves, method="simulate", spin_up=200.0),
    )
    return LevelOne(*(train(size.cage, one, training=Training(restarts=0)) for one in campaigns))


def _add_row(files: dict[str, dict[str, Path]], folder: Path) -> None:
    """Add another method's files of predictions. Raises InputError: one is missing, or its name."""
    row = folder.name
    for case, own in files.items():
        path = folder / f"{case}.npz"
        if row in own:
            raise InputError(f"study bench: a row is called {row!r} already. Rename the folder.")
        if not path.is_file():
            raise InputError(
                f"study bench: {folder} has no predictions for the case {case}. Write {path.name} "
                "from the case's folder `given`."
            )
        own[row] = path


def _read_rows(
    size: Size, files: Predictions, cases: Mapping[str, Path]
) -> dict[str, dict[str, dict[str, np.ndarray]]]:
    """Predictions by case and row, all of which are checked."""
    found = dict[str, dict[str, dict[str, np.ndarray]]]()
    for case in cases.values():
        shapes = Given(folder=case / "given", cage=size.cage).shapes
        own = files[case.name].items()
        found[case.name] = {row: read_predictions(path, shapes) for row, path in own}
    return found


def _scores(
    ledger: Path,
    cases: Mapping[str, Path],
    files: Predictions,
    arrays: Mapping[str, Mapping[str, Arrays]],
) -> Iterator[BenchScore]:
    for name, case in cases.items():
        truth = open_truth(case / "sealed.npz", ledger, files[case.name], case.name)
        water, _, number = name.rpartition("-")
        rows = arrays[case.name]
        for row, own in rows.items():
            known = {"row": row, "water": water, "truth": int(number)}
            for task, (error, more) in score_row(own, truth, rows[LOW]).items():
                yield BenchScore(task=task, error=error, more=more, **known)


def _recipe(size: Size, cases: Mapping[str, Path], current: Record | None) -> dict[str, str]:
    record = "generated, another for each truth" if current is None else f"{current.stream}, given"
    return {
        "Cases (virtual field)": ", ".join(cases),
        "Current at the buoy": f"{record}; the first half of its days trains, the second is scored",
        "Level 1 (computed)": f"{size.cases} settled currents, {size.wave_cases} quarter-hours in "
        f"waves, a net of {size.cage.node_count} nodes",
        "Alarms": f"{size.stretches} stretches of three weeks for each case, two of three with a "
        "fault",
        "Peaks": f"{size.seas} half-hours in waves for each case, the first half trains",
    }


def _provenance(size: Size, seed: int) -> dict[str, str]:
    return {
        **{name: version(name) for name in ("seacage", "numpy", "scipy")},
        "scikit-learn": _scikit_learn() or NO_TREES,
        "Seed": str(seed),
        "Cage": f"{size.cage.name}, sha256 {size.cage.sha256}",
    }


def _scikit_learn() -> str | None:
    return version("scikit-learn") if find_spec("sklearn") else None
