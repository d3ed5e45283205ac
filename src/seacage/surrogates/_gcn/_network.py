"""A trained network, which answers in NumPy alone."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, ModelError
from seacage.surrogates._arrays import Arrays, Settings, array, setting
from seacage.surrogates._gcn._graph import Graph
from seacage.surrogates._gcn._layers import NETWORKS, Kind, Parameters, parameter_shapes
from seacage.surrogates._scaling import Scaling

BLOCK = 64  # rows answered at once, so that the channels of all nodes stay in the cache


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Network:
    """A network with what brings its inputs and outputs to their units."""

    kind: Kind  # which network
    graph: Graph  # of the net
    scaling: Scaling  # of the features
    centre: Float[np.ndarray, "node 3"]  # what an answer of 0 means [m]
    spread: float  # what an answer of 1 adds [m]
    parameters: Parameters  # by name

    def answer(self, x: Float[np.ndarray, "row feature"]) -> Float[np.ndarray, "row node 3"]:
        """Shapes at standardised features [m]."""
        network, rest = NETWORKS[self.kind], standard_rest(self.graph)
        shape = np.empty((len(x), *self.centre.shape))
        for start in range(0, len(x), BLOCK):
            rows = slice(start, start + BLOCK)
            shape[rows] = network(np, self.parameters, rest, x[rows], self.graph.propagate)
        return self.centre + self.spread * shape

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs, as plain values and float64 arrays."""
        settings: Settings = {
            "kind": self.kind,
            "width": self.parameters["place"].shape[1],
            "modes": len(self.parameters.get("mode", ())),
            "spread": self.spread,
        }
        return settings, {
            "edges": self.graph.edges.astype(np.float64),
            "rest_position": self.graph.rest_position,
            "feature_centre": self.scaling.centre,
            "feature_spread": self.scaling.spread,
            "centre": self.centre,
        } | {f"parameter.{name}": values for name, values in self.parameters.items()}

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """The network that ``to_arrays`` described; ``ModelError`` where it is damaged."""
        kind = setting(settings, "kind", str)
        if kind not in NETWORKS:
            raise ModelError(
                f"The saved GCN is of kind {kind!r}, which this version does not know."
            )
        rest = array(arrays, "rest_position", None, 3)
        feature_centre = array(arrays, "feature_centre", None)
        shapes = parameter_shapes(
            kind,
            features=len(feature_centre),
            nodes=len(rest),
            width=setting(settings, "width", int),
            modes=setting(settings, "modes", int),
        )
        edges = np.rint(array(arrays, "edges", None, 2)).astype(int)
        try:
            graph = Graph.of(edges, rest)
        except InputError as error:
            raise ModelError(f"The saved GCN is damaged: {error}") from error
        return cls(
            kind=kind,
            graph=graph,
            scaling=Scaling(
                centre=feature_centre, spread=array(arrays, "feature_spread", len(feature_centre))
            ),
            centre=array(arrays, "centre", len(rest), 3),
            spread=setting(settings, "spread", float),
            parameters={
                name: array(arrays, f"parameter.{name}", *shape) for name, shape in shapes.items()
            },
        )


def standard_rest(graph: Graph) -> Float[np.ndarray, "node 3"]:
    """Rest position as a feature of the nodes."""
    rest = graph.rest_position
    return Scaling.of(rest).standardise(rest)
