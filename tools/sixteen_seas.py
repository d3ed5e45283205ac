"""What a change does to the reference cage in sixteen seas: a table for a note on physics.

    python tools/sixteen_seas.py BASE        defaults of a commit and of this tree
    python tools/sixteen_seas.py --base '{"mooring": "springs"}' --own '{"law": "loland"}'

Currents of 0.2, 0.5 and 0.8 m/s with waves of 0.5, 1, 2 and 3 m and Tp = 5√Hs along them; and at
0.5 m/s and 2 m a long period, an oblique sea, one on a corner of the frame and one against the
current. Half a second of samples, 1,200 s after 300 s, the same phases on both sides.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from same_answers import ROOT, installed

NORTH, CORNER = 0.0, 45.0
DURATION, SPIN_UP = 1200.0, 300.0


def main() -> None:
    """Run both sides and print the table."""
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("commit", nargs="?", help="the other side's; this tree's if left out")
    for side in ("base", "own"):
        options.add_argument(f"--{side}", default="{}", help="options of simulate, as JSON")
    options.add_argument("--answer", nargs=2, help=argparse.SUPPRESS)
    given = options.parse_args()
    if given.answer:
        kept, settings = given.answer
        np.savez(kept, **answer(json.loads(settings)))
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        other = installed(given.commit, folder) if given.commit else ROOT / "src"
        base = answer_of(other, given.base, folder / "base.npz")
        own = answer_of(ROOT / "src", given.own, folder / "own.npz")
    print(table(base, own))


def answer_of(source: Path, settings: str, kept: Path) -> dict[str, np.ndarray]:
    """What the package in a folder answers, in a process of its own."""
    environment = os.environ | {"PYTHONPATH": str(source)}
    command = [sys.executable, __file__, "--answer", kept, settings]
    subprocess.run(command, env=environment, check=True)
    with np.load(kept, allow_pickle=False) as arrays:
        return dict(arrays)


def seas() -> list[Any]:
    """The sixteen."""
    from seacage.ocean import SeaState

    def one(speed: float, hs: float, tp: float, to: float, wave_from: float) -> SeaState:
        return SeaState(current_speed=speed, current_to=to, hs=hs, tp=tp, wave_from=wave_from)

    along = [
        one(speed, hs, 5.0 * hs**0.5, NORTH, 180.0)
        for speed in (0.2, 0.5, 0.8)
        for hs in (0.5, 1.0, 2.0, 3.0)
    ]
    usual = 5.0 * 2.0**0.5
    return [
        *along,
        one(0.5, 2.0, 11.0, NORTH, 180.0),
        one(0.5, 2.0, usual, NORTH, 225.0),
        one(0.5, 2.0, usual, CORNER, 225.0),
        one(0.5, 2.0, usual, NORTH, 0.0),
    ]


def answer(settings: dict[str, Any]) -> dict[str, np.ndarray]:
    """Bridles' tensions and the net's mean shape in each sea."""
    from seacage.cage import Cage
    from seacage.dynamics import simulate

    every = seas()
    history = simulate(
        Cage.named("ace"), every, **{"duration": DURATION, "spin_up": SPIN_UP} | settings
    )
    return {
        "sea": np.array(
            [f"{s.current_speed:g} m/s, {s.hs:g} m, {s.peak_period:.3g} s" for s in every]
        ),
        "mean": history.bridle.mean,
        "std": history.bridle.std,
        "most": history.bridle.maximum,
        "node": history.node.mean,
        "drag": np.linalg.norm(history.net_force.mean, axis=-1),
    }


def table(base: dict[str, np.ndarray], own: dict[str, np.ndarray]) -> str:
    """Sea by sea, of the bridle that is most loaded on the base's side."""
    rows = np.arange(len(base["sea"]))
    bridle = np.argmax(base["mean"], axis=1)
    change = {
        name: 100.0 * (own[name][rows, bridle] / base[name][rows, bridle] - 1.0)
        for name in ("mean", "std", "most")
    }
    change["drag"] = 100.0 * (own["drag"] / base["drag"] - 1.0)
    moved = np.linalg.norm(own["node"] - base["node"], axis=-1)
    lines = [f"{'sea':<22}bridle  mean kN       std kN        maximum kN      drag %  nodes m"]
    for i in rows:
        numbers = "".join(
            f"{base[name][i, bridle[i]] / 1e3:6.2f} {change[name][i]:+6.1f} %"
            for name in ("mean", "std", "most")
        )
        lines.append(
            f"{base['sea'][i]:<24}{bridle[i] + 1:>4}  {numbers}  {change['drag'][i]:+6.1f}"
            f"  {np.median(moved[i]):5.2f} {moved[i].max():5.2f}"
        )
    worst = {name: one[np.argmax(np.abs(one))] for name, one in change.items()}
    lines += [
        "median [worst] of the changes: "
        + ", ".join(f"{n} {np.median(one):+.1f} [{worst[n]:+.1f}] %" for n, one in change.items()),
        f"nodes {np.median(moved):.2f} m in the median, {moved.max():.2f} m at most",
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
