"""Draw where the reference cage has two equilibria: docs/pictures/equilibria.png.

One is followed from rest as the water rises. The other is found from a net that hangs straight
in fast water, and followed as the water falls.
"""

import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.conventions import Origin
from seacage.dynamics import rest_shape
from seacage.dynamics._equilibrium._search import _balance, _near, _seek, _start
from seacage.dynamics._moored._mooring import assemble
from seacage.dynamics._physics._flow import steady_flow
from seacage.figures._style import INK, LOW, MULTI, MUTED, blank_figure, head, style, write_figure

CAGE = Cage.named("ace")
SPEEDS = np.arange(0.0, 1.601, 0.02)
SHOWN = 1.3


def followed(speeds, shape, law):
    """Shapes in currents towards the north: the first as settle seeks, then from the one before."""
    assembly = assemble(CAGE)
    balance = _balance(assembly)
    shapes, state = [], _start(assembly, shape[None].copy())
    with ThreadPoolExecutor(1) as pool:
        for speed in speeds:
            flow = steady_flow(assembly, np.array([[0.0, speed]]), law=law)
            _seek(assembly, flow, state, balance, pool)
            settled = state.residual[0] <= balance.tolerance
            shapes.append(np.where(settled, state.position[0], np.nan))
            state = _near(assembly, state.position, balance)
    return np.array(shapes)


def drawn(one, lifted, ruling):
    """Volumes of both and of the ruling law's only one; both shapes from the side."""
    with style():
        figure = blank_figure(7.2, 3.0)
        grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.5))
        volume = figure.add_subplot(grid[:, 0])
        rest = CAGE.volume(rest_shape(CAGE))
        for shapes, colour, label, place in (
            (ruling, MUTED, "Kristiansen & Faltinsen", (0.7, 69.0)),
            (one, LOW, "Løland, from rest", (0.03, 42.0)),
            (lifted, MULTI, "Løland, the other", (0.36, 8.0)),
        ):
            share = 100.0 * CAGE.volume(shapes[:, : CAGE.node_count]) / rest
            speeds = SPEEDS[-len(share) :]
            volume.plot(speeds, share, color=colour, linewidth=1.5)
            volume.text(*place, label, color=colour)
        volume.set(xlabel="current [m/s]", ylabel="volume left [%]", ylim=(0, 104), xlim=(0, 1.65))
        at = -1 - round((SPEEDS[-1] - SHOWN) / 0.02)
        for row, (shapes, colour, title) in enumerate(
            ((one, LOW, "Followed from rest"), (lifted, MULTI, "The other"))
        ):
            side = figure.add_subplot(grid[row, 1])
            shape = shapes[at, : CAGE.node_count, 1:]
            side.plot(*shape[CAGE.edges].transpose(2, 1, 0), color=colour, linewidth=0.4)
            side.axhline(0.0, color=INK, linewidth=0.6)
            side.set(
                xlabel="down-stream [m]" if row else "",
                ylabel="height [m]",
                xlim=(-22, 46),
                ylim=(-9, 4),
                aspect="equal",
            )
            head(side, f"{title}, {SHOWN:g} m/s to the right", origin=Origin.COMPUTED)
        return figure


def main(path):
    """Follow, tell and draw."""
    start = assemble(CAGE).position
    ruling = followed(SPEEDS, start, "kristiansen-faltinsen")
    one = followed(SPEEDS, start, "loland")
    other = followed(SPEEDS[::-1], start, "loland")[::-1]
    apart = np.linalg.norm(one - other, axis=-1).max(axis=1)
    two = apart > 0.05
    print(f"Løland: two from {SPEEDS[two].min():.2f} m/s, up to {np.nanmax(apart):.1f} m apart")
    write_figure(drawn(one, other[two], ruling), path)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/equilibria.png"))
