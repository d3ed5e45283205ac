"""What level 2 of lines' loads in waves is worth in three virtual fields, on all bridles.

    python tools/three_wave_fields.py OUT CAMPAIGN           36 hours each, 70 core-minutes
    python tools/three_wave_fields.py OUT CAMPAIGN --seeds 0 --workers 1 --every 2
    python tools/three_wave_fields.py OUT CAMPAIGN --coarse  a truth on 16 spokes, in half of it

Each seed draws another true cage from the ranges of the hidden parameters, and meets other
weather, from calm to waves of some 2 m. Shackles train on the first 12 hours and are scored on the
24 after them, against the truth of all bridles. CAMPAIGN: of plan ``loads``, of a cage with a T-N
slope of its bridles.
"""

import argparse
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.campaigns import (
    Timetable,
    TruthParameters,
    VirtualField,
    generated_current,
    generated_waves,
    virtual_field,
)
from seacage.dynamics import extremes
from seacage.ocean import SeaState, WaveDraw
from seacage.records import moment, read_campaign
from seacage.surrogates import Loads, block_bootstrap
from seacage.twin import Training, Twin, Windows, align, sensor_windows, train

DAYS = 1.5

EVERY_S = 0.5
"""Between readings [s]."""

COMPONENTS = 1200
"""Of the waves: with the 64 of other fields Hs of ten minutes scatters a quarter of what theory
says, as too few of them beat within that time."""

WEATHER = {0: (0, 84), 1: (4, 528), 2: (5, 264)}
"""By the cage's seed: seed and first hour of weather with calm and rough hours in both windows."""

NEW_YEAR = datetime(2020, 1, 18, tzinfo=UTC)


def watched(cage: Cage) -> Cage:
    """Cage with a shackle at each bridle, those that it has keeping their names."""
    has = {one.bridle for one in cage.shackles}
    others = [
        replace(cage.shackle[0], name=name, bridle=number)
        for number, name in enumerate(cage.bridle_names, start=1)
        if number - 1 not in has
    ]
    return replace(cage, shackle=(*cage.shackle, *others))


def field_in_waves(
    cage: Cage, seed: int, out: Path, hidden: TruthParameters, *, workers: int | None = None
) -> VirtualField:
    """Virtual field of one hidden cage, from its stretches where they are there."""
    hidden = replace(
        hidden.drawn(seed),
        waves=replace(hidden.waves, components=COMPONENTS),
        shackle=replace(hidden.shackle, windows=((0.0, 24.0 * DAYS + 1.0),)),
    )
    weather, hour = WEATHER[seed]
    start = NEW_YEAR + timedelta(hours=hour)
    end = start + timedelta(days=DAYS)
    days = hour / 24.0 + DAYS + 0.1
    buoy = generated_current(weather, start=NEW_YEAR, days=days).between(start, end)
    return virtual_field(
        watched(cage),
        buoy,
        hidden=hidden,
        seed=seed,
        waves=generated_waves(weather, start=NEW_YEAR, days=days),
        every_s=EVERY_S,
        timetable=Timetable.over(buoy),
        kept=out / f"field-{seed}",
        workers=workers,
        progress=ProgressLine(),
    )


@dataclass(kw_only=True)
class ProgressLine:
    """Prints each whole step once."""

    last: int = -1

    def __call__(self, name: str, done: int, total: int) -> None:
        """Print it."""
        if done != self.last:
            print(f"{name}: {done} of {total}", flush=True)
        self.last = done


def scatter_of_hs(hidden: TruthParameters, sea: SeaState) -> tuple[float, float]:
    """Scatter of Hs over ten minutes, over its mean: of a day's surface, and of theory.

    Theory: the variance of a Gaussian process's variance over a time T is the integral of the
    squared spectrum, over T.
    """
    depth, random = 191.0, np.random.default_rng(0)
    waves, fine = (
        WaveDraw.sample(random, components=count, spreading=hidden.waves.spreading).waves(
            sea, depth=depth
        )
        for count in (COMPONENTS, 40 * COMPONENTS)
    )
    time = np.arange(0.0, 86400.0, 1.0)
    surface = np.zeros_like(time)
    parts = waves.amplitude, waves.angular_frequency, waves.phase
    for amplitude, frequency, phase in zip(*parts, strict=True):
        surface += amplitude * np.cos(frequency * time - phase)
    hs = 4.0 * surface.reshape(-1, 600).std(axis=1)
    energy = fine.amplitude**2 / 2.0
    width = np.ptp(fine.angular_frequency) / len(energy) / (2.0 * math.pi)
    theory = math.sqrt(float(np.sum(energy**2)) / width / 600.0) / float(energy.sum()) / 2.0
    return float(hs.std() / hs.mean()), theory


@dataclass(frozen=True, kw_only=True)
class Judged:
    """Errors of one bridle on the scoring window, and what its intervals hold."""

    level: int
    error: Mapping[str, tuple[np.ndarray, np.ndarray]]  # relative, of level 1 and of the twin
    holds: Mapping[str, np.ndarray]  # 90 % intervals, at level 2


