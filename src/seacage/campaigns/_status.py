"""Progress of a campaign, its failed cases and its cost."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Int

from seacage.conventions import Result, has_answer
from seacage.records import NOT_RUN, campaign_results, campaign_unsummed, campaign_variable


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignStatus:
    """Progress of a campaign."""

    plan: str  # the plan's name
    law: str  # load law of the netting
    method: str  # "simulate" or "settle"
    total: int  # cases planned
    # Cases that ended so
    converged: int
    not_converged: int
    diverged: int
    drowned: int
    outside_validity: int
    slack: int
    failures: dict[int, str]  # cases without an answer to learn from, each with the reason
    simulated_s: float  # simulated time of the cases done, spin-up included; 0 for equilibria [s]
    core_seconds: float  # processor time of the blocks done; NaN where it was not kept [s]
    finished: bool  # whether nothing is left to run or to sum

    @property
    def done(self) -> int:
        """Cases that have been run, however they ended."""
        return self.answers + self.not_converged + self.diverged + self.drowned

    @property
    def answers(self) -> int:
        """Cases with an answer to learn from."""
        return self.converged + self.outside_validity + self.slack

    @property
    def pace(self) -> float:
        """Simulated seconds per core-second; NaN where that means nothing."""
        return self.simulated_s / self.core_seconds if self.simulated_s else np.nan


def campaign_status(out: str | Path) -> CampaignStatus:
    """Progress of the campaign in a folder, whether it is running or was stopped.

    Raises RecordError: there is no campaign.
    """
    store = Path(out)
    attributes, result, block = campaign_results(store)
    diverged_at, taken = (campaign_variable(store, one) for one in ("diverged_at", "core_seconds"))
    simulated_s, core_seconds = 0.0, math.nan
    if diverged_at is not None:
        whole = float(attributes["spin_up_s"]) + float(attributes["duration_s"])
        each = np.where(np.isnan(diverged_at), whole, diverged_at)
        simulated_s = float(np.sum(each[result != NOT_RUN]))
    if taken is not None:  # a block being written has its seconds before its results
        core_seconds = float(np.sum(taken[result[::block] != NOT_RUN]))
    return CampaignStatus(
        plan=attributes["plan"],
        law=attributes["law"],
        method=attributes.get("method", "settle"),
        total=len(result),
        **{code.name.lower(): int(np.sum(result == code)) for code in Result},
        failures=_failures(store, result),
        simulated_s=simulated_s,
        core_seconds=core_seconds,
        finished=not (campaign_unsummed(store) or np.any(result == NOT_RUN)),
    )


def _failures(store: Path, result: Int[np.ndarray, " case"]) -> dict[int, str]:
    """Each case without an answer: in which sea, and why."""
    failed = np.flatnonzero((result != NOT_RUN) & ~has_answer(result)).tolist()
    if not failed:
        return {}
    names = ("current_speed", "current_to", "hs", "tp", "wave_from", "residual", "diverged_at")
    columns = {name: campaign_variable(store, name) for name in names}
    reasons: dict[int, str] = {}
    for case in failed:
        row = {n: np.nan if c is None else float(c[case]) for n, c in columns.items()}
        reasons[case] = f"{_sea(row)}: {_reason(Result(int(result[case])), row)}"
    return reasons


def _sea(row: Mapping[str, float]) -> str:
    current = f"current {row['current_speed']:.2f} m/s to {row['current_to']:.0f}°"
    if not row["hs"]:
        return current
    return f"{current}, Hs {row['hs']:.2f} m, Tp {row['tp']:.1f} s from {row['wave_from']:.0f}°"


def _reason(result: Result, row: Mapping[str, float]) -> str:
    if result is Result.NOT_CONVERGED:
        left = row["residual"]
        with_left = "" if np.isnan(left) else f" with {left:.3g} N left on a node"
        return f"it did not come to rest; its last shape is kept{with_left}"
    if result is Result.DROWNED:
        return "its collar or a corner buoy is under water"
    when = row["diverged_at"]
    after = "" if np.isnan(when) else f" after {when:.4g} s of simulated time"
    return f"its positions left the finite numbers{after}, so it carries no answer"
