"""The chain from sea states to a trained twin, in stages that outlive a stop."""

from dataclasses import asdict, dataclass, fields, replace
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
from jaxtyping import Int

from seacage import campaigns
from seacage.cage import Cage
from seacage.conventions import InputError, Progress, no_progress
from seacage.records import CampaignRecord, FieldRecord, Record, read_campaign
from seacage.studies._split import split
from seacage.studies._stages import SIMULATION, Stages, code_sha256
from seacage.twin import Training, train

_OF_ALL = ("quantile", "second_moment")  # arrays that have no axis of cases
_FIELD = (*SIMULATION, "records")
TRAINING = (*_FIELD, "surrogates", "twin")  # rooms whose code makes a twin


@dataclass(frozen=True, slots=True, kw_only=True)
class Recipe:
    """How much of everything a study takes."""

    # Simulations that level 1 is trained on, and held-out ones
    cases: int = 400
    held_out_cases: int = 100
    # "settle" takes equilibria in currents without waves, in minutes; "simulate" the paper's
    # half-hours in waves and currents, and a virtual field in time, in hours
    method: Literal["settle", "simulate"] = "settle"
    # Length of the generated current record, and how many of its days are training days
    days: float = 50.0
    teaching_days: int = 25
    one_in: int = 1  # simulate one hour of the field in so many, and those of the shackles
    start: datetime = datetime(2020, 1, 18, tzinfo=UTC)  # of the record
    high_fidelity_points: int = 300  # training readings of each sensor
    seed: int = 0  # of plan, current, virtual field and training

    @property
    def in_time(self) -> bool:
        """Whether cage and sensors are simulated in time, in waves."""
        return self.method == "simulate"

    @property
    def plan(self) -> campaigns.Plan:
        """The paper's sea states, the last ones held out; or currents alone, all for training."""
        if self.in_time:
            return campaigns.Plan.named("paper", self.seed, self.cases + self.held_out_cases)
        return campaigns.Plan.sample(self.seed, self.cases, hs=(0.0, 0.0), name="current")

    @property
    def held_out_plan(self) -> campaigns.Plan:
        """The same currents, drawn with another seed."""
        return campaigns.Plan.sample(
            self.seed + 1, self.held_out_cases, hs=(0.0, 0.0), name="held out"
        )

    @property
    def training(self) -> Training:
        """What a twin learns from: the current, and readings spread over the teaching days."""
        return Training(
            high_fidelity_points=self.high_fidelity_points,
            days=float(self.teaching_days),
            # The split by day has fixed the training days; silence in between is no end.
            pause_s=86400.0 * self.teaching_days,
            seed=self.seed,
        )


