"""Models of the whole shape, trained and asked on the same simulations, each a stage."""

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import InputError, Progress
from seacage.ocean import SeaState
from seacage.records import CampaignRecord
from seacage.studies._paper import _shape_models as shape_models
from seacage.studies._paper._shape_scores import ShapeScore, shape_score
from seacage.studies._stages import Stages
from seacage.surrogates import OverTime, Prediction, metocean_features
from seacage.twin import Metocean

_ROOMS = ("conventions", "surrogates")  # whose code makes a model's answers, its features included
# Quantiles of the test cases' current speeds that the two nets drawn are taken at
_DRAWN = {"Harsh": 0.95, "Mild": 0.2}

_TIMED = 20  # shapes asked for one by one to say what one takes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeTrial:
    """Training and test cases of models of the shape."""

    cage: Cage  # that was simulated
    # Training and test cases, all of which ended with an answer
    campaign: CampaignRecord
    held_out: CampaignRecord
    seed: int  # of the trainings

    @property
    def over_time(self) -> OverTime | None:
        """Shapes at all time steps, test cases included, as in the paper; None without them."""
        moment, parts = self.campaign.second_moment, (self.campaign, self.held_out)
        if moment is None:
            return None
        every = np.concatenate([one.node_position for one in parts])
        return OverTime.of_moment(every, moment, rest_position=self.cage.design_position)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeCase:
    """One of the nets that are drawn."""

    called: str  # "Harsh" or "Mild"
    row: int  # of the test cases, from 0
    sea: SeaState
    computed: Float[np.ndarray, "node 3"]  # [m]
    predicted: Mapping[str, Float[np.ndarray, "node 3"]]  # by name of the model [m]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeStudy:
    """What became of the models."""

    # Number of simulations to train on, and to test on
    training_cases: int
    test_cases: int
    current_speed: Float[np.ndarray, " case"]  # of the test cases [m/s]
    scores: Mapping[str, ShapeScore]  # by model, in the order of the tables
    cases: tuple[ShapeCase, ...]  # the nets to draw
    # Share of the variance in the first three modes, by how it is counted [-]
    variance: Mapping[str, float]
    left_out: tuple[str, ...]  # why some models are missing, a sentence each

    @property
    def best(self) -> ShapeScore:
        """The process with a shared kernel with all inputs, folded where it can be."""
        return self.scores.get(shape_models.SHAPE_FOLDED, self.scores[shape_models.SHAPE])


def shape_study(
    models: Sequence[shape_models.ShapeModel],  # to compare
    trial: ShapeTrial,  # their simulations
    stages: Stages,  # where answers are kept
    *,
    left_out: tuple[str, ...] = (),  # passed on
    # Called as ("shape", done, total) in models when one is trained, and by the networks as they
    # like
    progress: Progress,
) -> ShapeStudy:
    """Train each model on one campaign and score it on another; what is trained is kept."""
    answers: dict[str, Prediction] = {}
    scores: dict[str, ShapeScore] = {}
    for number, model in enumerate(models):

        def make(begun: Path, model: shape_models.ShapeModel = model, number: int = number) -> None:
            progress("shape", number, len(models))
            _make(begun, model, trial, progress)
            progress("shape", number + 1, len(models))

        try:
            folder = stages.ensure("shape", _settings(model, trial), make, rooms=_ROOMS)
        except InputError as error:
            if model.name != shape_models.SHAPE_FOLDED:
                raise
            left_out = (*left_out, f"{model.name} is missing: {error}")  # not every cage can be
            continue
        answers[model.name], cost = _read_answers(folder)
        scores[model.name] = shape_score(
            model.name,
            answers[model.name],
            trial.held_out.node_position,
            collar=trial.cage.ring_nodes(0),
            inputs=shape_models.WORDS[model.inputs],
            **cost,
        )
    return ShapeStudy(
        training_cases=len(trial.campaign),
        test_cases=len(trial.held_out),
        current_speed=np.array([sea.current_speed for sea in trial.held_out.seas]),
        scores=scores,
        cases=_draw_cases(trial, answers),
        variance=_variance(trial),
        left_out=left_out,
    )


