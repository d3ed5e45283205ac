"""Compile a two-fidelity model of the current to a table, save it, and compare the two.

python examples/07_table.py
"""

import json
import tempfile
import time
from pathlib import Path

import numpy as np
from safetensors.numpy import load_file, save_file

from seacage.surrogates import NARGP, Disc, FittedNARGP, Table, current_features, decode, encode


def currents(count: int, random: np.random.Generator) -> np.ndarray:
    """Speed, east and north component of currents up to 1 m/s, all directions alike."""
    speed, angle = random.uniform(size=count), random.uniform(0.0, 2.0 * np.pi, count)
    return current_features(speed[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]))


def simulated(x: np.ndarray) -> np.ndarray:
    """Tension of a bridle [kN], by formula."""
    return 8.0 + 20.0 * x[:, 0] * (x[:, 0] + x[:, 1])


random = np.random.default_rng(0)
many, few = currents(200, random), currents(80, random)
readings = 1.2 * simulated(few) + 0.01 * simulated(few) ** 2 + random.standard_normal(80)
fitted = NARGP().fit([(many, simulated(many)), (few, readings)])

# The region is all currents up to 1 m/s; the grid grows until the error is small enough.
table = Table.of(fitted, Disc(radius=1.0), tolerance=1e-3)
print(f"{table.nodes[0]} speeds x {table.nodes[1]} directions")
print(f"largest error found: {table.mean_error:.1e} predictive sd of the mean,")
print(f"and {table.std_error:.1e} of the sd itself")


def spent(model: FittedNARGP | Table, x: np.ndarray) -> float:
    """CPU time per row [s]."""
    start = time.process_time()
    model.predict(x)
    return (time.process_time() - start) / len(x)


x = currents(200_000, random)
ratio = spent(fitted, x[:5000]) / spent(table, x)
print(f"{ratio:.0f} times faster than the model")

# Plain settings and plain arrays; nothing in them can run.
with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    settings, arrays = encode(table)
    (folder / "table.json").write_text(json.dumps(settings))
    save_file(arrays, folder / "table.safetensors")
    size = (folder / "table.safetensors").stat().st_size
    read = json.loads((folder / "table.json").read_text())
    back = decode(read, load_file(folder / "table.safetensors"))
same = np.array_equal(back.predict(x[:100]).mean, table.predict(x[:100]).mean)
print(f"saved in {size / 1e3:.0f} kB, and the same again when read: {same}")
