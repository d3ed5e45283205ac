"""In which conditions a twin's 95 % intervals hold the truth, on cages of the family.

    python tools/score_calibration.py CAMPAIGN OUT --truths 27-38 [--heavy 29 33 34] [--workers 2]

CAMPAIGN is one of ``seacage campaign run --plan current --method settle``. Each truth is a settled
virtual field of 50 days, odd numbers in tame and even ones in coastal water, with a shackle on
every bridle; the twin trains with the cage's own sensors, depths on 25 days and shackles on half a
day, and is scored on the last 25 days against the truth without sensors' errors: by third of the
load, direction of the current, age of the buoy's sample, days since the training, growth since
then, and whether the water is faster than any in the training. With ``--heavy`` the nets of those
truths are clean until the depths' training ends, and grow from then on. Fields and answers are kept
in OUT; stopped, it goes on. Virtual field.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from _calibration_fields import AGES_MIN, NODE_TIMES, Answers, answers_of
from _family_fields import SCORED_FROM, options_for

from seacage.cage import Cage
from seacage.records import read_campaign
from seacage.twin import Training, train

GROUPS = ("depths", "shackles", "bridles of level 1", "nodes", "volume")
AGED, SECTORS = 3, ("north", "east", "south", "west")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outputs:
    """Of one field and one group, (time, output), but for the ages."""

    true: np.ndarray
    mean: np.ndarray  # (age, time, output)
    std: np.ndarray
    size: np.ndarray  # by which the thirds are
    low: float  # least possible value
    velocity: np.ndarray  # (time, 2)
    day: np.ndarray
    growth: np.ndarray
    trained: np.ndarray  # day, by output
    fastest: np.ndarray  # by output


def outputs_of(one: Answers, group: str) -> Outputs:
    """Take a group's outputs from a field's answers."""
    depths = one.factor.shape[1]
    last = np.nanmax(one.trained)
    if group in GROUPS[:2]:
        some = slice(0, depths) if group == "depths" else slice(depths, None)
        parts = one.true[:, some], one.mean[..., some], one.std[..., some]
        trained, fastest = one.trained[some], one.fastest[some]
        low = 0.0
    elif group == GROUPS[2]:
        some = one.bridle_level == 1
        parts = one.bridle_true[:, some], one.bridle_mean[..., some], one.bridle_std[..., some]
        trained = np.full(some.sum(), np.nanmin(one.trained))
        fastest = np.full(some.sum(), np.nanmin(one.fastest))
        low = 0.0
    else:
        if group == "nodes":
            flat = [v.reshape(len(v), -1) for v in (one.node_true, one.node_mean, one.node_std)]
            size = np.repeat(one.node_size, 3, axis=1)
        else:
            flat = [v[:, None] for v in one.volume]
            size = 1.0 - flat[1]
        at = slice(0, None, NODE_TIMES)
        count = flat[0].shape[1]
        return Outputs(
            true=flat[0],
            mean=flat[1][None],
            std=flat[2][None],
            size=size,
            low=-np.inf,
            velocity=one.velocity[0, at],
            day=one.day[at],
            growth=one.growth[at],
            trained=np.full(count, last),
            fastest=np.full(count, np.nanmax(one.fastest[:depths])),
        )
    return Outputs(
        true=parts[0],
        mean=parts[1],
        std=parts[2],
        size=parts[1][0],
        low=low,
        velocity=one.velocity[0],
        day=one.day,
        growth=one.growth,
        trained=trained,
        fastest=fastest,
    )


def scores_of(one: Outputs, age: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Whether each interval holds the truth, its width and its score, (time, output)."""
    ends = one.mean[age] - 1.96 * one.std[age], one.mean[age] + 1.96 * one.std[age]
    lower, upper = (np.maximum(end, one.low) for end in ends)
    miss = np.maximum(lower - one.true, 0.0) + np.maximum(one.true - upper, 0.0)
    return miss <= 0.0, upper - lower, upper - lower + 40.0 * miss


def cuts_of(one: Outputs) -> Iterator[tuple[str, np.ndarray]]:
    """Name and mask, (time, output), of each condition."""
    shape = one.true.shape
    third = np.stack(
        [np.digitize(col, np.quantile(col, [1 / 3, 2 / 3])) for col in one.size.T], axis=1
    )
    for k in range(3):
        yield f"load third {k + 1}", third == k
    toward = np.rad2deg(np.arctan2(one.velocity[:, 0], one.velocity[:, 1]))
    sector = np.floor((toward + 45.0) / 90.0) % 4
    for k, name in enumerate(SECTORS):
        yield f"current to {name}", np.broadcast_to((sector == k)[:, None], shape)
    for start in np.arange(SCORED_FROM, 50.0, 5.0):
        inside = (one.day >= start) & (one.day < start + 5.0)
        yield f"day {start:.0f}-{start + 5:.0f}", np.broadcast_to(inside[:, None], shape)
    begun = np.array([np.interp(day, one.day, one.growth) for day in one.trained])
    more = one.growth[:, None] - begun
    for name, low, high in (("< -0.3", -9, -0.3), ("about 0", -0.3, 0.3), ("> 0.3", 0.3, 9)):
        yield f"growth since training {name}", (more >= low) & (more < high)
    speed = np.linalg.norm(one.velocity, axis=1)
    faster = speed[:, None] > one.fastest
    yield "slower than in training", ~faster
    yield "faster than in training", faster


def report(answers: Mapping[str, Answers]) -> None:
    """Print coverage, mean width and interval score by group and condition."""
    for group in GROUPS:
        outputs = [outputs_of(one, group) for one in answers.values()]
        scale = 1e-3 if group in GROUPS[1:3] else 1.0
        every = [scores_of(one) for one in outputs]
        by_output = [held.mean(axis=0) for held, _, _ in every]
        by_cage = np.array([one.mean() for one in by_output])
        whole = all_ = np.concatenate(by_output)
        print(
            f"{group}: {_row([np.concatenate([s[k].ravel() for s in every]) for k in range(3)], scale)}"
            f"; least cage {by_cage.min():.2f}, cages below 0.85: {np.sum(by_cage < 0.85)}"
            f", below 0.88: {np.sum(by_cage < 0.88)} of {len(by_cage)}"
            f"; outputs below 0.88: {np.sum(whole < 0.88)} of {len(all_)}"
        )
        names = [name for name, _ in cuts_of(outputs[0])]
        cut = {name: [[], [], []] for name in names}
        for one, scores in zip(outputs, every, strict=True):
            for name, mask in cuts_of(one):
                for k in range(3):
                    cut[name][k].append(scores[k][mask])
        for name in names:
            print(f"  {name:32s} {_row([np.concatenate(v) for v in cut[name]], scale)}")
        if outputs[0].mean.shape[0] > 1:
            for age, minutes in enumerate(AGES_MIN):
                some = [scores_of(one, age) for one in outputs]
                parts = [np.concatenate([s[k].ravel() for s in some]) for k in range(3)]
                print(f"  input {minutes:.0f} min old{'':18s} {_row(parts, scale)}")


def _row(parts: list[np.ndarray], scale: float) -> str:
    if not len(parts[0]):
        return "none"
    held, width, score = (float(one.mean()) for one in parts)
    return (
        f"holds {held:.3f}, width {width * scale:.3g}, score {score * scale:.3g} ({len(parts[0])})"
    )
