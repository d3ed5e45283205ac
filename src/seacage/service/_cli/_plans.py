"""Which sea states: the options of a shell turned into a plan."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from seacage.service._cli._console import refusal

if TYPE_CHECKING:
    from seacage.campaigns import Plan

# What can have a range or stand on a grid, as people write it; the ratio is Tp / (5 √Hs)
_AXES = {
    "current_speed_m_s": "current_speed",
    "current_to_deg": "current_to",
    "hs_m": "hs",
    "period_ratio": "period_ratio",
    "wave_from_deg": "wave_from",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanOptions:
    """Which sea states, as a shell gives them.

    Options:
        plan: paper: its ranges; default: also other periods than 5 √Hs; current: no waves; loads:
            periods up to 18 s, for loads in waves; profile: no waves, currents that change with
            depth; or the path of a plan that was written, ending in .json.
        grid: Instead of a plan every combination, e.g. hs_m=0,1,2 or, 11 values from 0 to 1,
            current_speed_m_s=0:1:11.
        listed: Instead of a plan a CSV file of sea states: current_speed_m_s, current_to_deg and,
            if there are waves, hs_m, tp_s, wave_from_deg; of a current that changes with depth
            current_shear_m_s and shear_to_deg.
        cases: Sea states to draw of a plan. [default: 1000]
        duration: Of each sea state, s. [default: 1800, or as written]
        seed: Of the draw and of the waves. [default: 0, or as written]
    """

    plan: str = "default"
    ranges: Annotated[
        list[str] | None,
        typer.Option(
            "--range",
            metavar="KEY=LEAST,MOST",
            help=f"In place of the plan's, e.g. hs_m=0,2. Keys: {', '.join(_AXES)}.",
        ),
    ] = None
    grid: Annotated[list[str] | None, typer.Option("--grid", metavar="KEY=VALUES")] = None
    listed: Annotated[Path | None, typer.Option("--list", exists=True, dir_okay=False)] = None
    cases: Annotated[int | None, typer.Option(min=1)] = None
    duration: float | None = None
    seed: Annotated[int | None, typer.Option(min=0)] = None

    def read(self) -> "Plan":
        """The one plan that the options describe; refused where they contradict each other."""
        from seacage.campaigns import Plan

        self._check_alone()
        duration = 1800.0 if self.duration is None else self.duration
        if self.plan.endswith(".json"):
            given = {"duration": self.duration, "seed": self.seed}
            changed = {name: value for name, value in given.items() if value is not None}
            return replace(Plan.read(self.plan), **changed)
        if self.listed is not None:
            return Plan.table(self.listed, duration=duration, seed=self.seed or 0)
        if self.grid:
            return _grid_plan(_pairs("--grid", self.grid), duration, self.seed or 0)
        ranges = {
            _AXES[key]: _least_and_most(key, values)
            for key, values in _pairs("--range", self.ranges or ()).items()
        }
        seed, cases = self.seed or 0, self.cases or 1000
        return Plan.named(self.plan, seed, cases, duration=duration, ranges=ranges)

    def _check_alone(self) -> None:
        written = self.plan.endswith(".json")
        whole = {"--plan with a file": written, "--grid": self.grid, "--list": self.listed}
        given = [name for name, value in whole.items() if value]
        some = {"--range": self.ranges, "--cases": self.cases}
        drawn = [name for name, value in some.items() if value]
        if len(given) > 1 or (given and drawn):
            raise refusal(
                f"{' and '.join([*given, *drawn])} exclude each other: {given[0]} names every sea "
                "state. Give one of them."
            )


def _pairs(option: str, given: Iterable[str]) -> dict[str, str]:
    """What stands before and after each equals sign."""
    pairs: dict[str, str] = {}
    for text in given:
        key, _, values = text.partition("=")
        if key not in _AXES or not values or key in pairs:
            raise refusal(
                f"{option} {text}: expected a key, = and numbers, each key once. Keys: "
                f"{', '.join(_AXES)}."
            )
        pairs[key] = values
    return pairs


def _least_and_most(key: str, values: str) -> tuple[float, float]:
    numbers = _numbers(f"--range {key}", values.split(","))
    if len(numbers) != 2:
        raise refusal(f"--range {key}={values}: expected two numbers, the least and the most.")
    return numbers[0], numbers[1]


def _grid_plan(pairs: dict[str, str], duration: float, seed: int) -> "Plan":
    from seacage.campaigns import Plan

    axes: dict[str, Any] = {_AXES[key]: _steps(key, values) for key, values in pairs.items()}
    if not {"current_speed", "current_to"} <= axes.keys():
        raise refusal("--grid: give at least current_speed_m_s and current_to_deg.")
    return Plan.grid(**axes, duration=duration, seed=seed)


def _steps(key: str, values: str) -> list[float]:
    """Numbers as they stand, or first:last:count."""
    if ":" not in values:
        return _numbers(f"--grid {key}", values.split(","))
    numbers = _numbers(f"--grid {key}", values.split(":"))
    if len(numbers) != 3 or numbers[2] < 2 or numbers[2] != int(numbers[2]):
        raise refusal(f"--grid {key}={values}: expected first:last:count, the count 2 or more.")
    first, last, count = numbers[0], numbers[1], int(numbers[2])
    return [first + (last - first) * step / (count - 1) for step in range(count)]


def _numbers(where: str, words: Iterable[str]) -> list[float]:
    try:
        return [float(word) for word in words]
    except ValueError as error:
        raise refusal(f"{where}: {error}.") from error
