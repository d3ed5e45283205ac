"""The demonstration: a twin of cage ``ace`` that anyone can make and watch within minutes."""

from dataclasses import dataclass, replace
from pathlib import Path

from seacage.cage import Cage
from seacage.campaigns import TruthParameters
from seacage.conventions import Progress, no_progress
from seacage.records import FieldRecord, Record
from seacage.studies._chain import TRAINING, Chain, Recipe
from seacage.studies._shape_discrepancy import CASES, SEEDS, learned_discrepancy
from seacage.twin import Twin


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Demonstration:
    """What a demonstration shows."""

    cage: Cage
    twin_folder: Path  # of its trained twin
    buoy: Record  # what drives the twin: the record given, or a generated one
    field: FieldRecord  # the buoy and the virtual sensors beside it


def prepare_demonstration(
    folder: str | Path,  # keeps the stages; after a stop the work goes on where it was
    *,
    record: Record | None = None,  # of a real buoy; None for the generated one
    workers: int | None = None,  # processes for simulations; None for one per core
    progress: Progress | None = None,  # called as (stage, done, total)
) -> Demonstration:
    """Make the demonstration twin, or find it made: campaign, field, training, shape error.

    The twin learns from a generated current record. Another buoy's record may drive the show
    instead: the twin stays the same, and the sensors beside that record are virtual too.
    """
    chain = Chain(
        folder=Path(folder),
        cage=Cage.named("ace"),
        recipe=Recipe(),
        workers=workers,
        progress=progress or no_progress,
    )
    twin_folder = _with_discrepancy(chain)
    field = chain.field if record is None else chain.display_field(record)
    return Demonstration(cage=chain.cage, twin_folder=twin_folder, buoy=field.buoy, field=field)


def _with_discrepancy(chain: Chain) -> Path:
    """The folder of the chain's twin, once it also knows how far its shapes are off."""
    plain = chain.twin_folder

    def make(begun: Path) -> None:
        twin = Twin.read(plain)
        error = learned_discrepancy(twin, workers=chain.workers, progress=chain.progress)
        replace(twin, discrepancy=error).write(begun / "twin")

    settings = {
        "twin": plain.parent.name,
        "hidden_sha256": TruthParameters.read().sha256,
        "seeds": list(SEEDS),
        "cases": CASES,
    }
    return chain.stages.ensure("demonstration", settings, make, rooms=TRAINING) / "twin"
