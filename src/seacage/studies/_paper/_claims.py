"""Statements of the paper, and whether this study's own numbers support them."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from seacage.studies._paper._shape_models import GCN_DEGREES, GCN_PAPER, PCA_DEGREES, PCA_PAPER
from seacage.studies._paper._shape_scores import ShapeScore
from seacage.studies._paper._shape_study import ShapeStudy
from seacage.studies._paper._trainings import IN_A_ROW, ScoredWays
from seacage.studies._sensor_scores import SensorScore
from seacage.studies._text import join_names, number, percent

ROV_M = 1.0  # the distance that the paper would have an ROV keep from the net [m]
PAPER_VARIANCE = 0.93  # what the paper's three modes hold at least
Verdict = Literal["reproduced", "partly", "not reproduced", "not evaluated"]


@dataclass(frozen=True, slots=True, kw_only=True)
class PaperClaim:
    """A statement of the paper, held against the study's numbers."""

    claim: str
    verdict: Verdict  # what the numbers say of it
    finding: str


def paper_claims(scored: ScoredWays, shapes: ShapeStudy) -> tuple[PaperClaim, ...]:
    """Each statement of the paper's results that this study can hold numbers against."""
    sensors = scored.sensors
    loads = [one for one in sensors if one.unit == "kN"]
    depths = [one for one in sensors if one.unit == "m"]
    return (
        *(
            _gain(some, what)
            for some, what in ((loads, "mooring loads"), (depths, "depths"))
            if some
        ),
        _slopes(sensors),
        _underestimation(depths),
        _oscillation(loads),
        _few_minutes(scored),
        _three_modes(shapes),
        _within_a_metre(shapes),
        _harder_when_faster(shapes),
        _network_wins(shapes),
        _network_steadier(shapes),
    )


def _verdict(held: Iterable[bool]) -> Verdict:
    """Reproduced where all parts of a statement hold, partly where some do."""
    parts = list(held)
    return "reproduced" if all(parts) else "partly" if any(parts) else "not reproduced"


def _gain(sensors: Sequence[SensorScore], what: str) -> PaperClaim:
    better = [one.sensor for one in sensors if one.means.better]
    pairs = [
        f"{one.sensor} {number(one.means.low_mae)} → {number(one.means.multi_mae)} {one.unit}"
        for one in sensors
    ]
    proven = f"Proven at {join_names(better)}." if better else "Proven at no sensor."
    return PaperClaim(
        claim=f"Multifidelity predicts the {what} much better than low fidelity.",
        verdict=_verdict(one.means.better for one in sensors),
        finding=f"Mean absolute errors of 10-minute means: {', '.join(pairs)}. {proven}",
    )


def _slopes(sensors: Sequence[SensorScore]) -> PaperClaim:
    slopes = [
        f"{one.sensor} {number(one.low_line[0])} → {number(one.multi_line[0])}" for one in sensors
    ]
    return PaperClaim(
        claim="The best fit of prediction on reading comes closer to the diagonal.",
        verdict=_verdict(
            abs(one.multi_line[0] - 1.0) < abs(one.low_line[0] - 1.0) for one in sensors
        ),
        finding=f"Slopes: {', '.join(slopes)}.",
    )


def _underestimation(depths: Sequence[SensorScore]) -> PaperClaim:
    return PaperClaim(
        claim="The simulations underestimate the net's deformation.",
        # A depth that is too large is a displacement that is too small.
        verdict=_verdict(one.raw.low_bias > 0.0 for one in depths) if depths else "not evaluated",
        finding="; ".join(
            f"{one.sensor} is predicted {number(abs(one.raw.low_bias))} m too "
            f"{'deep' if one.raw.low_bias > 0.0 else 'high'} on average"
            for one in depths
        )
        + ".",
    )


def _oscillation(loads: Sequence[SensorScore]) -> PaperClaim:
    """What single readings scatter beyond their ten-minute means."""
    more = _verdict(one.raw.multi_mae > 1.1 * one.means.multi_mae for one in loads)
    pairs = [
        f"{one.sensor} {number(one.raw.multi_mae)} and {number(one.means.multi_mae)}"
        for one in loads
    ]
    return PaperClaim(
        claim="Readings oscillate about the multifidelity trend, which does not follow.",
        verdict=more if loads else "not evaluated",
        finding="Errors of single readings and of 10-minute means, counted as true where the "
        f"first is a tenth larger: {', '.join(pairs)} kN.",
    )


def _few_minutes(scored: ScoredWays) -> PaperClaim:
    claim = "A few minutes of a sensor's data suffice to train it."
    row = [way for way in scored.ways if way.name == IN_A_ROW]
    if not row:
        return PaperClaim(
            claim=claim,
            verdict="not evaluated",
            finding="Readings a minute apart hold no few minutes; the full study evaluates it.",
        )
    sensors = [one for one in row[0].sensors if one.sensor in row[0].trained]
    better = [one.sensor for one in sensors if one.means.better]
    worse = [one.sensor for one in sensors if one.means.worse]
    spread = {one.sensor: one for one in scored.sensors}
    beaten = [
        one.sensor
        for one in row[0].sensors
        if one.means.multi_mae > spread[one.sensor].means.multi_mae
    ]
    covered = [one.minutes.coverage for one in sensors]
    held = (
        f"Intervals cover {percent(min(covered))} to {percent(max(covered))}. " if covered else ""
    )
    return PaperClaim(
        claim=claim,
        verdict=_verdict(one.sensor in better for one in row[0].sensors),
        finding="Read as minutes in a row, which the paper does not say: better than low fidelity "
        f"at {join_names(better or ['no sensor'])}, worse at {join_names(worse or ['none'])}. "
        f"{held}Readings spread over the teaching days do better at "
        f"{join_names(beaten or ['no sensor'])}.",
    )


