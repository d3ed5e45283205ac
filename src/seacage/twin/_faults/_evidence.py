"""How much better than nothing each explanation accounts for what the sensors read."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.twin._faults._baseline import Expected, Usual
from seacage.twin._faults._hypotheses import Explanation
from seacage.twin._faults._residuals import Block
from seacage.twin._faults._student_t import learned, log_density

TRUST = 0.6
"""What a block's odds count, for the next begins with what this one ended with."""

MEMORY = 144
"""Blocks in which evidence is forgotten: three days. What is wrong goes on showing."""

BESIDE = 3.0
"""By how much less sure than it was first thought is what a raised alarm does to the sensors [-]:
nothing else is to be told of what it may explain."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Belief:
    """What is known of an explanation since the time it most likely began.

    Parameters
    ----------
    evidence
        Logarithm of its odds against none, since they were last even; above zero.
    size, covariance
        Of what it does to the sensors it concerns [-].
    """

    evidence: float
    size: tuple[float, ...]
    covariance: tuple[tuple[float, ...], ...]

    def less(self, evidence: float) -> Self:
        """Return the same with less evidence."""
        return replace(self, evidence=self.evidence - evidence)


Beliefs = Mapping[str, Belief]
"""By explanation; those not worth a belief are left out."""


def weighed(
    beliefs: Beliefs,
    block: Block,
    usual: Usual,
    among: Iterable[Explanation],
    told: Collection[str],
) -> dict[str, Belief]:
    """Add a block's evidence for each explanation.

    This is Page's test for each: the odds count from where they are best, so that a cause that
    begins late is not held against itself. All are weighed against the same: the sensors' habits
    and what is told already.

    Parameters
    ----------
    beliefs, usual
        What is known.
    block, among
        What was read, and what may explain it.
    told
        Alarms that are raised; an explanation of one of them is weighed beside the others.

    References
    ----------
    Page (1954), Continuous inspection schemes; Lorden (1971), Procedures for reacting to a
    change in distribution, for sizes that are not known.
    """
    among, heard = list(among), block.heard
    habits = usual.expected(block)
    believed = told_already(beliefs, among, told)
    usually = habits.and_also(believed.values())
    beside = {
        alarm: habits.and_also(one for other, one in believed.items() if other != alarm)
        for alarm in believed
    }
    against = [beside.get(one.alarm, usually) for one in among]
    known = [_known(beliefs.get(one.name), one) for one in among]
    scale = np.array([one.scale for one in among])
    felt = scale[:, :, None] * np.array([spread for _, spread in known]) * scale[:, None, :]
    without = block.error - np.array([one.shift for one in against])
    missed = without - scale * np.array([size for size, _ in known])
    noise = np.array([one.spread for one in against])
    both = np.ix_(np.arange(len(among)), heard, heard)
    odds = log_density(missed[:, heard], (noise + felt)[both])
    odds -= log_density(without[:, heard], noise[both])
    after = dict[str, Belief]()
    for row, one in enumerate(among):
        before = beliefs[one.name].evidence if one.name in beliefs else 0.0
        evidence = (1.0 - 1.0 / MEMORY) * before + TRUST * float(odds[row])
        if evidence > 0.0:
            size, covariance = learned(
                *known[row],
                felt=np.diag(one.scale)[heard],
                missed=missed[row][heard],
                noise=noise[row][np.ix_(heard, heard)],
            )
            after[one.name] = _believed(one, evidence, size, covariance)
    return after


def told_already(
    beliefs: Beliefs, among: Iterable[Explanation], told: Collection[str]
) -> dict[str, Expected]:
    """Say what the raised alarms account for, by alarm, by the widest explanation of each.

    How large it is, is believed; how sure that is, is not: a sensor that reads irregularly has
    no say, nor have those beside a parted bridle.
    """
    found = dict[str, Expected]()
    for one in among:
        if one.alarm in told and one.alarm not in found:
            size, _ = _known(beliefs.get(one.name), one)
            spread = np.diag((BESIDE * one.scale * one.spread) ** 2)
            found[one.alarm] = Expected(shift=one.scale * size, spread=spread)
    return found


def _known(
    belief: Belief | None, one: Explanation
) -> tuple[Float[np.ndarray, " sensor"], Float[np.ndarray, "sensor sensor"]]:
    """Return the sizes of an explanation and their covariance, before a block is seen."""
    size, covariance, concerned = one.size.copy(), np.diag(one.spread**2), one.spread > 0.0
    if belief is not None and one.lasts:
        size[concerned] = belief.size
        covariance[np.ix_(concerned, concerned)] = belief.covariance
    return size, covariance + np.diag(concerned * one.walk**2)


def _believed(
    one: Explanation,
    evidence: float,
    size: Float[np.ndarray, " sensor"],
    covariance: Float[np.ndarray, "sensor sensor"],
) -> Belief:
    """Keep what concerns the sensors that feel it."""
    concerned = one.spread > 0.0
    return Belief(
        evidence=evidence,
        size=tuple(size[concerned].tolist()),
        covariance=tuple(map(tuple, covariance[np.ix_(concerned, concerned)].tolist())),
    )
