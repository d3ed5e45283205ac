"""The chain from sea states to a trained twin, in stages that outlive a stop."""

from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path

from seacage.cage import Cage
from seacage.campaigns import Hidden, Plan, generated_current, run_campaign, virtual_field
from seacage.conventions import Progress
from seacage.records import CampaignRecord, FieldRecord, Record, read_campaign
from seacage.studies._split import split
from seacage.studies._stages import Stages, code_sha256
from seacage.twin import Training, Twin, train

_SIMULATION = ("conventions", "ocean", "cage", "dynamics", "campaigns")
_FIELD = (*_SIMULATION, "records")
_TRAINING = (*_FIELD, "surrogates", "twin")


@dataclass(frozen=True, slots=True, kw_only=True)
class Recipe:
    """How much of everything a study takes.

    Parameters
    ----------
    cases, held_out_cases
        Simulations that level 1 learns from, and others that judge it.
    days, teaching_days
        Length of the generated current record, and how many of its days teach.
    start
        Of that record.
    high_fidelity_points
        Readings that each sensor teaches with.
    seed
        Of plan, current, virtual field and training.
    """

    cases: int = 400
    held_out_cases: int = 100
    days: float = 50.0
    teaching_days: int = 25
    start: datetime = datetime(2020, 1, 18, tzinfo=UTC)
    high_fidelity_points: int = 300
    seed: int = 0

    @property
    def plan(self) -> Plan:
        """Currents alone, over the paper's speeds and directions."""
        return Plan.sample(self.seed, self.cases, hs=(0.0, 0.0), name="current")

    @property
    def held_out_plan(self) -> Plan:
        """The same ranges, drawn with another seed."""
        return Plan.sample(self.seed + 1, self.held_out_cases, hs=(0.0, 0.0), name="held out")


# No slots: what has been made is found once and kept.
@dataclass(frozen=True, kw_only=True)
class Chain:
    """A cage's campaign, virtual field and twin, each made when it is first asked for.

    Parameters
    ----------
    folder
        Of the stages.
    cage
        The cage.
    recipe
        How much of everything.
    workers
        Processes for simulations; None for one per core.
    progress
        Called as (stage, done, total).
    """

    folder: Path
    cage: Cage
    recipe: Recipe
    workers: int | None = None
    progress: Progress | None = None

    @cached_property
    def campaign(self) -> CampaignRecord:
        """The simulations that level 1 learns from."""
        return self._campaign("campaign", self.recipe.plan)

    @cached_property
    def held_out(self) -> CampaignRecord:
        """The simulations that judge level 1."""
        return self._campaign("held-out", self.recipe.held_out_plan)

    @cached_property
    def field(self) -> FieldRecord:
        """A generated current record and the virtual sensors that it drove."""
        return FieldRecord.read(self._field_folder / "field")

    @cached_property
    def truth(self) -> FieldRecord:
        """The same sensors without their errors; it may judge and never teaches."""
        return FieldRecord.read(self._field_folder / "truth")

    @cached_property
    def twin_folder(self) -> Path:
        """The twin trained on the campaign and on the field record's teaching days."""
        settings = {
            **self._field_settings,
            "cases": self.recipe.cases,
            "teaching_days": self.recipe.teaching_days,
            "high_fidelity_points": self.recipe.high_fidelity_points,
        }
        return self._stages.made("twin", settings, self._train, rooms=_TRAINING) / "twin"

    @cached_property
    def twin(self) -> Twin:
        """The twin, read."""
        return Twin.read(self.twin_folder)

    def driven_by(self, record: Record) -> FieldRecord:
        """Virtual sensors under another buoy record: to look at, for no twin learns from them."""
        settings = {**self._truth_settings, "record_sha256": record.sha256}
        folder = self._stages.made(
            "display", settings, lambda begun: self._drive(begun, record), rooms=_FIELD
        )
        return FieldRecord.read(folder / "field")

    def report(self, stage: str, done: int, total: int) -> None:
        """Tell whoever listens how far a stage is."""
        if self.progress is not None:
            self.progress(stage, done, total)

    @property
    def _stages(self) -> Stages:
        return Stages(folder=self.folder)

    @property
    def _truth_settings(self) -> dict[str, object]:
        return {
            "cage": self.cage.to_toml(),
            "hidden_sha256": Hidden.read().sha256,
            "seed": self.recipe.seed,
        }

    @property
    def _field_settings(self) -> dict[str, object]:
        span = {"days": self.recipe.days, "start": self.recipe.start.isoformat()}
        return {**self._truth_settings, **span}

    @cached_property
    def _field_folder(self) -> Path:
        return self._stages.made("field", self._field_settings, self._make_field, rooms=_FIELD)

    def _campaign(self, stage: str, plan: Plan) -> CampaignRecord:
        def make(begun: Path) -> None:
            run_campaign(
                self.cage,
                plan,
                begun / "campaign.zarr",
                method="settle",
                workers=self.workers,
                progress=self.progress,
            )

        settings = {"cage": self.cage.to_toml(), "plan_sha256": plan.sha256}
        folder = self._stages.made(stage, settings, make, rooms=_SIMULATION)
        return read_campaign(folder / "campaign.zarr")

    def _make_field(self, begun: Path) -> None:
        recipe = self.recipe
        self._drive(begun, generated_current(recipe.seed, start=recipe.start, days=recipe.days))

    def _drive(self, begun: Path, buoy: Record) -> None:
        made = virtual_field(
            self.cage,
            buoy,
            hidden=Hidden.read(),
            seed=self.recipe.seed,
            method="settle",
            kept=self.folder / f"responses-{code_sha256(_SIMULATION)[:10]}",
            workers=self.workers,
            progress=self.progress,
        )
        made.record.write(begun / "field")
        made.truth.write(begun / "truth")

    def _train(self, begun: Path) -> None:
        teaching, _ = split(self.field, teaching_days=self.recipe.teaching_days)
        training = Training(
            high_fidelity_points=self.recipe.high_fidelity_points,
            days=float(self.recipe.teaching_days),
            seed=self.recipe.seed,
        )
        twin = train(self.cage, self.campaign, teaching, training=training, progress=self.progress)
        twin.write(begun / "twin")
