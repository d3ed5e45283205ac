"""The two networks, written once for NumPy, which predicts, and JAX, which trains.

And the default choices of each one's training.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.surrogates._gcn._graph import Propagate

Kind = Literal["paper", "modal"]
Numbers = Any  # an array of NumPy, or of JAX while it trains
Parameters = dict[str, np.ndarray]  # what training changes, by name
Shape = tuple[int, ...]
TOKEN = 128  # channels of the modal network's sea state


def parameter_shapes(
    kind: Kind, *, features: int, nodes: int, width: int, modes: int
) -> dict[str, Shape]:
    """Shape of every parameter of a network, weights as (from, to) and biases as (to,)."""
    if kind == "paper":
        return {
            "place": (3, width),
            "sea": (features, width),
            "bias_1": (width,),
            "weight_2": (width, width),
            "bias_2": (width,),
            "weight_3": (width, 3),
            "bias_3": (3,),
        }
    return {
        "token_1": (features, TOKEN),
        "token_bias_1": (TOKEN,),
        "token_2": (TOKEN, TOKEN),
        "token_bias_2": (TOKEN,),
        "token_3": (TOKEN, TOKEN),
        "token_bias_3": (TOKEN,),
        "score": (TOKEN, modes),
        "score_bias": (modes,),
        "mode": (modes, 3 * nodes),
        "place": (3, width),
        "node_bias": (nodes, width),
        "weight_1": (width, width),
        "bias_1": (width,),
        "weight_2": (width, width),
        "bias_2": (width,),
        "move": (width, 3 * modes),
    }


def paper_network(
    xp: Any,  # NumPy or JAX's copy of it
    parameters: Mapping[str, Numbers],  # by the names of ``parameter_shapes``
    rest: Numbers,  # standardised rest position (node, 3)
    x: Numbers,  # standardised features (row, feature)
    propagate: Propagate,  # applies the normalised adjacency to (row, node, channel)
) -> Numbers:  # standardised (row, node, 3)
    """Three graph convolutions of (rest position, sea state), Swish between them.

    All nodes have the same sea state, so the first layer propagates its share once for all
    cases; the numbers are those of the full node table.
    """
    p = parameters
    received = propagate(xp.ones((1, len(rest), 1), rest.dtype))
    signal = propagate((rest @ p["place"])[None]) + received * (x @ p["sea"])[:, None]
    signal = _swish(xp, signal + p["bias_1"])
    signal = _swish(xp, propagate(signal @ p["weight_2"]) + p["bias_2"])
    return propagate(signal @ p["weight_3"]) + p["bias_3"]


def modal_network(
    xp: Any, parameters: Mapping[str, Numbers], rest: Numbers, x: Numbers, propagate: Propagate
) -> Numbers:
    """Modes of the whole net, made on its graph and driven by the sea state.

    Two residual graph convolutions read the rest position and a learned mark of each node and
    give its motion in each mode, beside the principal components. They do not
    depend on the sea state, so they cost nothing per case. The sea state becomes one token,
    which gives the amplitude of each mode. Parameters and result as for
    ``paper_network``, the result a displacement.
    """
    p = parameters
    signal = rest @ p["place"] + p["node_bias"]
    for layer in ("1", "2"):
        received = propagate((signal @ p[f"weight_{layer}"])[None])[0]
        signal = signal + _swish(xp, received + p[f"bias_{layer}"])
    beyond = (signal @ p["move"]).reshape(p["mode"].shape[::-1]).T
    token = _swish(xp, x @ p["token_1"] + p["token_bias_1"])
    token = token + _swish(xp, token @ p["token_2"] + p["token_bias_2"])
    token = token + _swish(xp, token @ p["token_3"] + p["token_bias_3"])
    score = token @ p["score"] + p["score_bias"]
    return (score @ (p["mode"] + beyond)).reshape(len(x), len(rest), 3)


NETWORKS: dict[Kind, Any] = {"paper": paper_network, "modal": modal_network}


def first_parameters(
    shapes: Mapping[str, Shape], *, modes: Float[np.ndarray, "mode coordinate"], seed: int
) -> Parameters:
    """Where training starts: weights drawn so that channels keep their size, biases at 0.

    The modes start as principal components, and what the graph adds to them at 0.
    """
    random = np.random.default_rng(seed)
    first = {
        name: random.standard_normal(shape) / np.sqrt(shape[0]) * ("bias" not in name)
        for name, shape in shapes.items()
    }
    if "mode" in first:
        first["node_bias"] = 0.5 * random.standard_normal(shapes["node_bias"])
        first["score"] *= 0.1
        first |= {"mode": modes, "move": np.zeros(shapes["move"])}
    return first


def _swish(xp: Any, z: Numbers) -> Numbers:
    # z / (1 + exp(-z)) without an overflow far below 0.
    return z * (0.5 + 0.5 * xp.tanh(0.5 * z))


@dataclass(frozen=True, slots=True, kw_only=True)
class Recipe:
    """The choices of a training."""

    width: int  # channels per node
    epochs: int  # most passes through the cases
    patience: int  # epochs without a better answer to the held-out cases, after which training ends
    # Of Adam, at its largest; it rises over the first twentieth and falls as a cosine to 0
    learning_rate: float


RECIPES: Mapping[str, Recipe] = {
    "paper": Recipe(width=64, epochs=150, patience=30, learning_rate=5e-3),
    "modal": Recipe(width=16, epochs=800, patience=200, learning_rate=3e-3),
}


def recipe_of(kind: str, **wanted: float | None) -> Recipe:
    """The recipe of a kind, changed where a value is given.

    Raises InputError: there is no such network, or a value is not above 0.
    """
    if kind not in RECIPES:
        raise InputError(f"GCN: no network {kind!r}; there are: {', '.join(RECIPES)}.")
    chosen = {name: value for name, value in wanted.items() if value is not None}
    for name, value in chosen.items():
        if not value > 0:
            raise InputError(
                f"GCN: {name} = {value:g} is not above 0. "
                f"Leave it out for {getattr(RECIPES[kind], name):g}."
            )
    return replace(RECIPES[kind], **chosen)
