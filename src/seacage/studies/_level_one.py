"""How well level 1 says what a simulation computes."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.records import CampaignRecord
from seacage.surrogates import PcaGP, current_features
from seacage.twin import Twin


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeScore:
    """One model of the whole shape against held-out simulations.

    Parameters
    ----------
    model
        Its name.
    axis_mae
        Mean absolute error along x, y and z [m].
    p99, worst
        Of the distance between the predicted and the computed node [m].
    case_mae
        Mean absolute error of each case, over nodes and axes [m].
    """

    model: str
    axis_mae: tuple[float, float, float]
    p99: float
    worst: float
    case_mae: Float[np.ndarray, " case"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LevelOneScore:
    """Level 1 against simulations that it has not seen.

    Parameters
    ----------
    cases
        How many.
    current_speed
        Of each [m/s].
    bridle_names, bridle_mae, bridle_mean
        Mean absolute error and mean tension of each bridle [N].
    shapes
        The twin's model and the paper's three modes.
    """

    cases: int
    current_speed: Float[np.ndarray, " case"]
    bridle_names: tuple[str, ...]
    bridle_mae: Float[np.ndarray, " line"]
    bridle_mean: Float[np.ndarray, " line"]
    shapes: tuple[ShapeScore, ...]


def score_level_one(
    twin: Twin, campaign: CampaignRecord, held_out: CampaignRecord, *, seed: int
) -> LevelOneScore:
    """Score tensions and shapes of level 1 on simulations that it has not seen.

    Beside the twin's own shape model stands the paper's: three PCA modes, each with a GP,
    fitted to the same campaign.
    """
    seas = [sea for sea, good in zip(held_out.seas, held_out.converged, strict=True) if good]
    tension = held_out.bridle_tension[held_out.converged]
    position = held_out.node_position[held_out.converged]
    answer = twin.predict(seas)
    three_modes = PcaGP(modes=3).fit(
        _features(campaign)[campaign.converged],
        campaign.node_position[campaign.converged],
        seed=seed,
    )
    paper = three_modes.predict(_features(held_out)[held_out.converged]).mean
    return LevelOneScore(
        cases=len(seas),
        current_speed=np.array([sea.current_speed for sea in seas]),
        bridle_names=twin.bridle_names,
        bridle_mae=np.mean(np.abs(answer.bridle_low - tension), axis=0),
        bridle_mean=np.mean(tension, axis=0),
        shapes=(
            shape_score("ShapeGP (the twin's)", answer.node_position, position),
            shape_score("PCA, 3 modes + GP", paper, position),
        ),
    )


def _features(campaign: CampaignRecord) -> Float[np.ndarray, "case 3"]:
    return current_features(np.array([sea.current_velocity for sea in campaign.seas]))


def shape_score(
    model: str,
    predicted: Float[np.ndarray, "case node 3"],
    computed: Float[np.ndarray, "case node 3"],
) -> ShapeScore:
    error = np.abs(predicted - computed)
    distance = np.linalg.norm(predicted - computed, axis=-1)
    x, y, z = error.mean(axis=(0, 1))
    return ShapeScore(
        model=model,
        axis_mae=(float(x), float(y), float(z)),
        p99=float(np.quantile(distance, 0.99)),
        worst=float(distance.max()),
        case_mae=error.mean(axis=(1, 2)),
    )
