"""The whole shape of the net from a graph convolutional network."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from types import ModuleType
from typing import ClassVar, Self

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage
from seacage.conventions import InputError, Progress
from seacage.surrogates._arrays import Arrays, Settings, setting
from seacage.surrogates._gcn._graph import Graph
from seacage.surrogates._gcn._layers import (
    Kind,
    Recipe,
    first_parameters,
    parameter_shapes,
    recipe_of,
)
from seacage.surrogates._gcn._network import Network, standard_rest
from seacage.surrogates._gcn._spread import Spread
from seacage.surrogates._prediction import Prediction, check_inputs, check_shapes
from seacage.surrogates._scaling import Scaling
from seacage.surrogates._shape._pca import all_modes

CaseNode3 = Float[np.ndarray, "case node 3"]
MODES = 48  # most modes of the modal network
HELD_OUT = 0.1  # default share of held-out cases
FEWEST_HELD_OUT, FEWEST_TRAINING = 2, 2
Cases = tuple[Float[np.ndarray, "case feature"], CaseNode3]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class GCN:
    """A graph convolutional network of the net, not yet fitted.

    ``kind="paper"`` is the paper's network: the graph of the net with its adjacency normalised
    as D^-1/2 (A + I) D^-1/2; the rest position of a node and the sea state as its features;
    three graph convolutions, Swish between them; a mean square error in which layers 6 to 10
    weigh more and the tip most. Where the paper is silent or says two things, we took: 64
    channels; biases, as every library's graph convolution has; no Swish after the last layer,
    which could not answer below -0.28 otherwise; coordinates as targets (its Methods; its
    Results say displacements), centred per axis and divided by one number, so that the loss
    stays its own up to a factor; weights 1, 2 and 4; Adam, batches of 64, a warm-up and a
    cosine, a running average of the weights, 150 epochs. Its features are speed and
    direction; give ``x`` so, or as a vector, which has no seam at north.

    ``kind="modal"`` learns displacements from the mean shape. Three hops along the edges, and
    a sea state copied to every node, cannot make the net as a whole lean. Here residual
    graph convolutions make modes of the whole net, beside principal components, and a token
    made from the sea state gives the amplitude of each. On half-hours in waves the token
    and the modes are what helps; without the graph the error was the same within 2 %.

    Training needs JAX and optax (the extra ``gcn``); predicting needs neither.

    Source: Katsidoniotaki et al. (2025), Sci. Rep. 15:44281, Methods, "Graph convolutional networks
    for net cage deformation"; Kipf & Welling (2017).
    """

    # Whose net it is; or pairs of node numbers, from 0, and the shape in still water [m]
    cage: Cage | None = None
    edges: Int[np.ndarray, "edge 2"] | None = None
    rest_position: Float[np.ndarray, "node 3"] | None = None
    kind: Kind = "modal"  # which network
    # Of each node's squared error in the loss; None means 1 everywhere, and for the paper's network
    # 2 on the deeper half of the nodes (layers 6 to 10 of the paper's net and its tip) and 4 on the
    # deepest
    node_weight: Float[np.ndarray, " node"] | None = None
    # Of the training; None means what suits the kind
    width: int | None = None  # channels per node
    epochs: int | None = None  # most passes through the cases
    patience: int | None = None  # epochs without a better answer to the held-out cases that end it
    learning_rate: float | None = None  # largest step of Adam

    def __post_init__(self) -> None:
        self._recipe()
        self._weight(self._graph())

    def fit(
        self,
        x: Float[np.ndarray, "n feature"],
        node_position: Float[np.ndarray, "n node 3"],
        *,
        seed: int = 0,
        validation: float | Cases | None = None,
        progress: Progress | None = None,
    ) -> "FittedGCN":
        """Learn from features and shapes; the seed and the machine fix the answer.

        Raises InputError: what was given does not fit together or is too little, or JAX is not
        installed.

        Parameters
        ----------
        x
            One row per case, e.g. from ``current_features``.
        node_position
            The shape of each case [m].
        seed
            Of the first weights, the batches and the draw of held-out cases.
        validation
            Held-out cases, which decide when to stop and give the standard deviation. A
            share of these cases, drawn at random, None for a tenth; or features and shapes of
            their own, as for a record in time, where neighbours are the same sample.
        progress
            Called as ("gcn", epoch, epochs).
        """
        training = _training()
        graph = self._graph()
        x, shape, held_out = _cases(x, node_position, graph, validation, seed)
        train = np.setdiff1d(np.arange(len(x)), held_out)
        scaling = Scaling.of(x[train])
        x = scaling.standardise(x)
        centre, spread = _units(shape[train], self.kind)
        target = (shape - centre) / spread
        parameters, epochs = training.train_network(
            self.kind,
            self._first(x.shape[1], target[train], seed),
            training.TrainingSet(
                rest=standard_rest(graph),
                propagation=graph.propagation(),
                weight=self._weight(graph),
                x=x,
                target=target,
                train=train,
                held_out=held_out,
            ),
            recipe=self._recipe(),
            seed=seed,
            progress=progress,
        )
        network = Network(
            kind=self.kind,
            graph=graph,
            scaling=scaling,
            centre=centre,
            spread=spread,
            parameters=parameters,
        )
        residual = shape - network.answer(x)
        return FittedGCN(
            network=network,
            off=Spread.of(x, residual, train=train, held_out=held_out),
            epochs=epochs,
        )

    def _graph(self) -> Graph:
        if self.cage is not None and self.edges is None and self.rest_position is None:
            return Graph.of(self.cage.edges, self.cage.design_position)
        if self.cage is None and self.edges is not None and self.rest_position is not None:
            return Graph.of(self.edges, self.rest_position)
        raise InputError(
            "GCN: the net is not clear. Give a cage alone, or edges and rest_position together."
        )

    def _recipe(self) -> Recipe:
        return recipe_of(self.kind, **{one.name: getattr(self, one.name) for one in fields(Recipe)})

    def _weight(self, graph: Graph) -> Float[np.ndarray, " node"]:
        weight = self.node_weight
        if weight is None:
            weight = _deep_weight(graph) if self.kind == "paper" else np.ones(graph.nodes)
        positive = np.all(weight >= 0.0) and 0 < np.sum(weight) < np.inf
        if len(weight) != graph.nodes or not positive:
            raise InputError(
                f"GCN: node_weight must be {graph.nodes} finite numbers of at least 0, one per "
                "node, and not all 0."
            )
        return weight / np.mean(weight)

    def _first(self, features: int, target: CaseNode3, seed: int) -> dict[str, np.ndarray]:
        # The principal components, each as large as it is in a typical case
        flat = target.reshape(len(target), -1)
        components, _ = all_modes(flat)
        size = np.sqrt(np.mean(components.encode(flat) ** 2, axis=0))
        modes = (components.direction * size[:, None])[:MODES]
        shapes = parameter_shapes(
            self.kind,
            features=features,
            nodes=target.shape[1],
            width=self._recipe().width,
            modes=len(modes),
        )
        return first_parameters(shapes, modes=modes, seed=seed)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedGCN:
    """A trained network and how far it is off; it needs no JAX."""

    MODEL: ClassVar[str] = "gcn"

    network: Network  # gives the mean
    off: Spread  # gives the standard deviation
    epochs: int  # passes through the cases that it took

    def predict(self, x: Float[np.ndarray, "row feature"], *, noisy: bool = False) -> Prediction:
        """Shape at each row of features [m].

        ``x``: one row per case, the features of the training.
        ``noisy``: of a new case as the training had them. Otherwise without what differs between
        neighbouring cases, which with many features holds much of the network's own miss: for an
        interval about a shape ask noisy.
        """
        x = check_inputs(x, what="GCN.predict", width=len(self.network.scaling.centre))
        x = self.network.scaling.standardise(x)
        return Prediction(mean=self.network.answer(x), std=self.off.std(x, noisy=noisy))

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs, as plain values and float64 arrays."""
        settings, arrays = self.network.to_arrays()
        saved: Settings = {"model": self.MODEL, "epochs": self.epochs, **settings}
        return saved, arrays | self.off.to_arrays()

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """The model that ``to_arrays`` described; ``ModelError`` where it is damaged."""
        network = Network.from_arrays(settings, arrays)
        features, nodes = len(network.scaling.centre), network.graph.nodes
        return cls(
            network=network,
            off=Spread.from_arrays(arrays, features=features, nodes=nodes),
            epochs=setting(settings, "epochs", int),
        )


