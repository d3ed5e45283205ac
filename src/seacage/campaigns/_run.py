"""Running a campaign: blocks of cases, each kept as soon as it is done."""

import hashlib
import json
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path

import numpy as np
from jaxtyping import Int

from seacage.cage import Cage
from seacage.campaigns._plan import Plan
from seacage.campaigns._pool import available_cores, mapped
from seacage.conventions import InputError, Origin, Progress, Result
from seacage.dynamics import Law, settle
from seacage.ocean import SeaState
from seacage.records import (
    NOT_RUN,
    CampaignRecord,
    campaign_results,
    create_campaign,
    read_campaign,
    write_cases,
)

_BLOCK = 32
"""Cases settled and written at a time: enough to fill the kernel's lanes, few enough to lose."""

_IDENTITY = {
    "cage": "cage",
    "plan_sha256": "plan",
    "law": "load law",
    "method": "method",
    "product_version": "version of seacage",
}
"""Attributes that make two campaigns the same, and how people call them."""


def run_campaign(
    cage: Cage,
    plan: Plan,
    out: str | Path,
    *,
    workers: int | None = None,
    law: Law = "kristiansen-faltinsen",
    progress: Progress | None = None,
) -> CampaignRecord:
    """Settle a cage in every sea state of a plan, into a Zarr store that outlives a kill.

    A block of cases is written when it is done; called again with the same cage, plan and
    law it goes on where it stopped, and ends with the same numbers. A case that fails keeps
    its result code and does not stop the rest. Waves enter by their mean loads.

    Parameters
    ----------
    cage
        The cage.
    plan
        The sea states.
    out
        Folder of the store, made if it is not there.
    workers
        Processes; None for one per available core, 1 for none beside this one. The answers
        do not depend on it.
    law
        Load law of the netting.
    progress
        Called as ("campaign", done, total) in cases, first with what was there already.

    Raises
    ------
    InputError
        ``out`` holds another campaign.
    """
    store = Path(out)
    attributes = _attributes(cage, plan, law)
    result, block = _begun(store, attributes, cases=len(plan))
    toml = cage.to_toml()
    tasks = [
        _Block(first=first, cage_toml=toml, law=law, seas=plan.seas[first : first + block])
        for first in range(0, len(plan), block)
        if result[first] == NOT_RUN
    ]
    done = int(np.sum(result != NOT_RUN))
    report = progress or _unheard
    report("campaign", done, len(plan))
    with closing(mapped(_settled, tasks, workers=workers or available_cores())) as finished:
        for task, answers in finished:
            if not store.exists():  # a cage or a law that cannot be settled leaves no store
                _create(store, cage, plan, attributes)
            write_cases(store, task.first, answers)
            done += len(task.seas)
            report("campaign", done, len(plan))
    return read_campaign(store)


def campaign_key(cage: Cage, plan: Plan, law: Law) -> str:
    """A short name that only campaigns with the same numbers share."""
    attributes = _attributes(cage, plan, law)
    same = json.dumps([attributes[name] for name in _IDENTITY])
    return hashlib.sha256(same.encode()).hexdigest()[:16]


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignStatus:
    """How far a campaign is.

    Parameters
    ----------
    plan
        The plan's name.
    law
        Load law of the netting.
    total
        Cases planned.
    converged, not_converged, diverged
        Cases that ended so.
    """

    plan: str
    law: str
    total: int
    converged: int
    not_converged: int
    diverged: int

    @property
    def done(self) -> int:
        """Cases that have been run, however they ended."""
        return self.converged + self.not_converged + self.diverged


def campaign_status(out: str | Path) -> CampaignStatus:
    """How far the campaign in a folder is, whether it is running or was stopped.

    Raises
    ------
    RecordError
        There is no campaign.
    """
    attributes, result, _ = campaign_results(Path(out))
    return CampaignStatus(
        plan=attributes["plan"],
        law=attributes["law"],
        total=len(result),
        converged=int(np.sum(result == Result.CONVERGED)),
        not_converged=int(np.sum(result == Result.NOT_CONVERGED)),
        diverged=int(np.sum(result == Result.DIVERGED)),
    )


def _begun(
    store: Path, asked: Mapping[str, object], *, cases: int
) -> tuple[Int[np.ndarray, " case"], int]:
    """Results so far and the block size of a store, if it holds the campaign asked for."""
    if not store.exists():
        return np.full(cases, NOT_RUN), _BLOCK
    found, result, block = campaign_results(store)
    other = [name for key, name in _IDENTITY.items() if found.get(key) != asked[key]]
    if other:
        raise InputError(
            f"{store} holds a campaign with another {' and another '.join(other)}. "
            "Give another folder, or delete this one."
        )
    return result, block


def _create(store: Path, cage: Cage, plan: Plan, attributes: Mapping[str, str | float]) -> None:
    create_campaign(
        store,
        seas=plan.seas,
        nodes=cage.node_count,
        lines=cage.bridle_count,
        block=_BLOCK,
        attributes=attributes,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Block:
    """Neighbouring cases, as they travel to a worker."""

    first: int
    cage_toml: str
    law: Law
    seas: tuple[SeaState, ...]


def _settled(task: _Block) -> dict[str, np.ndarray]:
    response = settle(_cage(task.cage_toml), task.seas, law=task.law, mean_waves=True)
    return {
        "node_position": response.node_position,
        "bridle_tension": response.bridle_tension,
        "net_force": response.net_force,
        "volume": response.volume,
        "residual": response.residual,
        "result": response.result,
    }


@lru_cache(maxsize=4)
def _cage(toml: str) -> Cage:
    return Cage.from_toml(toml)


def _attributes(cage: Cage, plan: Plan, law: Law) -> dict[str, str | float]:
    """Of the store: what was asked, by what, in the words of ACDD-1.3 where it has some."""
    number = version("seacage")
    return {
        "title": f"Campaign {plan.name!r} of cage {cage.name!r}",
        "summary": f"Equilibria of a moored net cage in {len(plan)} sea states.",
        "keywords": "aquaculture, net cage, mooring, numerical simulation",
        "source": f"seacage {number}, settle, netting law {law}",
        "product_version": number,
        "origin": Origin.COMPUTED.value,
        "method": "settle",
        "cage": cage.to_toml(),
        "bridles": " ".join(cage.bridle_names),
        "law": law,
        "plan": plan.name,
        "plan_sha256": plan.sha256,
        "seed": plan.seed,
        "duration_s": plan.duration,
    }


def _unheard(stage: str, done: int, total: int) -> None:
    """Nobody asked for progress."""