# No slots: what has been made is found once and kept.
@dataclass(frozen=True, kw_only=True)
class Chain:
    """A cage's campaign, virtual field and twin, each made when it is first asked for."""

    folder: Path  # of the stages
    cage: Cage
    recipe: Recipe  # how much of everything
    # Folder of a finished campaign to take in place of the recipe's; its last cases are held out
    given_campaign: Path | None = None
    # Folder of a virtual field, with its truth in ``truth``, to take in place of the recipe's
    given_field: Path | None = None
    # Differences of the recipe's virtual field; None for those that come with seacage
    hidden: campaigns.TruthParameters | None = None
    workers: int | None = None  # processes for simulations; None for one per core
    progress: Progress = no_progress  # called as (stage, done, total)

    @property
    def campaign(self) -> CampaignRecord:
        """The simulations that level 1 learns from."""
        return self._campaigns[0]

    @property
    def held_out(self) -> CampaignRecord:
        """The held-out simulations."""
        return self._campaigns[1]

    @property
    def in_waves(self) -> bool:
        """Whether the simulations have waves."""
        return any(sea.hs > 0.0 for sea in self.campaign.seas)

    @cached_property
    def field(self) -> FieldRecord:
        """A current record and the virtual sensors that it drove."""
        return FieldRecord.read(self.given_field or self._field_folder / "field")

    @cached_property
    def truth(self) -> FieldRecord:
        """The same sensors without their errors; for scores alone, never for training."""
        given = self.given_field
        return FieldRecord.read(given / "truth" if given else self._field_folder / "truth")

    def ensure_twin(self, training: Training) -> Path:
        """The folder of a twin that learned so from the campaign and the teaching days."""

        def make(begun: Path) -> None:
            teaching, _ = split(self.field, teaching_days=self.recipe.teaching_days)
            twin = train(
                self.cage, self.campaign, teaching, training=training, progress=self.progress
            )
            twin.write(begun / "twin")

        settings = {
            **self._sources,
            "teaching_days": self.recipe.teaching_days,
            "training": asdict(training),
        }
        return self.stages.ensure("twin", settings, make, rooms=TRAINING) / "twin"

    def display_field(self, record: Record) -> FieldRecord:
        """Virtual sensors under another buoy record: for display, not for training."""
        settings = {**self._truth_settings, "record_sha256": record.sha256}
        folder = self.stages.ensure(
            "display", settings, lambda begun: self._settle_field(begun, record), rooms=_FIELD
        )
        return FieldRecord.read(folder / "field")

    @property
    def stages(self) -> Stages:
        """Where what is made is kept."""
        return Stages(folder=self.folder, workers=self.workers, progress=self.progress)

    @property
    def _hidden(self) -> campaigns.TruthParameters:
        return campaigns.TruthParameters.read() if self.hidden is None else self.hidden

    @property
    def _truth_settings(self) -> dict[str, object]:
        return {
            "cage": self.cage.to_toml(),
            "hidden_sha256": self._hidden.sha256,
            "seed": self.recipe.seed,
        }

    @property
    def _field_settings(self) -> dict[str, object]:
        recipe = self.recipe
        span = {"days": recipe.days, "start": recipe.start.isoformat()}
        how = {"method": recipe.method, "one_in": recipe.one_in} if recipe.in_time else {}
        return {**self._truth_settings, **span, **how}

    @cached_property
    def _sources(self) -> dict[str, object]:
        """What a twin learns from: as asked for, or the very numbers where they were given."""
        recipe, field = self.recipe, self.given_field
        sources: dict[str, object] = {"cage": self.cage.to_toml(), "seed": recipe.seed}
        if self.given_campaign:
            sources["campaign_sha256"] = self.campaign.sha256
        else:
            sources |= {"plan_sha256": recipe.plan.sha256, "cases": recipe.cases}
        if field is None:
            return {**sources, **self._field_settings, "method": recipe.method}
        streams = (self.field.buoy, *self.field.sensors.values())
        return {**sources, "field_sha256": {one.stream: one.sha256 for one in streams}}

    @cached_property
    def _field_folder(self) -> Path:
        return self.stages.ensure("field", self._field_settings, self._make_field, rooms=_FIELD)

    @cached_property
    def _campaigns(self) -> tuple[CampaignRecord, CampaignRecord]:
        """The simulations for training, and those held out."""
        recipe, given = self.recipe, self.given_campaign
        if given is None and not recipe.in_time:
            return self._run("campaign", recipe.plan), self._run("held-out", recipe.held_out_plan)
        whole = self._run("campaign", recipe.plan) if given is None else read_campaign(given)
        if whole.cage_toml != self.cage.to_toml():
            raise InputError(
                f"study paper: {given} is a campaign of another cage than "
                f"{self.cage.name}. Give the cage that was simulated."
            )
        count = min(recipe.held_out_cases, len(whole) // 2)
        rows = np.flatnonzero(whole.converged)
        return (select_cases(whole, rows[:-count]), select_cases(whole, rows[-count:]))

    def _run(self, stage: str, plan: campaigns.Plan) -> CampaignRecord:
        return self.stages.ensure_campaign(
            stage, self.cage, plan, method=self.recipe.method, second_moment=True
        )

    def _make_field(self, begun: Path) -> None:
        recipe = self.recipe
        buoy = campaigns.generated_current(recipe.seed, start=recipe.start, days=recipe.days)
        if not recipe.in_time:
            self._settle_field(begun, buoy)
            return
        # To the last reading, and an hour on.
        waves = campaigns.generated_waves(recipe.seed, start=recipe.start, days=recipe.days + 1.0)
        timetable = campaigns.Timetable.over(buoy, one_in=recipe.one_in)
        self._write_field(begun, buoy, waves=waves, timetable=timetable, kept=begun / "stretches")

    def _settle_field(self, begun: Path, buoy: Record) -> None:
        kept = self.folder / f"responses-{code_sha256(SIMULATION)[:10]}"
        self._write_field(begun, buoy, method="settle", kept=kept)

    def _write_field(self, begun: Path, buoy: Record, **how: Any) -> None:
        made = campaigns.virtual_field(
            self.cage,
            buoy,
            hidden=self._hidden,
            seed=self.recipe.seed,
            workers=self.workers,
            progress=self.progress,
            **how,
        )
        made.record.write(begun / "field")
        made.truth.write(begun / "truth")


def cases_with_answer(campaign: CampaignRecord) -> CampaignRecord:
    """A campaign's cases that ended with an answer."""
    return select_cases(campaign, np.flatnonzero(campaign.converged))


def select_cases(campaign: CampaignRecord, rows: Int[np.ndarray, " row"]) -> CampaignRecord:
    """A campaign's cases of these rows; the second moment stays that of all."""
    arrays = {
        part.name: value[rows]
        for part in fields(campaign)
        if part.name not in _OF_ALL
        and isinstance(value := getattr(campaign, part.name), np.ndarray)
    }
    return replace(campaign, seas=tuple(campaign.seas[row] for row in rows.tolist()), **arrays)
