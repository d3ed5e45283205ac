"""How often the fault detector alarms for nothing on cages of the family, and how soon it finds.

    python tools/score_alarms.py CAMPAIGN OUT --truths 1-10 [--water coastal] [--days 365]
        [--waves] [--written-down]

CAMPAIGN is one of ``seacage campaign run --plan current --method settle``, or with ``--waves`` of
``--plan paper``; the twin then has the waves among its inputs. Each truth is a settled
virtual field whose sensors have noise, gains and biases but no faults, cleaned as the family draws
it for 48 days, over and over. The twin trains on the first 25 days (shackles on half a day of
them); from then on all sensors live, and the fault detector and its alarms see the residuals of
each half hour. Whatever it raises there is false, but for ``net.net`` within two weeks of a
cleaning, which no sensor can tell from a hole. Then, from the seventh day on, a fault at a time.
With ``--written-down`` people announce each cleaning to the fault detector, as they should.
With ``--waves`` the fields have those (``_fields_in_waves``); with ``--field`` there is one cage,
that of a field simulated in time. Fields and residuals are kept in OUT; stopped, it goes on.
Virtual field.
"""

import argparse
import json
from collections import Counter
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from datetime import datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from _family_fields import SCORED_FROM, START, Water, options_for, values_at
from _fields_in_waves import in_waves, simulated

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, generated_current, virtual_field
from seacage.records import FieldRecord, Record, moment, read_campaign
from seacage.studies._bench._scores import poisson_interval
from seacage.studies._bench._stretches import without_outages
from seacage.twin import FaultWatch, Training, Twin, block_residuals, residual_blocks, train
from seacage.twin._faults._fault_watch import SETTINGS
from seacage.twin._faults._residuals import ResidualBlock
from seacage.twin._metocean import Input

SHACKLES = (5.0, 5.5)  # days that train these; the depth sensors train until ``SCORED_FROM``
CLEANED_EVERY = 48.0  # days after which the family's cleanings come again
READ_EVERY = 600.0  # s
QUIET_DAYS, WATCHED_DAYS = 7.0, 14.0  # before a fault, and for how long it is looked for
AFTER_CLEANING = 14.0  # days
DAY = 86400.0
BASE: list[Twin] = []  # of a process: the twin that has learned the low fidelity


def main() -> None:
    """Train and watch, cage by cage, and sum up."""
    options = options_for(__doc__, truths="1-10")
    options.add_argument("--water", choices=("tame", "coastal"), action="append")
    options.add_argument("--days", type=float, default=365.0)
    options.add_argument("--waves", action="store_true")
    options.add_argument("--written-down", action="store_true")
    options.add_argument("--field", type=Path)
    options.add_argument("--hidden", type=Path)
    given = options.parse_args()
    campaign = read_campaign(given.campaign)
    cage = Cage.from_toml(campaign.cage_toml)
    inputs: tuple[Input, ...] = ("current", "waves") if given.waves else ("current",)
    base = train(cage, campaign, training=Training(restarts=0, inputs=inputs))
    if given.field:
        BASE.append(base)
        residuals = _residuals_in_time(given)
        _sum_up("its own water", {0: _watched(residuals, cage, written_down=given.written_down)})
        return
    for water in given.water or ("tame", "coastal"):
        score = partial(_score, water, given)
        # Twins are inherited, not pickled: their kernels hold functions.
        with ProcessPoolExecutor(given.workers, initializer=BASE.append, initargs=(base,)) as pool:
            _sum_up(water, dict(zip(given.truths, pool.map(score, given.truths), strict=True)))


def _score(water: Water, given: argparse.Namespace, number: int) -> dict[str, Any]:
    """What is raised on a cage of the family, once found."""
    waves = ", in waves" if given.waves else ""
    kept = given.out / f"{water}-{number}, {SCORED_FROM + given.days:g} days{waves}"
    announced = ", written down" if given.written_down else ""
    found = kept.with_name(f"{kept.name}{announced}.json")
    if not found.is_file():
        residuals = _kept_residuals(kept.with_name(f"{kept.name}.npz"), water, given, number)
        watched = _watched(residuals, BASE[0].cage, written_down=given.written_down)
        found.write_text(json.dumps(watched))
    return json.loads(found.read_text())