def score_bridle(
    line: int, twin: Twin, low: Twin, windows: Windows, series: dict[int, np.ndarray]
) -> Judged:
    """Score one bridle.

    ``series``: its true tension in each window [N], by the window's number.
    """
    answers = [one.predict(windows.metocean) for one in (low, twin)]
    inside = answers[0].line_in_domain
    loads = [of_line(answer.line, line).rows(inside) for answer in answers if answer.line]
    kept = windows.rows(inside)
    short = [one.maximum_3h.of_share(1 / 18) for one in loads]
    truth = {"mean": kept.mean, "std": kept.std, "maximum of 10 min": kept.maximum}
    found = {
        "mean": [one.mean.mean[:, 0] for one in loads],
        "std": [one.std.mean[:, 0] for one in loads],
        "maximum of 10 min": [one.mean[:, 0] for one in short],
    }
    error = {name: relative(found[name], truth[name]) for name in truth}
    lower, upper = loads[1].std.interval(0.9)
    holds = {"std": (lower[:, 0] <= kept.std) & (kept.std <= upper[:, 0])}
    block = kept.number // 18
    whole = [one for one in np.unique(block) if (block == one).sum() >= 15]
    rows = [block == one for one in whole]
    tension = [np.concatenate([series[n] for n in kept.number[row].tolist()]) for row in rows]
    pooled = [[one.maximum_3h.rows(row).pooled(1 / 18) for row in rows] for one in loads]
    expected = np.array(
        [
            extremes([one[:, None]], every=EVERY_S, hours=len(one) / 7200).expected[0]
            for one in tension
        ]
    )
    error["expected 3-hour maximum"] = relative(
        [np.array([float(one.mean[0, 0]) for one in each]) for each in pooled], expected
    )
    slope = twin.cage.bridles.tn_slope or math.nan
    wear = [together(kept.damage, rows, slope)]
    wear += [together(one.damage_equivalent.mean[:, 0], rows, slope) for one in loads]
    error["damage-equivalent load, 3 hours"] = relative(wear[1:], wear[0])
    ends = [one.interval(0.9) for one in pooled[1]]
    holds["3-hour maximum"] = np.array(
        [
            float(lower[0, 0]) <= one.max() <= float(upper[0, 0])
            for (lower, upper), one in zip(ends, tension, strict=True)
            if np.isfinite(lower).all()
        ]
    )
    return Judged(level=int(answers[1].line_level[line]), error=error, holds=holds)


def of_line(loads: Loads, line: int) -> Loads:
    """Loads of one line."""
    one = np.array([line])
    return replace(
        loads,
        mean=replace(loads.mean, mean=loads.mean.mean[:, one], std=loads.mean.std[:, one]),
        **{
            name: getattr(loads, name).lines(one)
            for name in ("std", "maximum_3h", "damage_equivalent")
        },
    )


def together(values: np.ndarray, rows: list[np.ndarray], slope: float) -> np.ndarray:
    """Damage-equivalent load of several windows."""
    return np.array([np.mean(values[row] ** slope) ** (1.0 / slope) for row in rows])


