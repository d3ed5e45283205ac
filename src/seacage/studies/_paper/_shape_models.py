"""Models of the whole shape to compare: the paper's, and ours."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any, Literal

from seacage.cage import Cage
from seacage.surrogates import PcaGP, ShapeGP, Symmetry

# As a twin's, and "degrees" for the paper's own: the current's speed and its compass direction
Input = Literal["current", "waves", "degrees"]

Need = Literal["over_time", "rest_position", "progress"]
CURRENT: tuple[Input, ...] = ("current",)
ALL: tuple[Input, ...] = ("current", "waves")
DEGREES: tuple[Input, ...] = ("degrees",)

# How people call the inputs
WORDS: Mapping[tuple[Input, ...], str] = {
    CURRENT: "current",
    ALL: "current and waves",
    DEGREES: "current in degrees",
}

# Settings that the cage makes, which the simulations name already
_OF_CAGE = ("cage", "edges", "rest_position", "node_weight", "symmetry")

PCA_PAPER, PCA_DEGREES = "PCA-GP, 3 modes", "PCA-GP, 3 modes, degrees"
PCA_LITERAL, PCA_WAVES = "PCA-GP, 3 modes, not centred", "PCA-GP, 3 modes, waves"
GCN_PAPER, GCN_DEGREES = "GCN, the paper's", "GCN, the paper's, degrees"
GCN_OURS = "GCN, ours"
SHAPE_CURRENT, SHAPE, SHAPE_FOLDED = "ShapeGP, current", "ShapeGP", "ShapeGP, folded"
# Of the folded process: a frame with four corners, and what compression may move a node by [m]
_FOLD, _TOLERANCE = 4, 0.02


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeModel:
    """A model to compare."""

    name: str  # in tables and figures
    inputs: tuple[Input, ...]
    # All that its answers depend on beside the simulations, as JSON takes it
    settings: Mapping[str, object]
    fit: Callable[..., Any]  # takes features, shapes [m], a seed and what ``needs`` names
    # What its fit takes besides: the shapes over time, the shape at rest, or a callback for
    # progress
    needs: tuple[Need, ...] = ()


def shape_models(
    cage: Cage,  # whose net it is
    *,
    waves: bool,  # whether there are waves
    networks: bool,  # whether to train graph networks, which takes minutes and needs JAX
) -> tuple[tuple[ShapeModel, ...], tuple[str, ...]]:
    """The paper's models and ours, and a sentence on each that cannot be had here."""
    inputs = ALL if waves else CURRENT
    pca, process = PcaGP(modes=3), ShapeGP(tolerance=_TOLERANCE)
    turns = Symmetry.of(cage.design_position, fold=_FOLD, mirror=0.0)
    literal = PcaGP(modes=3, centred=False)
    models = [
        _model(PCA_PAPER, CURRENT, pca, "over_time"),
        _model(PCA_DEGREES, DEGREES, pca, "over_time"),
        _model(PCA_LITERAL, CURRENT, literal, "over_time", "rest_position"),
    ]
    if waves:
        models += [
            _model(PCA_WAVES, ALL, pca, "over_time"),
            _model(SHAPE_CURRENT, CURRENT, process),
        ]
    models += [
        _model(SHAPE, inputs, process),
        _model(SHAPE_FOLDED, inputs, ShapeGP(tolerance=_TOLERANCE, symmetry=turns)),
    ]
    if not networks:
        return tuple(models), ("The graph networks take minutes and are left to the full study.",)
    if find_spec("jax") is None:
        why = (
            "The graph networks are missing: JAX is not installed here. "
            "Install seacage with the extra gcn and run the same again."
        )
        return tuple(models), (why,)
    return (*models, *_networks(cage, inputs)), ()


def _networks(cage: Cage, inputs: tuple[Input, ...]) -> list[ShapeModel]:
    from seacage.surrogates import GCN

    paper, ours = GCN(cage=cage, kind="paper"), GCN(cage=cage, kind="modal")
    return [
        _model(GCN_PAPER, CURRENT, paper, "progress"),
        _model(GCN_DEGREES, DEGREES, paper, "progress"),
        _model(GCN_OURS, inputs, ours, "progress"),
    ]


def _model(name: str, inputs: tuple[Input, ...], estimator: Any, *needs: Need) -> ShapeModel:
    return ShapeModel(
        name=name,
        inputs=inputs,
        settings={"estimator": type(estimator).__name__, "how": _settings_of(estimator)},
        fit=estimator.fit,
        needs=needs,
    )


def _settings_of(estimator: Any) -> dict[str, str]:
    """Settings of an unfitted model; those of the cage are named beside it."""
    names = [name for name in estimator.__dataclass_fields__ if name not in _OF_CAGE]
    return {name: repr(getattr(estimator, name)) for name in names}