def _kept_residuals(
    kept: Path, water: Water, given: argparse.Namespace, number: int
) -> dict[str, np.ndarray]:
    """Residuals of a cage by half hours, once made."""
    if not kept.is_file():
        days = SCORED_FROM + given.days
        hidden = TruthParameters.of_family(number, water=water, unseal=given.unseal)
        hidden = _without_faults(hidden, days)
        (base,) = BASE
        folder = given.out / f"{water}-{number}"
        field = virtual_field(
            base.cage,
            generated_current(number, start=START, days=days),
            hidden=hidden,
            seed=number,
            method="settle",
            every_s=READ_EVERY,
            kept=folder,
            workers=1,
        ).record
        if given.waves:
            field = in_waves(base.cage, field, hidden=hidden, seed=number, kept=folder)
        twin = _trained(field)
        found = _residuals(twin, field)
        found["cleaned"] = np.array(hidden.fouling.cleaned_days)
        np.savez(kept, allow_pickle=False, **found)
    return dict(np.load(kept))


def _residuals_in_time(given: argparse.Namespace) -> dict[str, np.ndarray]:
    """Residuals of a field that was simulated in time, of seed 0."""
    hidden = TruthParameters.read(given.hidden)
    field = simulated(given.field, hidden=without_outages(hidden), seed=0)
    found = _residuals(_trained(field), field)
    found["cleaned"] = np.array(hidden.fouling.cleaned_days)
    return found


def _trained(field: FieldRecord) -> Twin:
    """Level 2 by the first 25 days, of the shackles by half a day."""
    (base,) = BASE
    training = Training(restarts=1, inputs=base.models.inputs)
    return train(base.cage, None, _taught(field), base=base, training=training)


def _without_faults(hidden: TruthParameters, days: float) -> TruthParameters:
    rounds = CLEANED_EVERY * np.arange(int(days / CLEANED_EVERY) + 1)
    cleaned = np.sort(np.add.outer(rounds, hidden.fouling.cleaned_days).ravel())
    return replace(
        without_outages(hidden),
        fouling=replace(hidden.fouling, cleaned_days=tuple(cleaned.tolist())),
    )


def _taught(field: FieldRecord) -> FieldRecord:
    first = moment(field.buoy.time[0])

    def within(one: Record, days: tuple[float, float]) -> Record:
        return one.between(*(first + timedelta(days=day) for day in days))

    whole = (0.0, SCORED_FROM)
    sensors = {
        name: within(one, SHACKLES if "tension_kn" in one.values else whole)
        for name, one in field.sensors.items()
    }
    return replace(field, buoy=within(field.buoy, whole), sensors=sensors)


def _residuals(twin: Twin, field: FieldRecord) -> dict[str, np.ndarray]:
    """Residuals of each half hour after the training, as the fault detector forms them."""
    time = next(iter(field.sensors.values())).time
    time = time[time >= field.buoy.time[0] + np.timedelta64(int(SCORED_FROM * DAY), "s")]
    read = np.column_stack([values_at(field.sensors[name], time) for name in twin.sensor_names])
    number = time.astype("datetime64[s]").astype(int) // int(SETTINGS.block_s)
    start = field.buoy.time[:1].astype("datetime64[s]").astype(int)
    return {**block_residuals(twin, field.buoy, time, read, number), "start": start}


def _blocks_of(kept: Mapping[str, np.ndarray]) -> dict[float, ResidualBlock]:
    """The blocks by the day of the record at which they end."""
    days = ((kept["number"] + 1) * SETTINGS.block_s - kept["start"]) / DAY
    return dict(zip(days.tolist(), residual_blocks(kept), strict=True))


