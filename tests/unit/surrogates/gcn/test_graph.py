"""The graph of a net and its normalised adjacency."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.surrogates._gcn._graph import Graph

REST = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, -1.0], [2.0, 0.0, -2.0]])


def ace() -> Graph:
    cage = Cage.named("ace")
    return Graph.of(cage.edges, cage.design_position)


def test_three_nodes_in_a_row_hear_each_other_as_kipf_and_welling_say() -> None:
    side = 1.0 / np.sqrt(6.0)
    expected = [[1 / 2, side, 0.0], [side, 1 / 3, side], [0.0, side, 1 / 2]]
    found = Graph.of(np.array([[0, 1], [1, 2]]), REST).propagation()
    np.testing.assert_allclose(found, expected, atol=1e-15)  # roundings


def test_the_papers_net_has_321_nodes_and_a_tip_that_hears_the_tenth_layer() -> None:
    graph = ace()
    received = graph.propagation() > 0.0
    assert received.shape == (321, 321)
    assert (received == received.T).all()
    np.testing.assert_array_equal(np.flatnonzero(received[320]), np.arange(288, 321))
    # A node, the two beside it and those above and below; the top layer has none above.
    assert set(received[:32].sum(axis=1)) == {4}
    assert set(received[32:320].sum(axis=1)) == {5}


def test_the_sparse_propagation_is_the_dense_one() -> None:
    graph = ace()
    noise = np.random.default_rng(0).standard_normal((3, graph.nodes, 5))
    dense = np.einsum("ij,rjc->ric", graph.propagation(), noise)
    np.testing.assert_allclose(graph.propagate(noise), dense, atol=1e-13)  # order of the sums


def test_an_edge_given_twice_counts_once() -> None:
    once = Graph.of(np.array([[0, 1]]), REST)
    twice = Graph.of(np.array([[0, 1], [1, 0], [0, 1]]), REST)
    np.testing.assert_array_equal(twice.propagation(), once.propagation())


def test_a_lone_node_hears_itself() -> None:
    lone = Graph.of(np.zeros((0, 2), dtype=int), REST)
    np.testing.assert_array_equal(lone.propagation(), np.eye(3))


@pytest.mark.parametrize(
    ("edges", "rest", "sentence"),
    [
        ([[0, 3]], REST, "name nodes 0 to 3, but there are 3 positions"),
        ([[-1, 0]], REST, "name nodes -1 to 0"),
        ([[1, 1]], REST, "ties a node to itself"),
        ([[0.0, 1.0]], REST, "expected whole numbers"),
        ([0, 1], REST, r"expected whole numbers \(edges, 2\)"),
        ([[0, 1]], REST[:, :2], r"rest_position has shape \(3, 2\)"),
        ([[0, 1]], REST * np.nan, "finite, in m"),
    ],
)
def test_a_graph_that_cannot_be_is_refused(edges, rest, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        Graph.of(np.array(edges), rest)