def _three_modes(shapes: ShapeStudy) -> PaperClaim:
    centred = {name: share for name, share in shapes.variance.items() if "not" not in name}
    paper = shapes.scores[PCA_PAPER]
    held = min(centred.values()) >= PAPER_VARIANCE
    return PaperClaim(
        claim="Three principal components hold 93 % of the variance, so three are enough.",
        verdict=_verdict((held, held and paper.worst < ROV_M)),
        finding="Held: "
        + "; ".join(
            f"{percent(share, digits=1)} ({name})" for name, share in shapes.variance.items()
        )
        + f". Enough is another matter: with three modes the worst node is {number(paper.worst)} m "
        f"off and one in a hundred more than {number(paper.p99)} m.",
    )


def _within_a_metre(shapes: ShapeStudy) -> PaperClaim:
    some = _papers(shapes)
    share = {one.model: float(np.mean(one.case_axis_mae < ROV_M)) for one in some}
    nodes = {one.model: float(np.mean(one.case_worst < ROV_M)) for one in some}
    return PaperClaim(
        claim="For most test cases the mean absolute error lies below 1 m, which is accurate "
        "enough for an ROV.",
        verdict="partly" if min(share.values()) > 0.5 else "not reproduced",
        finding="Below 1 m: "
        + "; ".join(f"{name} {percent(one)} of cases and axes" for name, one in share.items())
        + ". A mean over 321 nodes keeps no ROV off a net; the worst node of a case is within 1 m "
        + "in "
        + "; ".join(f"{percent(one)} ({name})" for name, one in nodes.items())
        + f" of cases, and for {shapes.best.model} in "
        f"{percent(float(np.mean(shapes.best.case_worst < ROV_M)))}.",
    )


def _harder_when_faster(shapes: ShapeStudy) -> PaperClaim:
    rank = {
        one.model: _rank_correlation(shapes.current_speed, one.case_axis_mae.mean(axis=1))
        for one in _papers(shapes)
    }
    return PaperClaim(
        claim="Errors are larger where the current is faster.",
        verdict=_verdict(value > 0.3 for value in rank.values()),
        finding="Rank correlation of a case's error with its speed, counted as true above 0.3: "
        + "; ".join(f"{name} {number(value)}" for name, value in rank.items())
        + ".",
    )


def _rank_correlation(one: Float[np.ndarray, " case"], other: Float[np.ndarray, " case"]) -> float:
    """Spearman's; ties in measured numbers are not expected."""
    first, second = (np.argsort(np.argsort(values)) for values in (one, other))
    return float(np.corrcoef(first, second)[0, 1])


def _network_wins(shapes: ShapeStudy) -> PaperClaim:
    claim = "The graph network predicts the shape better than PCA with Gaussian processes."
    pairs = [
        (shapes.scores[network], shapes.scores[modes])
        for network, modes in ((GCN_PAPER, PCA_PAPER), (GCN_DEGREES, PCA_DEGREES))
        if network in shapes.scores
    ]
    if not pairs:
        return PaperClaim(claim=claim, verdict="not evaluated", finding=" ".join(shapes.left_out))
    pairs_text = [
        f"with {network.inputs} "
        + ", ".join(
            f"{axis} {number(ours)} against {number(theirs)} m"
            for axis, ours, theirs in zip("xyz", network.axis_mae, modes.axis_mae, strict=True)
        )
        for network, modes in pairs
    ]
    return PaperClaim(
        claim=claim,
        verdict=_verdict(network.mae < modes.mae for network, modes in pairs),
        finding=f"Mean absolute errors, network against PCA-GP: {'; '.join(pairs_text)}. The paper "
        "gives neither width, learning rate nor epochs, so another network may do better; this is "
        "no refutation.",
    )


def _network_steadier(shapes: ShapeStudy) -> PaperClaim:
    claim = "The errors of PCA-GP vary more from case to case along x and z than the network's."
    network = shapes.scores.get(GCN_PAPER)
    if network is None:
        return PaperClaim(claim=claim, verdict="not evaluated", finding=" ".join(shapes.left_out))
    theirs, ours = (
        dict(zip("xyz", one.case_axis_mae.std(axis=0).tolist(), strict=True))
        for one in (shapes.scores[PCA_PAPER], network)
    )
    return PaperClaim(
        claim=claim,
        verdict=_verdict(theirs[axis] > ours[axis] for axis in "xz"),
        finding="Standard deviation over cases, PCA-GP against the network: "
        + ", ".join(
            f"{axis} {number(theirs[axis])} against {number(ours[axis])} m" for axis in "xyz"
        )
        + ".",
    )


def _papers(shapes: ShapeStudy) -> list[ShapeScore]:
    return [shapes.scores[name] for name in (PCA_PAPER, GCN_PAPER) if name in shapes.scores]
