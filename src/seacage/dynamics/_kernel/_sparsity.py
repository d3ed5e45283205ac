"""Sparsity pattern of a cage's tangent stiffness and of its LU factors."""

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np
from jaxtyping import Int
from scipy.sparse import coo_array, csc_array, eye_array
from scipy.sparse.linalg import splu

from seacage.dynamics._parts._assembly import Assembly

# Parts of an assembly that stiffen it, in the order of a pattern's fields
PARTS = ("bars", "bends", "panels", "cylinders", "floats", "springs", "grounds")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pattern:
    """Blocks of two nodes, row by row in the order of elimination, all that fill up included."""

    # Number of each row's first block, at the end that of all; and of its diagonal one
    row: Int[np.ndarray, " row_and_end"]
    diagonal: Int[np.ndarray, " row"]
    column: Int[np.ndarray, " block"]  # of each block
    order: Int[np.ndarray, " row"]  # which node each row (and column) is of
    # Which block takes what each part adds for each pair of its nodes
    bars: Int[np.ndarray, "bar 2 2"]
    bends: Int[np.ndarray, "bend 3 3"]
    panels: Int[np.ndarray, "panel 4 4"]
    cylinders: Int[np.ndarray, "cylinder 2 2"]
    floats: Int[np.ndarray, "float 1 1"]
    springs: Int[np.ndarray, "spring 1 1"]
    grounds: Int[np.ndarray, "ground 1 1"]

    @classmethod
    def of(cls, assembly: Assembly) -> "Pattern":
        """Work out a pattern, or remember it: cages with one graph share it."""
        a = assembly
        several = (a.bars.ends, a.bends.nodes, a.panels.corners, a.cylinders.ends)
        parts = (*several, a.floats.nodes, a.springs.nodes, a.ground.nodes)
        parts = tuple(np.ascontiguousarray(part, dtype=np.int32) for part in parts)
        ends = tuple(part.shape[1] if part.ndim == 2 else 1 for part in parts)
        return _pattern(len(a.position), ends, tuple(part.tobytes() for part in parts))


@lru_cache(maxsize=16)
def _pattern(nodes: int, ends: tuple[int, ...], parts: tuple[bytes, ...]) -> Pattern:
    """The order of least degree keeps few entries; SuperLU finds it, and what fills up."""
    graph = [
        np.frombuffer(part, dtype=np.int32).reshape(-1, end)
        for part, end in zip(parts, ends, strict=True)
    ]
    order, filled = _elimination(nodes, graph)
    rank = np.empty(nodes, dtype=np.int64)
    rank[order] = np.arange(nodes)
    key = filled[0] * nodes + filled[1]

    def places(part: Int[np.ndarray, "part end"]) -> Int[np.ndarray, "part end end"]:
        ranked = rank[part]
        return np.searchsorted(key, ranked[:, :, None] * nodes + ranked[:, None, :])

    taken = {name: places(part) for name, part in zip(PARTS, graph, strict=True)}
    numbers = {
        "row": np.searchsorted(filled[0], np.arange(nodes + 1)),
        "diagonal": np.searchsorted(key, np.arange(nodes) * (nodes + 1)),
        "column": filled[1],
        "order": order,
    }
    arrays = numbers | taken
    return Pattern(**{name: values.astype(np.int32) for name, values in arrays.items()})


def _elimination(
    nodes: int, graph: list[np.ndarray]
) -> tuple[Int[np.ndarray, " node"], Int[np.ndarray, "2 block"]]:
    """An order of elimination, and rows and columns of all blocks that are not zero in it."""
    pairs = [part[:, pair] for part in graph for pair in combinations(range(part.shape[1]), 2)]
    one, other = np.concatenate([*pairs, np.zeros((0, 2), dtype=np.int32)]).T
    joined = coo_array((np.ones(len(one)), (one, other)), shape=(nodes, nodes))
    # heavy on the diagonal, so that no pivot is chosen and nothing cancels
    matrix = csc_array(joined + joined.T + (1.0 + 4.0 * len(one)) * eye_array(nodes))
    factors = splu(
        matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    both = coo_array(factors.L + factors.U)
    filled = np.array([both.row, both.col], dtype=np.int64)
    return np.argsort(factors.perm_c), filled[:, np.lexsort(filled[::-1])]
