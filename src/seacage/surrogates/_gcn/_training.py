"""The training of a network; the one file that needs JAX."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import optax
from jaxtyping import Float, Int

from seacage.conventions import Progress
from seacage.surrogates._gcn._layers import NETWORKS, Kind, Parameters, Recipe

LARGEST_BATCH, FEWEST_BATCHES = 64, 10  # cases per step of the optimiser, and steps per epoch
# Share of the averaged weights that a step keeps: an average over about the last fifty steps
REMEMBERED = 0.98
ADAM = optax.chain(optax.clip_by_global_norm(1.0), optax.scale_by_adam())


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TrainingSet:
    """Inputs and targets of a training, standardised."""

    rest: Float[np.ndarray, "node 3"]  # rest position of the nodes
    propagation: Float[np.ndarray, "node node"]  # the normalised adjacency
    weight: Float[np.ndarray, " node"]  # of each node's error in the loss, 1 on average
    # The cases
    x: Float[np.ndarray, "case feature"]
    target: Float[np.ndarray, "case node 3"]
    # Which cases train, and which decide when to stop
    train: Int[np.ndarray, " train"]
    held_out: Int[np.ndarray, " held"]


def train_network(
    kind: Kind,
    first: Mapping[str, np.ndarray],
    training_set: TrainingSet,
    *,
    recipe: Recipe,
    seed: int,
    progress: Progress | None,
) -> tuple[Parameters, int]:
    """The averaged parameters that answered the held-out cases best, and the epochs it took.

    Adam on batches, in single precision, with a learning rate that rises and falls. A running
    average of the parameters is evaluated and kept. ``progress`` is called as ("gcn",
    epoch, epochs); training that ends early reports all epochs as done.
    """
    to_single = partial(jnp.asarray, dtype=jnp.float32)
    single = {name: to_single(values) for name, values in first.items()}
    net = tuple(map(to_single, (training_set.rest, training_set.propagation, training_set.weight)))
    x, target = to_single(training_set.x), to_single(training_set.target)
    unseen = x[training_set.held_out], target[training_set.held_out]
    random = np.random.default_rng(seed)
    state = (single, ADAM.init(single), single)
    best, least, best_epoch = single, np.inf, 0
    batches, batch = batches_of(len(training_set.train))
    rate = learning_rates(recipe, batches)
    epoch = 0
    for epoch in range(1, recipe.epochs + 1):
        order = random.permutation(training_set.train)[: batches * batch].reshape(batches, batch)
        state, unseen_loss = _epoch(kind, state, net, (x, target), unseen, order, rate[epoch - 1])
        loss = float(unseen_loss)
        if loss < least:
            best, least, best_epoch = state[2], loss, epoch
        if progress is not None:
            progress("gcn", epoch, recipe.epochs)
        if epoch - best_epoch >= recipe.patience:
            break
    if progress is not None and epoch < recipe.epochs:
        progress("gcn", recipe.epochs, recipe.epochs)
    return {name: np.asarray(values, np.float64) for name, values in best.items()}, epoch


def batches_of(cases: int) -> tuple[int, int]:
    """How many batches an epoch has, and of how many cases: few cases make small batches."""
    batch = min(LARGEST_BATCH, max(1, cases // FEWEST_BATCHES))
    return cases // batch, batch


def learning_rates(recipe: Recipe, batches: int) -> Float[np.ndarray, "epoch batch"]:
    """Of every step: up in a line over the first twentieth, down as half a cosine."""
    share = (np.arange(recipe.epochs * batches) + 1.0) / (recipe.epochs * batches)
    up, down = share / 0.05, 0.5 + 0.5 * np.cos(np.pi * (share - 0.05) / 0.95)
    return (recipe.learning_rate * np.minimum(up, down)).reshape(recipe.epochs, batches)


def _loss(parameters: Any, kind: Kind, net: Any, x: jax.Array, target: jax.Array) -> jax.Array:
    """Mean square error, each node by its weight."""
    rest, propagation, weight = net

    def propagate(signal: jax.Array) -> jax.Array:
        return jnp.einsum("ij,bjf->bif", propagation, signal)

    answer = NETWORKS[kind](jnp, parameters, rest, x, propagate)
    return jnp.mean(weight[:, None] * (answer - target) ** 2)


@partial(jax.jit, static_argnames="kind")
def _epoch(
    kind: Kind, state: Any, net: Any, cases: Any, unseen: Any, order: Any, rate: Any
) -> tuple[Any, jax.Array]:
    """One pass through the cases, a step of Adam per batch; and the loss on unseen ones."""
    x, target = cases

    def step(state: Any, batch: Any) -> tuple[Any, None]:
        parameters, memory, average = state
        chosen, pace = batch
        slope = jax.grad(_loss)(parameters, kind, net, x[chosen], target[chosen])
        direction, memory = ADAM.update(slope, memory)
        parameters = jax.tree.map(lambda p, d: p - pace * d, parameters, direction)
        average = jax.tree.map(
            lambda a, p: REMEMBERED * a + (1.0 - REMEMBERED) * p, average, parameters
        )
        return (parameters, memory, average), None

    state, _ = jax.lax.scan(step, state, (order, rate))
    return state, _loss(state[2], kind, net, *unseen)
