"""Where a tangent's blocks lie: each part finds its place, and elimination fills no other."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.dynamics._kernel._sparsity import Pattern
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._parts._assembly import Assembly

ACE = Cage.named("ace")
COARSE = ACE.altered(mesh={"spokes": 16, "ring_depths_m": [0.0, 7.0, 15.0, 21.4, 27.8]})
PARTS = anchor_assembly(COARSE)


@pytest.fixture(scope="module")
def pattern():
    return Pattern.of(PARTS)


def rows(pattern):
    return np.repeat(np.arange(len(pattern.order)), np.diff(pattern.row))


def test_every_node_has_one_row_with_a_diagonal_block(pattern):
    np.testing.assert_array_equal(np.sort(pattern.order), np.arange(len(PARTS.position)))
    np.testing.assert_array_equal(pattern.column[pattern.diagonal], np.arange(len(pattern.order)))
    np.testing.assert_array_equal(rows(pattern)[pattern.diagonal], np.arange(len(pattern.order)))


def test_each_part_finds_the_blocks_of_its_nodes(pattern):
    row = rows(pattern)
    for places, nodes in (
        (pattern.bars, PARTS.bars.ends),
        (pattern.bends, PARTS.bends.nodes),
        (pattern.panels, PARTS.panels.corners),
        (pattern.floats, PARTS.floats.nodes[:, None]),
        (pattern.cylinders, PARTS.cylinders.ends),
        (pattern.springs, PARTS.springs.nodes[:, None]),
        (pattern.grounds, PARTS.ground.nodes[:, None]),
    ):
        of_row, of_column = pattern.order[row[places]], pattern.order[pattern.column[places]]
        np.testing.assert_array_equal(of_row, np.repeat(nodes[:, :, None], nodes.shape[1], 2))
        np.testing.assert_array_equal(of_column, np.swapaxes(of_row, 1, 2))


def test_elimination_fills_the_blocks_of_the_pattern_and_no_others(pattern):
    nodes = len(pattern.order)
    joined = np.eye(nodes, dtype=bool)
    for part in (PARTS.bars.ends, PARTS.bends.nodes, PARTS.panels.corners):
        joined[part[:, :, None], part[:, None, :]] = True
    filled = joined[np.ix_(pattern.order, pattern.order)]
    for pivot in range(nodes):
        below = np.flatnonzero(filled[pivot + 1 :, pivot]) + pivot + 1
        filled[np.ix_(below, below)] = True
    kept = np.zeros_like(filled)
    kept[rows(pattern), pattern.column] = True
    np.testing.assert_array_equal(kept, filled)


def test_the_order_fills_up_less_than_ring_by_ring():
    # 10,927 blocks for the reference cage; in the nodes' own order they would be 22,623
    assert len(Pattern.of(Assembly.of(ACE)).column) < 12_000


def test_cages_with_one_graph_share_a_pattern(pattern):
    heavier = anchor_assembly(COARSE.altered(tip={"weight_n": 9000.0}))
    assert Pattern.of(heavier) is pattern
