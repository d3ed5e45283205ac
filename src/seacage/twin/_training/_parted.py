"""Training of what a parted line leaves to the others, from pairs of simulations."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics import rest_shape
from seacage.records import CampaignRecord
from seacage.surrogates import LoadChange, Symmetry
from seacage.twin._lines._line_loads import load_features, sea_domain
from seacage.twin._metocean import Metocean
from seacage.twin._parted import PartedKind, PartedLines
from seacage.twin._training._loads import LEAST_CASES, in_waves, line_symmetry, load_cases


def train_parted_lines(
    cage: Cage,
    whole: CampaignRecord,
    parted: Sequence[CampaignRecord],
    *,
    still_volume: float,
    restarts: int,
    seed: int,
) -> PartedLines:
    """Train level 1 of a damaged cage.

    Every case is compared with that of the whole cage in the same sea and the same waves, so that
    what waves do by chance is not learned.

    ``cage``: as it was simulated. ``whole``: campaign of it. ``parted``: campaigns without one line
    each. ``still_volume``: inside the whole cage's net in still water [m3]. ``restarts``, ``seed``:
    of the searches.

    Raises InputError: a campaign in which not one line has parted, or that has too few cases in
    common with that of the whole cage, or two of lines that are alike.
    """
    symmetry = line_symmetry(cage, whole.line_names)
    kinds = list[PartedKind]()
    for one in parted:
        line = _column(whole, one)
        stay = symmetry
        if symmetry is not None:  # the images in which the line stays in its place
            some = symmetry.source[:, line] == line
            stay = replace(symmetry, turn=symmetry.turn[some], source=symmetry.source[some])
        before, after = _pairs(whole, one)
        loads = load_cases(one, after)
        reference = load_cases(whole, before)
        for name in ("mean", "expected", "largest"):  # the line itself teaches nothing
            getattr(loads, name)[:, line] = getattr(reference, name)[:, line]
        water = Metocean.of(one.seas).rows(after)
        kinds.append(
            PartedKind(
                line=whole.line_names[line],
                surrogate=LoadChange.fit(
                    load_features(water),
                    reference,
                    loads,
                    _state(cage, one, still_volume)[after],
                    symmetry=stay,
                    restarts=restarts,
                    seed=seed,
                ),
                domain=sea_domain(water),
                learned=len(after),
                simulated=len(one),
                campaign_sha256=one.sha256,
            )
        )
    _check_unlike(kinds, whole.line_names, symmetry)
    return PartedLines(kinds=tuple(kinds), symmetry=symmetry)


def _column(whole: CampaignRecord, parted: CampaignRecord) -> int:
    """Number of the line that has parted."""
    if len(parted.parted) != 1:
        raise InputError(
            f"train: {', '.join(parted.parted) or 'no line'} has parted in a campaign given as "
            "parted, and a twin learns one line at a time. Run it with --parted-lines."
        )
    alike = ("cage_toml", "law", "duration", "line_names")
    other = [name for name in alike if getattr(whole, name) != getattr(parted, name)]
    if other or parted.parted[0] not in whole.line_names:
        raise InputError(
            f"train: the campaign without {parted.parted[0]} differs from the whole cage's in "
            f"{' and '.join(other) or 'its lines'}. Run both with the same settings."
        )
    return whole.line_names.index(parted.parted[0])


def _pairs(
    whole: CampaignRecord, parted: CampaignRecord
) -> tuple[Int[np.ndarray, " pair"], Int[np.ndarray, " pair"]]:
    """Cases of both campaigns in the same sea and waves, each with an answer."""

    def cases(of: CampaignRecord) -> dict[object, int]:
        seeds = np.zeros(len(of), dtype=int) if of.wave_seed is None else of.wave_seed
        rows = np.flatnonzero(in_waves(of)).tolist()
        return {(of.seas[row], int(seeds[row])): row for row in rows}

    before, after = cases(whole), cases(parted)
    common = [one for one in after if one in before]
    if len(common) < LEAST_CASES:
        raise InputError(
            f"train: {len(common)} cases of the campaign without {parted.parted[0]} are in seas "
            f"and waves of the whole cage's and ended with an answer; at least {LEAST_CASES} are "
            "needed. Run both with the same plan and seed; one may have fewer cases."
        )
    return np.array([before[one] for one in common]), np.array([after[one] for one in common])


def _state(
    cage: Cage, campaign: CampaignRecord, still_volume: float
) -> Float[np.ndarray, "case 3"]:
    """``STATE`` of each case."""
    assert campaign.node_position_minimum is not None  # a campaign in time has it
    lowest = np.asarray(campaign.node_position_minimum[..., 2], dtype=np.float64).min(axis=1)
    collar = slice(0, cage.spokes)
    centre = campaign.node_position[:, collar, :2].mean(axis=1)
    drift = np.linalg.norm(centre - rest_shape(cage)[collar, :2].mean(axis=0), axis=1)
    clearance = cage.site.water_depth + lowest
    return np.column_stack([campaign.volume / still_volume, clearance, drift])


def _check_unlike(
    kinds: Sequence[PartedKind], names: Sequence[str], symmetry: Symmetry | None
) -> None:
    """Refuse two lines of which one stands for the other."""
    first = dict[int, str]()
    for kind in kinds:
        own = names.index(kind.line)
        place = own if symmetry is None else int(symmetry.source[:, own].min())
        if place in first:
            raise InputError(
                f"train: by the cage's symmetry {first[place]} and {kind.line} are alike. Give the "
                "campaign without one of them."
            )
        first[place] = kind.line
