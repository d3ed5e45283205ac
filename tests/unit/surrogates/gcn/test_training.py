"""The training of a network: its pace, its end, and what it is told to care for."""

import numpy as np
import pytest

from seacage.surrogates._gcn._graph import Graph
from seacage.surrogates._gcn._layers import (
    Recipe,
    first_parameters,
    paper_network,
    parameter_shapes,
)
from seacage.surrogates._gcn._training import TrainingSet, batches_of, learning_rates, train_network

RANDOM = np.random.default_rng(0)
REST = RANDOM.standard_normal((5, 3))
GRAPH = Graph.of(np.array([[0, 1], [1, 2], [3, 4]]), REST)
X = RANDOM.standard_normal((40, 2))
TARGET = np.tanh(X @ RANDOM.standard_normal((2, 15))).reshape(40, 5, 3)
RECIPE = Recipe(width=6, epochs=40, patience=40, learning_rate=1e-2)
SHAPES = parameter_shapes("paper", features=2, nodes=5, width=6, modes=0)
FIRST = first_parameters(SHAPES, modes=np.zeros((0, 15)), seed=0)


def train(target=TARGET, *, weight=None, recipe=RECIPE, progress=None):
    training_set = TrainingSet(
        rest=REST,
        propagation=GRAPH.propagation(),
        weight=np.ones(5) if weight is None else weight,
        x=X,
        target=target,
        train=np.arange(32),
        held_out=np.arange(32, 40),
    )
    return train_network("paper", FIRST, training_set, recipe=recipe, seed=0, progress=progress)


def missed(parameters) -> np.ndarray:
    """Root mean square error of each node."""
    answer = paper_network(np, parameters, REST, X, GRAPH.propagate)
    return np.sqrt(np.mean((answer - TARGET) ** 2, axis=(0, 2)))


@pytest.mark.slow
def test_training_brings_the_network_nearer_to_its_cases() -> None:
    parameters, epochs = train()
    assert epochs == 40
    assert missed(parameters).mean() < 0.85 * missed(FIRST).mean()


@pytest.mark.slow
def test_a_node_that_weighs_nothing_is_not_learned() -> None:
    weight = np.array([2.0, 2.0, 1.0, 0.0, 0.0])
    alike, unlike = missed(train()[0]), missed(train(weight=weight)[0])
    assert unlike[3:].mean() > 1.1 * alike[3:].mean()


def test_training_ends_when_the_held_out_cases_no_longer_gain() -> None:
    # What is held out is the opposite of what is taught, so the first epoch is the best.
    turned = np.concatenate([TARGET[:32], -3.0 * TARGET[:8]])
    messages: list[tuple[str, int, int]] = []
    recipe = Recipe(width=6, epochs=400, patience=5, learning_rate=1e-2)
    _, epochs = train(turned, recipe=recipe, progress=lambda *step: messages.append(step))
    assert epochs < 40
    assert messages[0] == ("gcn", 1, 400)
    assert messages[-2:] == [("gcn", epochs, 400), ("gcn", 400, 400)]


def test_every_epoch_is_reported_and_the_last_one_once() -> None:
    messages: list[tuple[str, int, int]] = []
    train(progress=lambda *step: messages.append(step))
    assert messages == [("gcn", epoch, 40) for epoch in range(1, 41)]


def test_the_learning_rate_rises_a_twentieth_of_the_way_and_falls_to_nothing() -> None:
    rate = learning_rates(RECIPE, 5)
    assert rate.shape == (40, 5)
    assert rate.max() == pytest.approx(1e-2, rel=1e-3)
    assert np.argmax(rate) == 9  # the tenth of 200 steps
    assert rate[-1, -1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("cases", "expected"), [(810, (12, 64)), (45, (11, 4)), (3, (3, 1)), (640, (10, 64))]
)
def test_few_cases_make_small_batches(cases: int, expected: tuple[int, int]) -> None:
    assert batches_of(cases) == expected