def _watched(kept: Mapping[str, np.ndarray], cage: Cage, *, written_down: bool) -> dict[str, Any]:
    """What is raised without a fault, days that it stands, and those until each fault is raised.

    ``written_down``: whether the fault detector learns of cleanings from people.
    """
    blocks, names = _blocks_of(kept), kept["sensors"].tolist()
    cleaned = kept["cleaned"].tolist() if written_down else []
    watch = FaultWatch.over(cage, names)
    raised, known = list[tuple[str, float]](), None
    standing, longest = Counter[str](), Counter[str]()  # half hours, of alarms that stand
    for day, block in blocks.items():
        if known is None and day >= SCORED_FROM + QUIET_DAYS:
            known = watch.copied()
        raised += [(name, round(day, 2)) for name in _see(watch, day, block, cleaned)]
        active = [name for name, alarm in watch.alarms.items() if alarm.active]
        standing = Counter({name: standing[name] + 1 for name in active})
        longest |= standing
    assert known is not None
    late = {day: one for day, one in blocks.items() if day >= SCORED_FROM + QUIET_DAYS}
    return {
        "days": len(blocks) / 48.0,
        "raised": raised,
        "stands": {name: half_hours / 48.0 for name, half_hours in longest.items()},
        "cleaned": kept["cleaned"].tolist(),
        "delays": {
            fault: [
                _delay(known.copied(), late, fault, row, cleaned)
                for row, name in enumerate(names)
                if name.startswith(kind)
            ]
            for fault, kind in FAULTS.items()
        },
    }


def _shift(fault: str, cage: Cage, block: ResidualBlock, row: int, days: float) -> float:
    """What a fault adds to a sensor's reading some days after it began [N] or [m]."""
    if fault == "drift":
        return 0.1 * days
    if fault == "offset":
        return 3.0 * float(block.own_sd[row])
    (bridle,) = (one.bridle for one in cage.shackles if one.name == block.sensors[row])
    return -float(block.tension[bridle])


# By fault, how the names of the sensors begin that have it
FAULTS = {"drift": "depth", "offset": "", "nothing": "shackle"}


def _see(
    watch: FaultWatch, day: float, block: ResidualBlock, cleaned: list[float]
) -> Iterator[str]:
    """Take a half hour in, after the announcement of a cleaning within it."""
    if any(day - SETTINGS.block_s / DAY < one <= day for one in cleaned):
        watch.detector = watch.detector.after_change("net.net", SETTINGS)
    return watch.see(_at(day), block)


def _delay(
    watch: FaultWatch,
    blocks: Mapping[float, ResidualBlock],
    fault: str,
    row: int,
    cleaned: list[float],
) -> float | None:
    """Days until a fault of a sensor raises its alarm; None where none is in time."""
    first = next(iter(blocks))
    for day, block in blocks.items():
        if day - first > WATCHED_DAYS:
            break
        residual = block.residual.copy()
        residual[row] += _shift(fault, watch.cage, block, row, day - first)
        raised = list(_see(watch, day, replace(block, residual=residual), cleaned))
        if f"irregular.{block.sensors[row]}" in raised:
            return day - first
    return None


def _at(day: float) -> datetime:
    return START + timedelta(days=day)


def _sum_up(water: str, found: Mapping[int, dict[str, Any]]) -> None:
    years, false, cleaned = 0.0, Counter[str](), 0
    for number, one in found.items():
        own = Counter(name for name, day in one["raised"] if not _by_cleaning(name, day, one))
        stands = ", ".join(f"{name} {days:.1f}" for name, days in one["stands"].items())
        print(f"{water}, truth {number}: {one['days']:.0f} days, {dict(own) or 'none'}")
        print(f"  days that an alarm stood at the longest: {stands or 'none'}")
        years, false = years + one["days"] / 365.0, false + own
        cleaned += len(one["raised"]) - own.total()
    low, high = poisson_interval(false.total())
    print(
        f"{water}: {false.total()} false alarms in {years:.1f} cage-years, "
        f"{false.total() / years:.2f} a year [{low / years:.2f}, {high / years:.2f}]; "
        f"{cleaned} of the net after a cleaning (virtual field)"
    )
    for fault in FAULTS:
        delays = [delay for one in found.values() for delay in one["delays"][fault]]
        some = [one for one in delays if one is not None]
        middle = np.median(some or [np.nan])
        print(f"  {fault}: {len(some)} of {len(delays)}, median {middle:.2f} days")


def _by_cleaning(alarm: str, day: float, one: Mapping[str, Any]) -> bool:
    """Whether it speaks of the drag that a cleaning took."""
    return alarm == "net.net" and any(0.0 <= day - c <= AFTER_CLEANING for c in one["cleaned"])


if __name__ == "__main__":
    main()