def _training() -> ModuleType:
    """The only part that needs JAX."""
    try:
        from seacage.surrogates._gcn import _training
    except ModuleNotFoundError as error:
        raise InputError(
            f"GCN.fit: training needs {error.name}, which is not installed; predicting does not. "
            "Install it with: pip install 'seacage[gcn]'."
        ) from error
    return _training


def _cases(
    x: np.ndarray, node_position: np.ndarray, graph: Graph, validation: object, seed: int
) -> tuple[Float[np.ndarray, "case feature"], CaseNode3, Int[np.ndarray, " held"]]:
    """All cases, and which of them are held out."""
    x, shape = _check_cases(x, node_position, graph, what="GCN.fit")
    if isinstance(validation, tuple) and len(validation) == 2:
        other, other_shape = _check_cases(*validation, graph, what="GCN.fit, validation")
        if other.shape[1] != x.shape[1]:
            raise InputError(
                f"GCN.fit: validation has {other.shape[1]} features per row, x has {x.shape[1]}. "
                "Build both with the same features, in the same order."
            )
        held_out = len(x) + np.arange(len(other))
        return np.vstack([x, other]), np.concatenate([shape, other_shape]), held_out
    return x, shape, _draw_held_out(len(x), validation, seed)


def _check_cases(x: np.ndarray, node_position: np.ndarray, graph: Graph, *, what: str) -> Cases:
    x, shape = check_shapes(x, node_position, what=what)
    if shape.shape[1] != graph.nodes:
        raise InputError(
            f"{what}: the shapes have {shape.shape[1]} nodes, but the graph has {graph.nodes}. "
            "Give the cage, or the edges and rest position, that the shapes are of."
        )
    return x, shape


