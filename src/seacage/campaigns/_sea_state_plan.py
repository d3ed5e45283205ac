"""Plans: which sea states a campaign visits."""

import hashlib
import itertools
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np

from seacage.conventions import TABLE_BYTES, InputError, parse_json, read_text
from seacage.ocean import MAX_CURRENT_SPEED, SeaState
from seacage.records import SEA_COLUMNS, read_sea_states, sea_columns

Range = tuple[float, float]

# Mean and standard deviation of the shear along the current and to its right [m/s]: 1,980 profiles
# of a bottom-mounted ADCP in 29.5 m of water at Long Beach (Nova Scotia, 2019), as
# ``ocean.current_modes`` has them. Their part to the right is 0 in the mean within 0.006.
LONG_BEACH_SHEAR: tuple[Range, Range] = ((-0.11, 0.22), (0.0, 0.14))
_MOST_DEVIATIONS = 2.5  # from the mean, of drawn shears
# Of the plans that have a name, as ``Plan.sample`` takes them
_PLANS: Mapping[str, Mapping[str, Any]] = {
    "paper": {},
    "default": {"period_ratio": (0.8, 2.2)},
    "current": {"hs": (0.0, 0.0)},
    "profile": {"hs": (0.0, 0.0), "shear": LONG_BEACH_SHEAR},
    "loads": {
        "hs": (0.05, 3.0),
        "period_ratio": (0.63, 3.0),
        "longest_tp": 18.0,
        "corner_every": 16,
    },
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """The sea states of a campaign, and what they stand for."""

    name: str  # what the plan is called in reports
    seas: tuple[SeaState, ...]  # the sea state of each case
    # How long each sea state lasts [s]. Equilibria do not use it; the plan keeps it, so that the
    # same plan can be simulated in time.
    duration: float
    seed: int  # of the draw, if it was drawn, and of the waves

    def __post_init__(self) -> None:
        if not self.seas:
            raise InputError("Plan: no sea states. Give at least one.")
        if not (math.isfinite(self.duration) and self.duration > 0.0):
            raise InputError(
                f"Plan: duration = {self.duration:g} s is not a positive number of seconds."
            )
        _check_seed(self.seed)

    def __len__(self) -> int:
        return len(self.seas)

    @classmethod
    def sample(
        cls,
        seed: int,
        cases: int,
        *,
        duration: float = 1800.0,
        current_speed: Range = (0.0, 1.0),
        current_to: Range = (0.0, 360.0),
        hs: Range = (0.0, 3.0),
        period_ratio: Range = (1.0, 1.0),
        wave_from: Range = (0.0, 360.0),
        longest_tp: float = math.inf,
        corner_every: int | None = None,
        shear: tuple[Range, Range] | None = None,
        name: str = "sample",
    ) -> Self:
        """Draw sea states that fill the ranges evenly: a scrambled Sobol sequence.

        The defaults are the paper's ranges. The first cases of a longer draw with the same
        seed are the shorter draw.

        Parameters
        ----------
        seed
            Of the scrambling.
        cases
            How many sea states.
        duration
            Of each [s].
        current_speed
            Least and largest [m/s].
        current_to, wave_from
            Least and largest, clockwise from true north [deg].
        hs
            Least and largest significant wave height [m]; (0, 0) leaves the waves out.
        period_ratio
            Least and largest Tp / (5 sqrt(Hs)), with Tp in s and Hs in m.
        longest_tp
            Peak period at which the largest ratio ends [s].
        corner_every
            One case in so many lies on a corner of the ranges of current speed, Hs and period,
            in turn, in directions of a draw of their own; None for no corners. A surrogate is
            least sure there.
        shear
            Mean and standard deviation of the current's shear along it, and of that to its right
            [m/s], normal and at most 2.5 deviations from the mean; None for uniform currents.
        name
            Of the plan.

        Source: Sobol (1967); scrambling after Owen (1998), as ``scipy.stats.qmc.Sobol`` does it.
        """
        _check_seed(seed)
        if cases < 1:
            raise InputError(f"Plan.sample: cases = {cases}. Draw at least one sea state.")
        ranges = {
            "current_speed": _range("current_speed", current_speed, "m/s", MAX_CURRENT_SPEED),
            "current_to": _range("current_to", current_to, "deg", 360.0),
            "hs": _range("hs", hs, "m"),
            "period_ratio": _range("period_ratio", period_ratio, "-"),
            "wave_from": _range("wave_from", wave_from, "deg", 360.0),
        }
        low, high = np.array(list(ranges.values())).T
        sobol = _sobol(seed, cases, len(ranges) + (0 if shear is None else 2))
        share = sobol[:, : len(ranges)]
        if corner_every is not None:
            _put_on_corners(share, corner_every, seed)
        drawn = low + (high - low) * share
        longest = np.maximum(longest_tp / (5.0 * np.sqrt(np.maximum(drawn[:, 2], 1e-9))), low[3])
        drawn[:, 3] = low[3] + (np.minimum(high[3], longest) - low[3]) * share[:, 3]
        if shear is not None:
            drawn = np.hstack([drawn, _normal(sobol[:, len(ranges) :], shear)])
        seas = tuple(_sea(*row) for row in drawn.tolist())
        return cls(name=name, seas=seas, duration=duration, seed=seed)

    @classmethod
    def named(
        cls,
        name: str,
        seed: int,
        cases: int,
        *,
        duration: float = 1800.0,
        ranges: Mapping[str, Range] | None = None,
    ) -> Self:
        """Draw from ranges that have a name.

        ``paper``: the paper's, where Tp = 5 sqrt(Hs). ``default``: the same with
        Tp / (5 sqrt(Hs)) from 0.8 to 2.2, as real seas have it. ``current``: no waves.
        ``profile``: the same, in currents that change with depth as an ADCP measured it. ``loads``:
        waves of 0.05 m and more, with Tp from the steepness limit to three times 5 sqrt(Hs), 18 s
        at most, and one case in 16 on a corner of the ranges.

        ``ranges``: to take in place of the plan's own, by the names of ``Plan.sample``; the plan is
        then called by them, too.
        """
        if name not in _PLANS:
            raise InputError(f"Plan.named: no plan {name!r}; there are: {', '.join(_PLANS)}.")
        called = f"{name}, other {' and '.join(ranges)}" if ranges else name
        own = {**_PLANS[name], **(ranges or {}), "name": called}
        return cls.sample(seed, cases, duration=duration, **own)

    @classmethod
    def grid(
        cls,
        *,
        current_speed: Iterable[float],
        current_to: Iterable[float],
        hs: Iterable[float] = (0.0,),
        period_ratio: Iterable[float] = (1.0,),
        wave_from: Iterable[float] = (0.0,),
        duration: float = 1800.0,
        seed: int = 0,
        name: str = "grid",
    ) -> Self:
        """Every combination, the last named varying fastest; Tp = 5 ``period_ratio`` sqrt(Hs)."""
        rows = itertools.product(current_speed, current_to, hs, period_ratio, wave_from)
        return cls(name=name, seas=tuple(_sea(*row) for row in rows), duration=duration, seed=seed)

    @classmethod
    def listed(
        cls,
        seas: Iterable[SeaState],
        *,
        duration: float = 1800.0,
        seed: int = 0,
        name: str = "listed",
    ) -> Self:
        """The sea states given."""
        return cls(name=name, seas=tuple(seas), duration=duration, seed=seed)

    @classmethod
    def table(
        cls, path: str | Path, *, duration: float = 1800.0, seed: int = 0, name: str | None = None
    ) -> Self:
        """The sea states of a CSV file, one a row.

        Its columns are current_speed_m_s and current_to_deg, and if it likes hs_m, tp_s and
        wave_from_deg, current_shear_m_s and shear_to_deg. An empty tp_s counts as 5 sqrt(Hs),
        another empty cell as 0.
        """
        path, seas = Path(path), read_sea_states(Path(path))
        return cls(name=name or path.stem, seas=seas, duration=duration, seed=seed)

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """A plan from the JSON file that ``write`` makes."""
        return cls.from_json(read_text(path, most=TABLE_BYTES))

    def write(self, path: str | Path) -> None:
        """Write a JSON file that ``read`` takes back, one case per line."""
        Path(path).write_text(self.to_json(), "utf-8")

    @classmethod
    def from_json(cls, text: str) -> Self:
        """A plan from JSON text."""
        try:
            table = parse_json(text, "Plan")
            seas = tuple(_sea_of(case, number) for number, case in enumerate(table["cases"]))
            return cls(
                name=table["name"], seas=seas, duration=table["duration_s"], seed=table["seed"]
            )
        except (KeyError, TypeError) as error:
            raise InputError(
                f"Plan: this is no plan ({error!r}). Expected the keys name, duration_s, seed and "
                f"cases, each case with some of {', '.join(SEA_COLUMNS)}."
            ) from error

    def to_json(self) -> str:
        """JSON text with the unit in every key, one case per line."""
        head = {"name": self.name, "duration_s": self.duration, "seed": self.seed}
        doors = sea_columns(self.seas)
        cases = ",\n".join(
            json.dumps({door: getattr(sea, name) for door, name in doors.items()})
            for sea in self.seas
        )
        return f'{json.dumps(head)[:-1]}, "cases": [\n{cases}\n]}}\n'

    @property
    def sha256(self) -> str:
        """Hash of the whole plan."""
        return hashlib.sha256(self.to_json().encode()).hexdigest()


def _sea_of(case: Mapping[str, Any], number: int) -> SeaState:
    given = {SEA_COLUMNS[key]: value for key, value in case.items()}
    try:
        return SeaState(**given)
    except InputError as error:
        raise InputError(f"Plan: case {number}: {error}") from error


def _check_seed(seed: int) -> None:
    if seed < 0:
        raise InputError(f"Plan: seed = {seed} is negative. Give a whole number from 0 on.")


def _range(name: str, given: Sequence[float], unit: str, top: float = math.inf) -> Range:
    low, high = given
    if not (0.0 <= low <= high <= top and math.isfinite(high)):
        limit = "" if math.isinf(top) else f", {top:g} at most"
        raise InputError(
            f"Plan.sample: {name} = ({low:g}, {high:g}) {unit} is no range. "
            f"Give the least and the largest, from 0 up{limit}."
        )
    return low, high


def _sea(
    speed: float,
    to: float,
    hs: float,
    ratio: float,
    wave_from: float,
    along: float = 0.0,  # of the shear, as the next
    right: float = 0.0,
) -> SeaState:
    return SeaState(
        current_speed=speed,
        current_to=to,
        hs=hs,
        tp=5.0 * ratio * math.sqrt(hs),
        wave_from=wave_from,
        current_shear=math.hypot(along, right),
        shear_to=(to + math.degrees(math.atan2(right, along))) % 360.0,
    )


def _normal(share: np.ndarray, moments: tuple[Range, Range]) -> np.ndarray:
    """Normal numbers from even ones, column by column."""
    from scipy.special import ndtr, ndtri

    tail = float(ndtr(-_MOST_DEVIATIONS))
    mean, deviation = np.array(moments).T
    return mean + deviation * ndtri(tail + (1.0 - 2.0 * tail) * share)


def _put_on_corners(share: np.ndarray, every: int, seed: int) -> None:
    """Move one case in so many to a corner of speed, Hs and period, in a draw of directions."""
    moved = np.arange(every - 1, len(share), every)
    if len(moved):
        share[moved] = _sobol(seed + 1, len(moved), share.shape[1])
        corner = np.arange(len(moved))[:, None] >> np.arange(3)
        share[moved[:, None], (0, 2, 3)] = corner & 1


def _sobol(seed: int, cases: int, dimensions: int) -> np.ndarray:
    from scipy.stats import qmc

    engine = qmc.Sobol(dimensions, rng=np.random.default_rng(seed))
    # Whole powers of two keep the balance of the sequence; its start is a sample as well.
    return engine.random_base2((cases - 1).bit_length())[:cases]
