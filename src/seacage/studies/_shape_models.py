"""Models of the whole shape to compare: the paper's, and ours."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any, Literal

from seacage.cage import Cage
from seacage.surrogates import PcaGP, ShapeGP

Input = Literal["current", "waves"]

ALL: tuple[Input, ...] = ("current", "waves")

WORDS: Mapping[tuple[Input, ...], str] = {("current",): "current", ALL: "current and waves"}
"""How people call the inputs."""

_OF_CAGE = ("cage", "edges", "rest_position", "node_weight")
"""Settings that the cage makes, which the simulations name already."""

PCA_PAPER, PCA_WAVES = "PCA-GP, 3 modes", "PCA-GP, 3 modes, waves heard"
PCA_LITERAL = "PCA-GP, 3 modes, not centred"
GCN_PAPER, GCN_CURRENT, GCN_OURS = "GCN, as printed", "GCN, ours, current", "GCN, ours"
SHAPE_CURRENT, SHAPE = "ShapeGP, current", "ShapeGP"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeModel:
    """A model to compare.

    Parameters
    ----------
    name
        In tables and figures.
    inputs
        What it is asked with.
    settings
        All that its answers depend on beside the simulations, as JSON takes it.
    fit
        Takes features, shapes [m], a seed and whom to tell of progress.
    displacements
        Whether it learns displacements from the design shape; coordinates otherwise.
    slow
        Whether its fit tells of progress.
    """

    name: str
    inputs: tuple[Input, ...]
    settings: Mapping[str, object]
    fit: Callable[..., Any]
    displacements: bool = False
    slow: bool = False


def shape_models(
    cage: Cage, *, waves: bool, networks: bool
) -> tuple[tuple[ShapeModel, ...], tuple[str, ...]]:
    """The paper's models and ours, and a sentence on each that cannot be had here.

    Parameters
    ----------
    cage
        Whose net it is.
    waves
        Whether there are waves to hear.
    networks
        Whether to train graph networks, which takes minutes and needs JAX.
    """
    current: tuple[Input, ...] = ("current",)
    heard = ALL if waves else current
    models = [
        _model(PCA_PAPER, current, PcaGP(modes=3)),
        _model(PCA_LITERAL, current, PcaGP(modes=3, centred=False), displacements=True),
    ]
    if waves:
        models += [
            _model(PCA_WAVES, ALL, PcaGP(modes=3)),
            _model(SHAPE_CURRENT, current, ShapeGP()),
        ]
    models.append(_model(SHAPE, heard, ShapeGP()))
    if not networks:
        return tuple(models), ("The graph networks take minutes and are left to the full study.",)
    if find_spec("jax") is None:
        return tuple(models), (
            (
                "The graph networks are missing: JAX is not installed here. "
                "Install seacage with the extra gcn and say the same again."
            ),
        )
    from seacage.surrogates import GCN

    models += [
        _model(GCN_PAPER, current, GCN(cage=cage, kind="paper")),
        _model(GCN_OURS, heard, GCN(cage=cage, kind="better")),
    ]
    if waves:
        models.append(_model(GCN_CURRENT, current, GCN(cage=cage, kind="better")))
    return tuple(models), ()


def _model(
    name: str, inputs: tuple[Input, ...], estimator: Any, *, displacements: bool = False
) -> ShapeModel:
    return ShapeModel(
        name=name,
        inputs=inputs,
        settings={"estimator": type(estimator).__name__, "how": _told(estimator)},
        fit=estimator.fit,
        displacements=displacements,
        slow=name in (GCN_PAPER, GCN_CURRENT, GCN_OURS),
    )


def _told(estimator: Any) -> dict[str, str]:
    """Settings of an unfitted model; those of the cage are named beside it."""
    names = [name for name in estimator.__dataclass_fields__ if name not in _OF_CAGE]
    return {name: repr(getattr(estimator, name)) for name in names}