def relative(found: list[np.ndarray], truth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Absolute errors over the truth, of level 1 and of the twin."""
    low, best = (np.abs(one - truth) / truth for one in found)
    return low, best


def is_worse(low: Float[np.ndarray, " t"], best: Float[np.ndarray, " t"], block: int) -> bool:
    """Whether errors exceed level 1's by more than 5 % for certain, by blocks of time."""
    difference = best - 1.05 * low
    return block_bootstrap(difference, block=min(block, len(low)), seed=0)[1] > 0.0


BASELINES = "training mean", "gain and offset", "linear"


def baselines(train_on: Windows, score: Windows, low: list[np.ndarray]) -> dict[str, float]:
    """Median error of what a sceptic would try on the standard deviation, from the shackle alone
    or from it and level 1 (``low``, at the windows of training and scoring).
    """

    def design(windows: Windows) -> np.ndarray:
        sea = windows.metocean
        return np.column_stack(
            [np.ones(len(windows)), np.log(sea.hs), np.log(sea.tp), sea.current_velocity]
        )

    gain = np.polyfit(low[0], train_on.std, 1)
    log = np.linalg.lstsq(design(train_on), np.log(train_on.std), rcond=None)[0]
    found = np.full(len(score), train_on.std.mean()), np.polyval(gain, low[1])
    every = [*found, np.exp(design(score) @ log)]
    return {
        name: float(np.median(np.abs(one - score.std) / score.std))
        for name, one in zip(BASELINES, every, strict=True)
    }


def judge(
    cage: Cage, low: Twin, field: VirtualField, *, every: float
) -> tuple[dict[str, Judged], dict[str, dict[str, float]]]:
    """Train on the first 12 hours and score each bridle on the others."""
    begin = moment(field.truth.sensors["shackle-1"].time[0])
    middle = begin + timedelta(hours=12)
    own = {name: one for name, one in field.record.sensors.items() if name in cage.sensor_names}
    thin = {name: one.rows(slice(None, None, round(every / EVERY_S))) for name, one in own.items()}
    record = replace(field.record, sensors=thin)
    twin = train(cage, None, record, base=low, training=Training(days=0.5, restarts=1))
    exact = replace(field.record, sensors=field.truth.sensors)
    found, sceptic = {}, {}
    slope = cage.bridles.tn_slope or math.nan
    for shackle in watched(cage).shackles:
        # A line that hangs slack bears 0 N to the last digit, as no sensor that is stuck would.
        pairs = align(exact, shackle.name, start=middle)
        pairs = replace(pairs, value=pairs.value + 1e-3 * (np.arange(len(pairs)) % 2))
        windows = sensor_windows(pairs, noise_sd=0.0, tn_slope=slope)
        assert windows is not None
        number = pairs.time.astype("datetime64[us]").astype(np.int64) // 600_000_000
        first, last = (np.searchsorted(number, windows.number, side=k) for k in ("left", "right"))
        series = {
            int(n): pairs.value[a:b] for n, a, b in zip(windows.number, first, last, strict=True)
        }
        name = cage.bridle_names[shackle.bridle]
        found[name] = score_bridle(shackle.bridle, twin, low, windows, series)
        if shackle.name in own:
            seen = sensor_windows(align(record, shackle.name, end=middle))
            assert seen is not None
            std = [
                answer.line.std.mean[:, shackle.bridle]
                for answer in (low.predict(one.metocean) for one in (seen, windows))
                if answer.line
            ]
            sceptic[name] = baselines(seen, windows, std)
    for name, one in twin.models.line_upper.items():
        print(f"  {name}: {one}")
    return found, sceptic


def report(found: list[dict[str, Judged]]) -> None:
    """Print the errors of the bridles of all fields (virtual field)."""
    every = [(n, name, one) for n, field in enumerate(found) for name, one in field.items()]
    for statistic in every[0][2].error:
        print(f"{statistic}: median error, level 1 and twin [%] (virtual field)")
        for n, name, one in every:
            low, best = one.error[statistic]
            known = np.isfinite(low) & np.isfinite(best)
            if not known.any():
                continue
            before, after = (100.0 * np.median(values[known]) for values in (low, best))
            worse = is_worse(low[known], best[known], 12 if len(low) > 20 else 2)
            note = " halved" if before > 10.0 and after <= before / 2 else ""
            note += " WORSE" if worse else ""
            print(f"  field {n} {name}, level {one.level}: {before:.1f} -> {after:.1f}{note}")
        for level in (1, 2):
            pairs = [one.error[statistic] for _, _, one in every if one.level == level]
            if pairs:
                low, best = (
                    100 * np.nanmedian(np.concatenate(part)) for part in zip(*pairs, strict=True)
                )
                print(f"  all of level {level}: {low:.1f} -> {best:.1f}")
    for name in every[0][2].holds:
        held = [one.holds[name] for _, _, one in every if one.level == 2 and len(one.holds[name])]
        if not held:
            continue
        print(
            f"90 % interval of {name} at level 2 holds {np.concatenate(held).mean():.0%} "
            f"of {sum(map(len, held))} (virtual field)"
        )


def main() -> None:
    """Simulate the fields, train and score."""
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("out", type=Path, help="folder of the fields; goes on where it was")
    options.add_argument("campaign", type=Path)
    options.add_argument("--seeds", default="0,1,2")
    options.add_argument("--hidden", type=Path, help="hidden parameters; else those shipped")
    options.add_argument("--every", type=float, default=EVERY_S, help="between readings, s")
    options.add_argument("--coarse", action="store_true", help="a truth on 16 spokes, not refined")
    options.add_argument("--workers", type=int)
    given = options.parse_args()
    campaign, hidden = read_campaign(given.campaign), TruthParameters.read(given.hidden)
    true = Cage.named("ace")
    if given.coarse:
        true = true.altered(mesh={"spokes": 16})
        hidden = replace(hidden, netting=replace(hidden.netting, refined=1))
    cage, base = Cage.from_toml(campaign.cage_toml), given.out / "level-1"
    if not base.exists():
        train(cage, campaign, training=Training(restarts=1)).write(base)
    low = Twin.read(base)
    for hs, tp in ((0.8, 5.0), (2.0, 7.0)):
        sea = SeaState(current_speed=0.0, current_to=0.0, hs=hs, tp=tp, wave_from=0.0)
        scatter, theory = scatter_of_hs(hidden, sea)
        print(f"Hs of 10 minutes at Hs {hs:g} m, Tp {tp:g} s: {scatter:.2%}, theory {theory:.2%}")
    found = list[dict[str, Judged]]()
    for seed in map(int, given.seeds.split(",")):
        field = field_in_waves(true, seed, given.out, hidden, workers=given.workers)
        print(f"seed {seed}, hidden parameters {hidden.drawn(seed).sha256[:10]} (virtual field)")
        errors, sceptic = judge(cage, low, field, every=given.every)
        found.append(errors)
        for name, one in sceptic.items():
            others = ", ".join(f"{key} {100 * value:.1f}" for key, value in one.items())
            print(f"  {name}, median error of std by {others} %", flush=True)
    report(found)


if __name__ == "__main__":
    main()
