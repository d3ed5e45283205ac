"""A net as a graph of nodes and ties."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
import scipy
from jaxtyping import Float, Int

from seacage.conventions import InputError

# Passes the nodes' channels (row, node, channel) to their neighbours, in NumPy or in JAX
Propagate = Callable[[Any], Any]


# No slots here: the propagation is computed once and kept.
@dataclass(frozen=True, kw_only=True, eq=False)
class Graph:
    """Nodes at rest and the pairs of them that are tied; ties have no direction and no length."""

    edges: Int[np.ndarray, "edge 2"]  # pairs of nodes, from 0; a pair given twice counts once
    rest_position: Float[np.ndarray, "node 3"]  # of the nodes, x east, y north, z up [m]

    @classmethod
    def of(cls, edges: np.ndarray, rest_position: np.ndarray) -> Self:
        """Check and keep copies.

        Raises InputError: a node that does not exist or is tied to itself, or a position that is
        not finite.
        """
        pairs, rest = np.array(edges), np.array(rest_position, dtype=np.float64)
        if rest.ndim != 2 or rest.shape[1:] != (3,) or not np.isfinite(rest).all():
            raise InputError(
                f"Graph: rest_position has shape {rest.shape}; expected (nodes, 3), "
                "finite, in m. Give the shape of the net in still water."
            )
        whole = np.issubdtype(pairs.dtype, np.integer)
        if pairs.ndim != 2 or pairs.shape[1:] != (2,) or not whole:
            raise InputError(
                f"Graph: edges are {pairs.dtype} {pairs.shape}; expected whole numbers "
                "(edges, 2). Give one pair of nodes per row."
            )
        if pairs.size and (pairs.min() < 0 or pairs.max() >= len(rest)):
            raise InputError(
                f"Graph: the edges name nodes {pairs.min()} to {pairs.max()}, but there are "
                f"{len(rest)} positions, from 0. Give the edges of this net."
            )
        if np.any(pairs[:, 0] == pairs[:, 1]):
            raise InputError(
                "Graph: an edge ties a node to itself. Leave it out; every node is its own "
                "neighbour already."
            )
        return cls(edges=pairs, rest_position=rest)

    @property
    def nodes(self) -> int:
        """How many there are."""
        return len(self.rest_position)

    def propagation(self) -> Float[np.ndarray, "node node"]:
        """Weights of a node's neighbours and of itself in a convolution, D^-1/2 (A + I) D^-1/2.

        A is the adjacency matrix and D the diagonal of the row sums of A + I.

        Source: Kipf & Welling (2017), the renormalisation of their eq. (2).
        """
        adjacency = np.eye(self.nodes)
        one, other = self.edges.T
        adjacency[one, other] = adjacency[other, one] = 1.0
        degree = adjacency.sum(axis=1)
        return adjacency / np.sqrt(np.outer(degree, degree))

    @cached_property
    def propagate(self) -> Propagate:
        """The same as a function of the nodes' channels, over the edges alone.

        A net has few edges per node, and a full matrix is mostly zeros.
        """
        sparse = scipy.sparse.csr_array(self.propagation())

        def propagate(signal: Float[np.ndarray, "row node channel"]) -> np.ndarray:
            rows, nodes, channels = signal.shape
            columns = signal.transpose(1, 0, 2).reshape(nodes, rows * channels)
            return (sparse @ columns).reshape(nodes, rows, channels).transpose(1, 0, 2)

        return propagate
