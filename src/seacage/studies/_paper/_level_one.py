"""Score of level 1 on the bridle tensions of held-out simulations."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.records import CampaignRecord
from seacage.twin import Twin


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LevelOneScore:
    """Level 1 against simulations that it has not seen."""

    cases: int
    # Mean absolute error and mean tension of each bridle [N]
    bridle_names: tuple[str, ...]
    bridle_mae: Float[np.ndarray, " line"]
    bridle_mean: Float[np.ndarray, " line"]


def score_level_one(twin: Twin, held_out: CampaignRecord) -> LevelOneScore:
    """Score the tensions of level 1 on simulations that it has not seen."""
    seas = [sea for sea, good in zip(held_out.seas, held_out.converged, strict=True) if good]
    tension = held_out.bridle_tension[held_out.converged]
    answer = twin.predict(seas)
    return LevelOneScore(
        cases=len(seas),
        bridle_names=twin.bridle_names,
        bridle_mae=np.mean(np.abs(answer.bridle_low - tension), axis=0),
        bridle_mean=np.mean(tension, axis=0),
    )
