"""Evidence for each hypothesis: the CUSUM of its log-likelihood ratio against no fault."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.twin._faults._baseline import Baseline, Shift, as_tuples
from seacage.twin._faults._hypotheses import Hypothesis
from seacage.twin._faults._residuals import ResidualBlock
from seacage.twin._faults._student_t import kalman_update, log_density
from seacage.twin._json_keys import json_keys
from seacage.twin._settings import FaultDetectorSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class Evidence:
    """Evidence for a hypothesis since the time at which the fault most likely began."""

    # Sum of the log-likelihood ratios against no fault since it was last zero; above zero
    cusum: float
    # Of the sensors that respond [-]
    size: tuple[float, ...]
    covariance: tuple[tuple[float, ...], ...]

    __pydantic_config__ = json_keys(cusum="evidence")


# By the hypothesis' name; those with a sum of zero are left out
EvidenceByName = Mapping[str, Evidence]


def update_evidence(
    evidence: EvidenceByName,
    block: ResidualBlock,
    baseline: Baseline,
    among: Sequence[Hypothesis],
    active: Collection[str],
    settings: FaultDetectorSettings,
) -> dict[str, Evidence]:
    """Add a block's log-likelihood ratio of each hypothesis.

    This is Page's CUSUM test for each: the sum starts where it is least, so that the time before
    a fault does not count against it. All hypotheses are compared with the same: the baseline and
    the shifts of the active alarms.

    ``evidence`` and ``baseline``: so far.
    ``block`` and ``among``: the residuals, and the hypotheses.
    ``active``: alarms that are raised; a hypothesis of one of them is compared with the others.
    ``settings``: of the fault detector.

    Source: Page (1954), Continuous inspection schemes; Lorden (1971), Procedures for reacting to a
    change in distribution, for sizes that are not known.
    """
    received = block.received
    normal = baseline.shift(block, settings)
    shifts = shifts_of_active(evidence, among, active, settings)
    usual = normal.plus(shifts.values())
    beside = {
        alarm: normal.plus(one for other, one in shifts.items() if other != alarm)
        for alarm in shifts
    }
    against = [beside.get(one.alarm, usual) for one in among]
    prior = [_prior(evidence.get(one.name), one) for one in among]
    scale = np.array([one.scale for one in among])
    added = scale[:, :, None] * np.array([covariance for _, covariance in prior])
    added = added * scale[:, None, :]
    without = block.residual - np.array([one.mean for one in against])
    residual = without - scale * np.array([size for size, _ in prior])
    noise = np.array([one.covariance for one in against])
    both = np.ix_(np.arange(len(among)), received, received)
    tails = settings.degrees_of_freedom
    ratio = log_density(residual[:, received], (noise + added)[both], tails)
    ratio -= log_density(without[:, received], noise[both], tails)
    after = dict[str, Evidence]()
    for row, one in enumerate(among):
        before = evidence[one.name].cusum if one.name in evidence else 0.0
        kept = (1.0 - 1.0 / settings.evidence_memory) * before
        cusum = kept + settings.block_weight * float(ratio[row])
        if cusum > 0.0:
            size, covariance = kalman_update(
                *prior[row],
                response=np.diag(one.scale)[received],
                residual=residual[row][received],
                noise=noise[row][np.ix_(received, received)],
                degrees_of_freedom=tails,
            )
            responds = one.sd > 0.0
            after[one.name] = Evidence(
                cusum=cusum,
                size=tuple(size[responds].tolist()),
                covariance=as_tuples(covariance[np.ix_(responds, responds)]),
            )
    return after


def shifts_of_active(
    evidence: EvidenceByName,
    among: Iterable[Hypothesis],
    active: Collection[str],
    settings: FaultDetectorSettings,
) -> dict[str, Shift]:
    """Return the shift by each active alarm, of its hypothesis with the widest prior.

    Its mean is as estimated and its covariance is the prior's, widened: a sensor that reads
    irregularly has no weight, nor have those beside a parted bridle.
    """
    found = dict[str, Shift]()
    for one in among:
        if one.alarm in active and one.alarm not in found:
            size, _ = _prior(evidence.get(one.name), one)
            covariance = np.diag((settings.active_widening * one.scale * one.sd) ** 2)
            found[one.alarm] = Shift(mean=one.scale * size, covariance=covariance)
    return found


def _prior(
    evidence: Evidence | None, one: Hypothesis
) -> tuple[Float[np.ndarray, " sensor"], Float[np.ndarray, "sensor sensor"]]:
    """Return the sizes of a hypothesis and their covariance, before a block."""
    size, covariance, responds = one.size.copy(), np.diag(one.sd**2), one.sd > 0.0
    if evidence is not None and one.lasts:
        size[responds] = evidence.size
        covariance[np.ix_(responds, responds)] = evidence.covariance
    return size, covariance + np.diag(responds * one.walk**2)
