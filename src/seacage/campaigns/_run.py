"""Running a campaign: blocks of cases, each kept as soon as it is done."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from contextlib import closing
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Int

from seacage import records
from seacage.cage import Cage, Structure, mooring_lines
from seacage.campaigns._cases import CaseBlock, Simulator, answer_block, software_version
from seacage.campaigns._cluster import map_on_cluster
from seacage.campaigns._pool import map_tasks
from seacage.campaigns._sea_state_plan import Plan
from seacage.conventions import InputError, Origin, Progress, no_progress
from seacage.dynamics import PHYSICS, SPRINGS, law_label
from seacage.records import CampaignRecord

# Attributes that make two campaigns the same, and how people call them
_IDENTITY = {
    "cage": "cage",
    "plan_sha256": "plan",
    "law": "load law",
    "skin_friction": "skin friction",
    "lift_factor": "lift factor",
    "method": "method",
    "product_version": "version of seacage",
    "physics": "revision of the physics",
    "mooring": "mooring",
    "mooring_drawn": "choice of one mooring for all cases or one for each",
    "parted": "choice of lines that have parted",
    "ramp_s": "ramp",
    "spin_up_s": "spin-up",
    "time_step_s": "time step",
    "quantile_levels": "choice of quantiles",
    "second_moment_kept": "choice about the second moment",
}


def run_campaign(
    cage: Cage | Structure,
    plan: Plan,
    out: str | Path,
    *,
    workers: int | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
    **settings: Any,
) -> CampaignRecord:
    """Simulate a cage in every sea state of a plan, into a Zarr store that outlives a kill.

    A block of cases is written when it is done; called again with the same cage, plan and
    settings it goes on where it stopped, and ends with the same numbers. A case that fails
    keeps its result code and does not stop the rest.

    Parameters
    ----------
    cage
        The cage; a ``Structure``'s lines take the bridles' place.
    plan
        The sea states, how long each lasts, and the seed of their waves.
    out
        Folder of the store, made if it is not there.
    workers
        Processes; None for one per available core, 1 for none beside this one. The answers
        do not depend on it.
    cluster
        Address of a Dask scheduler, ``tcp://host:8786``, whose workers take the place of the
        processes. On processors of one kind the answers do not depend on it.
    progress
        Called as ("campaign", done, total) in cases, first with what was there already.
    settings
        Those of ``Simulator``, such as ``method="settle"``.

    Raises InputError: ``out`` holds another campaign, moorings are to be drawn of what states no
    uncertainty, or a line has parted that the mooring has not.
    """
    by = Simulator(**settings)
    run_share(cage, plan, out, by=by, workers=workers, cluster=cluster, progress=progress)
    return records.read_campaign(out)


def run_share(
    cage: Cage | Structure,
    plan: Plan,
    out: str | Path,
    *,
    by: Simulator,
    share: tuple[int, int] = (0, 1),
    workers: int | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
) -> None:
    """Run every n-th block of a campaign, into a store that others may write to as well.

    Whoever runs the last block sums up.

    ``cage``, ``plan``, ``out``, ``workers``, ``cluster``, ``progress``: as for ``run_campaign``.
    ``by``: what answers the cases.
    ``share``: which share, from 0, and of how many.
    """
    import zarr  # noqa: F401  # where it is absent this is said before hours of work, not after

    if by.draw_mooring:
        cage.drawn(0)  # refused now, and not in a worker
    store = Path(out)
    attributes = _attributes(cage, plan, by)
    result, size = _results_so_far(store, attributes, cases=len(plan), block=by.block)
    firsts = _firsts(share, cases=len(plan), size=size)
    cases = [case for first in firsts for case in range(len(plan))[first : first + size]]
    blocks = _blocks(cage, plan, by, size, [at for at in firsts if result[at] == records.NOT_RUN])
    done = sum(int(result[case]) != records.NOT_RUN for case in cases)
    report = progress or no_progress
    report("campaign", done, len(cases))
    ends = map_tasks(answer_block, blocks, workers=workers)
    if cluster is not None and blocks:
        ends = map_on_cluster(answer_block, blocks, address=cluster)
    with closing(ends) as finished:
        for block, found in finished:
            if not store.exists():  # a cage or a law that cannot be run leaves no store
                _create(store, cage, plan, by, attributes)
                _results_so_far(store, attributes, cases=len(plan), block=by.block)
            spent, moment = found.core_seconds, found.moment
            records.write_cases(store, block.first, found.values, moment=moment, core_seconds=spent)
            done += len(block.seas)
            report("campaign", done, len(cases))
    if store.exists():
        records.finish_campaign(store)


def campaign_key(cage: Cage | Structure, plan: Plan, by: Simulator) -> str:
    """A short name that only campaigns with the same numbers share."""
    attributes = _attributes(cage, plan, by)
    same = json.dumps([attributes[name] for name in _IDENTITY if name in attributes])
    return hashlib.sha256(same.encode()).hexdigest()[:16]


def _firsts(share: tuple[int, int], *, cases: int, size: int) -> range:
    """First case of each block of a share."""
    which, shares = share
    if not 0 <= which < shares:
        raise InputError(
            f"Share {which} of {shares} does not exist. Shares count from 0: give 0/{shares} to "
            f"{max(shares, 1) - 1}/{shares}."
        )
    if not (firsts := range(size * which, cases, size * shares)):
        raise InputError(
            f"Share {which} of {shares} is empty: {cases} cases make {-(-cases // size)} blocks "
            f"of {size}. Make no more shares than that."
        )
    return firsts


def _results_so_far(
    store: Path, identity: Mapping[str, object], *, cases: int, block: int
) -> tuple[Int[np.ndarray, " case"], int]:
    """Results so far and the block size of a store, if it holds this campaign."""
    if not store.exists():
        return np.full(cases, records.NOT_RUN), block
    found, result, size = records.campaign_results(store)
    other = [name for key, name in _IDENTITY.items() if found.get(key) != identity.get(key)]
    if other:
        raise InputError(
            f"{store} holds a campaign with another {' and another '.join(other)}: it can be read, "
            "but not gone on with. Give another folder, or delete this one."
        )
    return result, size


def _blocks(
    cage: Cage | Structure, plan: Plan, by: Simulator, size: int, firsts: Sequence[int]
) -> list[CaseBlock]:
    toml = cage.to_toml()
    spans = [slice(first, first + size) for first in firsts]
    waves, moorings = _seeds(plan).T.tolist()
    return [
        CaseBlock(
            first=span.start,
            cage_toml=toml,
            seas=plan.seas[span],
            wave_seeds=tuple(waves[span]),
            mooring_seeds=tuple(moorings[span] if by.draw_mooring else ()),
            duration=plan.duration,
            simulator=by,
            made_by=software_version(by.law),
        )
        for span in spans
    ]


def _seeds(plan: Plan) -> Int[np.ndarray, "case 2"]:
    """Of each case's waves and mooring: they know the plan's seed and the case, no neighbours."""
    cases = range(len(plan))
    return np.array([np.random.SeedSequence([plan.seed, n]).generate_state(2) for n in cases], int)


def _create(
    store: Path, cage: Cage | Structure, plan: Plan, by: Simulator, attributes: Mapping[str, Any]
) -> None:
    waves, moorings = _seeds(plan).T.tolist()
    records.create_campaign(
        store,
        seas=plan.seas,
        nodes=cage.node_count,
        lines=cage.bridle_count,
        mooring=mooring_lines(cage, anchored=by.mooring == "catenary") if by.in_time else None,
        block=by.block,
        attributes=attributes,
        wave_seeds=waves if by.in_time else None,
        mooring_seeds=moorings if by.draw_mooring else None,
        quantile_levels=by.quantile_levels if by.in_time else (),
        second_moment=by.in_time and by.second_moment,
    )


def _attributes(cage: Cage | Structure, plan: Plan, by: Simulator) -> dict[str, Any]:
    """Attributes of the store: the campaign and its software, by names of ACDD-1.3 where known."""
    number = version("seacage")
    what = "Simulations in time" if by.in_time else "Equilibria"
    drawn = ", each on a mooring drawn for it" if by.draw_mooring else ""
    drawn += f", without {', '.join(by.parted)}" if by.parted else ""
    return {
        "title": f"Campaign {plan.name!r} of cage {cage.name!r}",
        "summary": f"{what} of a moored net cage in {len(plan)} sea states{drawn}.",
        "keywords": "aquaculture, net cage, mooring, numerical simulation",
        "source": f"seacage {number}, {by.method}, netting law {law_label(by.law)}",
        "product_version": number,
        "physics": PHYSICS,
        "origin": Origin.COMPUTED.value,
        "method": by.method,
        "cage": cage.to_toml(),
        "bridles": " ".join(cage.bridle_names),
        "law": law_label(by.law),
        "plan": plan.name,
        "plan_sha256": plan.sha256,
        "seed": plan.seed,
        "duration_s": plan.duration,
        **by.attributes,
        **({"comment": SPRINGS} if by.mooring == "springs" else {}),
    }