def _settings(model: shape_models.ShapeModel, trial: ShapeTrial) -> dict[str, object]:
    return {
        "model": model.name,
        "inputs": list(model.inputs),
        "needs": list(model.needs),
        **model.settings,
        "taught_by": trial.campaign.sha256,
        "asked": trial.held_out.sha256,
        "seed": trial.seed,
    }


def _make(
    begun: Path, model: shape_models.ShapeModel, trial: ShapeTrial, progress: Progress
) -> None:
    """Train a model, ask it, and keep its shapes and what they took."""
    x, test_features = (
        _features(one.seas, model.inputs) for one in (trial.campaign, trial.held_out)
    )
    shape = trial.campaign.node_position
    known = {
        "over_time": trial.over_time,
        "rest_position": trial.cage.design_position,
        "progress": progress,
    }
    began = time.process_time()
    fitted = model.fit(x, shape, seed=trial.seed, **{name: known[name] for name in model.needs})
    took = time.process_time() - began
    answer = fitted.predict(test_features, noisy=True)  # a half-hour's mean has noise of its own
    cost = {
        "modes": getattr(fitted, "modes", None),
        "fit_cpu_s": took,
        "predict_ms": _one_shape_ms(fitted, test_features),
    }
    np.savez(
        begun / "shapes.npz", mean=answer.mean.astype(np.float32), std=answer.std.astype(np.float32)
    )
    (begun / "cost.json").write_text(json.dumps(cost), encoding="utf-8")


def _read_answers(folder: Path) -> tuple[Prediction, dict[str, Any]]:
    with np.load(folder / "shapes.npz", allow_pickle=False) as kept:
        answer = Prediction(mean=kept["mean"].astype(float), std=kept["std"].astype(float))
    return answer, json.loads((folder / "cost.json").read_text("utf-8"))


def _one_shape_ms(fitted: Any, test_features: Float[np.ndarray, "case feature"]) -> float:
    took: list[float] = []
    for row in range(min(_TIMED, len(test_features))):
        began = time.process_time()
        fitted.predict(test_features[row : row + 1])
        took.append(time.process_time() - began)
    return 1000.0 * float(np.median(took))


def _features(
    seas: Sequence[SeaState], inputs: tuple[shape_models.Input, ...]
) -> Float[np.ndarray, "case feature"]:
    if inputs == shape_models.DEGREES:
        return np.array([[sea.current_speed, sea.current_to] for sea in seas])
    water = Metocean.of(seas)
    if inputs == shape_models.CURRENT:
        return metocean_features(water.current_velocity)
    waves = {"hs": water.hs, "wave_direction": water.wave_direction, "tp": water.tp}
    return metocean_features(water.current_velocity, **waves)


def _draw_cases(trial: ShapeTrial, answers: Mapping[str, Prediction]) -> tuple[ShapeCase, ...]:
    seas, computed = trial.held_out.seas, trial.held_out.node_position
    speed = np.array([sea.current_speed for sea in seas])
    order = np.argsort(speed, kind="stable")
    rows = {one: int(order[round(share * (len(order) - 1))]) for one, share in _DRAWN.items()}
    return tuple(
        ShapeCase(
            called=called,
            row=row,
            sea=seas[row],
            computed=computed[row],
            predicted={name: answer.mean[row] for name, answer in answers.items()},
        )
        for called, row in rows.items()
    )


def _variance(trial: ShapeTrial) -> dict[str, float]:
    """What three modes hold, of the cases' means and, where it was kept, of all time steps."""
    rest = trial.cage.design_position.ravel()
    shapes = {
        "means of the cases": OverTime.of_snapshots(trial.campaign.node_position),
        "all time steps": trial.over_time,
    }
    shares: dict[str, float] = {}
    for name, known in shapes.items():
        if known is not None:
            moved = known.mean - rest
            shares[f"{name}, centred"] = _three(known.scatter)
            shares[f"{name}, not centred"] = _three(known.scatter + np.outer(moved, moved))
    return shares


def _three(moment: Float[np.ndarray, "coordinate coordinate"]) -> float:
    size = np.linalg.eigvalsh(moment)[::-1]
    return min(float(np.sum(size[:3]) / np.sum(size)), 1.0)  # no more than all, by rounding
