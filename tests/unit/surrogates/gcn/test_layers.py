"""The two networks hold what their papers and docstrings say."""

import jax.numpy as jnp
import numpy as np
import pytest

from seacage.cage import Cage
from seacage.surrogates._gcn._graph import Graph
from seacage.surrogates._gcn._layers import (
    NETWORKS,
    Kind,
    first_parameters,
    modal_network,
    paper_network,
    parameter_shapes,
)

CAGE = Cage.named("ace").altered(mesh={"spokes": 6})
GRAPH = Graph.of(CAGE.edges, CAGE.design_position)
REST = CAGE.design_position / 20.0
X = np.random.default_rng(0).standard_normal((4, 5))
MODES = np.random.default_rng(1).standard_normal((7, 3 * GRAPH.nodes))


def filled(kind: Kind) -> dict[str, np.ndarray]:
    """Parameters with nothing left at 0."""
    shapes = parameter_shapes(kind, features=5, nodes=GRAPH.nodes, width=8, modes=7)
    first = first_parameters(shapes, modes=MODES, seed=0)
    random = np.random.default_rng(2)
    return {
        name: values + 0.1 * random.standard_normal(values.shape) for name, values in first.items()
    }


def test_the_papers_network_is_three_times_its_equation() -> None:
    p = filled("paper")
    nodes = np.concatenate([np.tile(REST, (4, 1, 1)), np.repeat(X[:, None], 61, axis=1)], axis=2)
    layers = [
        (np.vstack([p["place"], p["sea"]]), p["bias_1"]),
        (p["weight_2"], p["bias_2"]),
        (p["weight_3"], p["bias_3"]),
    ]
    for weight, bias in layers:
        nodes = GRAPH.propagation() @ nodes @ weight + bias
        last = nodes
        nodes = nodes / (1.0 + np.exp(-nodes))
    found = paper_network(np, p, REST, X, GRAPH.propagate)
    np.testing.assert_allclose(found, last, atol=1e-12)  # order of the sums


def test_a_node_of_the_papers_network_hears_three_hops_and_no_more() -> None:
    p = filled("paper")
    moved = REST.copy()
    moved[CAGE.bottom_node] += 1.0
    before, after = (paper_network(np, p, rest, X, GRAPH.propagate) for rest in (REST, moved))
    changed = np.abs(after - before).max(axis=(0, 2)) > 1e-12
    rings = np.unique(np.flatnonzero(changed) // CAGE.spokes)
    np.testing.assert_array_equal(rings, [7, 8, 9, 10])


def test_the_modal_network_starts_as_its_principal_components() -> None:
    shapes = parameter_shapes("modal", features=5, nodes=GRAPH.nodes, width=8, modes=7)
    shape = modal_network(
        np, first_parameters(shapes, modes=MODES, seed=0), REST, X, GRAPH.propagate
    ).reshape(4, -1)
    _, missed, _, _ = np.linalg.lstsq(MODES.T, shape.T)
    assert missed.max() < 1e-20 * np.sum(shape**2)


def test_the_graph_adds_to_the_modes_once_it_has_learned() -> None:
    p = filled("modal")
    deaf = p | {"move": np.zeros_like(p["move"])}
    with_graph, without = (modal_network(np, one, REST, X, GRAPH.propagate) for one in (p, deaf))
    assert np.abs(with_graph - without).max() > 0.1 * np.abs(without).max()


@pytest.mark.parametrize("kind", ["paper", "modal"])
def test_numpy_and_jax_answer_alike(kind: Kind) -> None:
    p = filled(kind)
    exact = NETWORKS[kind](np, p, REST, X, GRAPH.propagate)
    single = {name: jnp.asarray(values, jnp.float32) for name, values in p.items()}
    matrix = jnp.asarray(GRAPH.propagation(), jnp.float32)
    other = NETWORKS[kind](
        jnp,
        single,
        jnp.asarray(REST, jnp.float32),
        jnp.asarray(X, jnp.float32),
        lambda report: jnp.einsum("ij,rjc->ric", matrix, report),
    )
    # Single precision has seven digits, and the sums lose one or two.
    np.testing.assert_allclose(other, exact, atol=1e-5 * np.abs(exact).max())


@pytest.mark.parametrize("kind", ["paper", "modal"])
def test_large_inputs_overflow_nowhere(kind: Kind) -> None:
    far = NETWORKS[kind](np, filled(kind), REST, 1e4 * X, GRAPH.propagate)
    assert np.isfinite(far).all()
