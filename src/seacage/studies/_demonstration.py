"""The demonstration: a twin of cage ``ace`` in waves, that anyone can make within minutes."""

from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

from seacage.cage import Cage
from seacage.campaigns import Plan, TruthParameters
from seacage.conventions import Progress, no_progress
from seacage.records import FieldRecord, Record, moment
from seacage.studies._chain import TRAINING, Chain, Recipe
from seacage.studies._demonstration_field import (
    SEED,
    SHA256,
    TRAINING_DAYS,
    read_demonstration_field,
)
from seacage.studies._shape_discrepancy import CASES, SEEDS, learned_discrepancy
from seacage.studies._split import split
from seacage.studies._stages import Stages
from seacage.twin import Training, train

# Of the simulations that level 1 learns from, some 3 core-minutes of all; the spin-up [s]
PLAN, SPIN_UP = Plan.named("loads", SEED, 120, duration=900.0), 200.0

_LAST = datetime.max.replace(tzinfo=UTC)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Demonstration:
    """What a demonstration shows."""

    cage: Cage
    twin_folder: Path  # of its trained twin
    buoy: Record  # what drives the twin: the record given, or that of the kept field
    field: FieldRecord  # the buoy and the virtual sensors beside it


def prepare_demonstration(
    folder: str | Path,  # keeps the stages; after a stop the work goes on where it was
    *,
    record: Record | None = None,  # of a real buoy; None for the kept field's
    workers: int | None = None,  # processes for simulations; None for one per core
    progress: Progress | None = None,  # called as (stage, done, total)
) -> Demonstration:
    """Make the demonstration twin, or find it made: campaign, training, shape error.

    The twin learns from simulations in waves and from the first days of a virtual field in waves,
    whose later days are shown. Another buoy's record may drive the show instead: the twin stays
    the same, and the sensors beside that record are virtual too, and settled.
    """
    cage = Cage.named("ace")
    stages = Stages(folder=Path(folder), workers=workers, progress=progress or no_progress)
    teaching, shown = split(read_demonstration_field(), teaching_days=TRAINING_DAYS)
    twin_folder = _ensure_twin(stages, cage, teaching)
    if record is None:
        start = min(moment(sensor.time[0]) for sensor in shown.sensors.values())
        shown = replace(shown, buoy=shown.buoy.between(start, _LAST))
    else:
        recipe, how = Recipe(seed=SEED), {"workers": workers, "progress": stages.progress}
        chain = Chain(folder=stages.folder, cage=cage, recipe=recipe, **how)
        shown = chain.display_field(record)
    return Demonstration(cage=cage, twin_folder=twin_folder, buoy=shown.buoy, field=shown)


def _ensure_twin(stages: Stages, cage: Cage, teaching: FieldRecord) -> Path:
    """The folder of the twin that learned, and that knows how far its shapes are off."""
    training = Training(days=float(TRAINING_DAYS), pause_s=86400.0 * TRAINING_DAYS, seed=SEED)

    def make(begun: Path) -> None:
        campaign = stages.ensure_campaign(
            "campaign", cage, PLAN, method="simulate", second_moment=True, spin_up=SPIN_UP
        )
        twin = train(cage, campaign, teaching, training=training, progress=stages.progress)
        error = learned_discrepancy(twin, workers=stages.workers, progress=stages.progress)
        replace(twin, discrepancy=error).write(begun / "twin")

    settings = {
        "cage": cage.to_toml(),
        "plan_sha256": PLAN.sha256,
        "spin_up_s": SPIN_UP,
        "field_sha256": SHA256,
        "hidden_sha256": TruthParameters.read().sha256,
        "training": asdict(training),
        "seeds": list(SEEDS),
        "cases": CASES,
    }
    return stages.ensure("twin", settings, make, rooms=TRAINING) / "twin"