def _draw_held_out(cases: int, validation: object, seed: int) -> Int[np.ndarray, " held"]:
    share = HELD_OUT if validation is None else validation
    if not isinstance(share, float | int) or not 0.0 < share < 1.0:
        raise InputError(
            f"GCN.fit: validation = {share!r} is neither a share between 0 and 1 nor "
            "(x, node_position). Give 0.1 for a tenth."
        )
    count = max(FEWEST_HELD_OUT, round(share * cases))
    if cases - count < FEWEST_TRAINING:
        raise InputError(
            f"GCN.fit: of {cases} cases {count} are held out, which leaves fewer than "
            f"{FEWEST_TRAINING} to learn from. Give more cases or a smaller validation share."
        )
    return np.sort(np.random.default_rng(seed).permutation(cases)[:count])


def _units(shape: CaseNode3, kind: Kind) -> tuple[Float[np.ndarray, "node 3"], float]:
    """What an answer of 0 means and what 1 adds: coordinates for the paper, else displacements."""
    centre = shape.mean(axis=0)
    if kind == "paper":
        centre = np.tile(centre.mean(axis=0), (len(centre), 1))
    # A net that never moves has no spread; any unit will do.
    return centre, float(np.std(shape - centre)) or 1.0


def _deep_weight(graph: Graph) -> Float[np.ndarray, " node"]:
    """Heavier on the deeper half, heaviest on the deepest."""
    height = graph.rest_position[:, 2]
    return np.where(height <= height.min(), 4.0, np.where(height <= np.median(height), 2.0, 1.0))
