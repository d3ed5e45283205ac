"""In which conditions a twin's 95 % intervals hold the truth, on cages of the family.

    python tools/score_calibration.py CAMPAIGN OUT --truths 33-38 [--heavy 33,34] [--workers 2]

CAMPAIGN is one of ``seacage campaign run --plan current --method settle``. Each truth is a settled
virtual field of 50 days, odd numbers in tame and even ones in coastal water, with a shackle on
every bridle; the twin trains with the cage's own sensors, depths on 25 days and shackles on half a
day, and is scored on the last 25 days against the truth without sensors' errors: by third of the
load, direction of the current, days since the training, growth since then, whether the water is
faster than any in the training, and age of the buoy's sample; as trained, and with the factors of
the living depth sensors. With ``--heavy`` the nets of those truths are clean until the depths'
training ends, and grow from then on; they are summed up apart. Fields, twins and answers are kept
in OUT; stopped, it goes on. Virtual field.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from _calibration_fields import AGED_TIMES, AGES_MIN, Answers, Outputs, answers_of
from _family_fields import SCORED_FROM, numbers, options_for

from seacage.cage import Cage
from seacage.records import read_campaign
from seacage.twin import Training, train
from seacage.twin._interval_factors import LOAD_POWER

SECTORS = ("north", "east", "south", "west")
GROWTHS = (("less by 0.3", -9.0, -0.3), ("about the same", -0.3, 0.3), ("more by 0.3", 0.3, 9.0))
IN_KN = ("shackles", "bridles of level 1")
LAST = 40.0  # day from which the last days count
LEAST = {"depths": 0.88, "shackles": 0.85, "bridles of level 1": 0.85, "nodes": 0.85}
Scores = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Whether each interval holds the truth, its width, and its score."""


def main() -> None:
    """Train and answer, truth by truth, and sum up."""
    options = options_for(__doc__, truths="33-38")
    options.add_argument("--heavy", type=numbers, default=[])
    given = options.parse_args()
    campaign = read_campaign(given.campaign)
    base = train(Cage.from_toml(campaign.cage_toml), campaign, training=Training(restarts=0))
    for name, truths in (("", given.truths), (", heavy growth", given.heavy)):
        answers = [answers_of(base, one, given, heavy=bool(name)) for one in truths]
        if answers:
            report(answers, f"{len(answers)} truths{name} (virtual field)")


def report(answers: Sequence[Answers], title: str) -> None:
    """Print coverage, mean width and interval score by group and condition."""
    for group in answers[0].groups:
        unit = 1e-3 if group in IN_KN else 1.0
        outputs = [one.groups[group] for one in answers]
        every = [scores_of(one, one.std[0]) for one in outputs]
        each = [held.mean(axis=0) for held, _, _ in every]
        cages, least = np.array([one.mean() for one in each]), LEAST.get(group, 0.88)
        worst = np.array([np.min(one) for one in each]) if group == "depths" else cages
        below = np.sum(worst < least)
        print(f"{title}, {group}\n  {'all':40s}{_row(every, unit)}")
        print(f"  least cage {cages.min():.2f}; below {least} on {below} of {len(cages)}")
        parts: dict[str, list[Scores]] = {}
        for one, output, scores in zip(answers, outputs, every, strict=True):
            for name, mask in _conditions(one, output, group):
                parts.setdefault(name, []).append(_some(scores, mask))
            for name, more in _doors(one, output, group):
                parts.setdefault(name, []).append(more)
        for name, scores in parts.items():
            print(f"  {name:40s}{_row(scores, unit)}")


def scores_of(one: Outputs, std: np.ndarray, age: int = 0) -> Scores:
    """Scores of intervals, (time, output). Nothing but a node lies below zero."""
    ends = one.mean[age] - 1.96 * std, one.mean[age] + 1.96 * std
    lower, upper = ends if one.true.min() < 0.0 else (np.maximum(end, 0.0) for end in ends)
    miss = np.maximum(lower - one.true, 0.0) + np.maximum(one.true - upper, 0.0)
    return miss <= 0.0, upper - lower, upper - lower + 40.0 * miss


def _conditions(whole: Answers, one: Outputs, group: str) -> Iterator[tuple[str, np.ndarray]]:
    """Name and mask, (time, output), of each condition."""
    shape, size = one.true.shape, one.mean[0]
    if group in ("nodes", "volume"):
        whole = whole.at_nets()
        size = np.repeat(whole.size, 3, axis=1) if group == "nodes" else 1.0 - size
    edges = np.quantile(size, [1 / 3, 2 / 3], axis=0)
    third = (size > edges[0]).astype(int) + (size > edges[1])
    for k in range(3):
        yield f"third {k + 1} of the load", third == k
    toward = np.rad2deg(np.arctan2(*whole.velocity.T))
    sector = np.floor((toward + 45.0) / 90.0) % 4
    for k, name in enumerate(SECTORS):
        yield f"current to the {name}", _tile(sector == k, shape)
    since = whole.day[:, None] - one.trained
    for start in np.arange(SCORED_FROM, 50.0, 5.0):
        some = (whole.day >= start) & (whole.day < start + 5.0)
        days = f"{since[some].min():.0f} to {np.ceil(since[some].max()):.0f}"
        yield f"{days} days since the training", _tile(some, shape)
    begun = np.interp(one.trained, whole.day, whole.growth)
    more = whole.growth[:, None] - begun
    for name, low, high in GROWTHS:
        yield f"growth since day 25 {name}", (more >= low) & (more < high)
    faster = np.linalg.norm(whole.velocity, axis=1)[:, None] > one.fastest
    yield "slower than in the training", ~faster
    yield "faster than in the training", faster


def _doors(whole: Answers, one: Outputs, group: str) -> Iterator[tuple[str, Scores]]:
    """Scores by age of the input, and with the factors of the depth sensors."""
    for age, minutes in enumerate(AGES_MIN):
        some = slice(None, None, 1 if group in ("nodes", "volume") else AGED_TIMES)
        for words, std in ((", as if new", one.std), ("", one.late)):
            scores = scores_of(one, std[age], age)
            yield f"input {minutes:.0f} min old{words}", _some(scores, some)
    if group in ("nodes", "volume"):
        return
    last = whole.day >= LAST
    if group == "depths":
        others = [np.median(np.log(np.delete(whole.factor, k, 1)), axis=1) for k in range(3)]
        own = scores_of(one, one.std[0] * whole.factor)
        yield "living, with its own factor", own
        yield "living, with its own factor, last days", _some(own, last)
        name, factor = "silent", np.exp(np.maximum(np.stack(others, axis=1), 0.0))
    else:
        median = np.maximum(np.median(np.log(whole.factor), axis=1), 0.0)
        name, factor = "without a sensor", np.exp(LOAD_POWER * median)[:, None]
    for word, std in (("as trained", one.std[0]), ("factor of the depths", one.std[0] * factor)):
        scores = scores_of(one, std)
        yield f"{name}, {word}", scores
        yield f"{name}, {word}, last days", _some(scores, last)


def _some(scores: Scores, some: np.ndarray | slice) -> Scores:
    held, width, score = scores
    return held[some], width[some], score[some]


def _tile(mask: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    return np.broadcast_to(mask[:, None], shape)


def _row(scores: Sequence[Scores], unit: float) -> str:
    held, width, score = (np.concatenate([one[k].ravel() for one in scores]) for k in range(3))
    if not len(held):
        return "none"
    return f"{held.mean():.3f}  width {width.mean() * unit:.3g}  score {score.mean() * unit:.3g}"


if __name__ == "__main__":
    main()
