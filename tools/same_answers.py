"""Compare the answers of this checkout with those of another commit, number by number.

    python tools/same_answers.py BASE                 bit for bit
    python tools/same_answers.py BASE --relative 1e-9

Both run on this machine, one after the other: settled shapes, simulations in time, fitted
surrogates and their predictions, a whole twin, and the alarms of some days on which sensors fail.
BASE is installed with its own kernel into a temporary folder; it takes a minute.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from datetime import timedelta
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]


def main() -> int:
    """Run both checkouts and compare; 1 where an answer differs."""
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("base", help="the other commit")
    options.add_argument("--relative", type=float, default=0.0, help="largest difference allowed")
    options.add_argument("--answer", action="store_true", help=argparse.SUPPRESS)
    given = options.parse_args()
    if given.answer:
        np.savez(given.base, **dict(answers()))
        return 0
    with tempfile.TemporaryDirectory() as folder:
        base = answers_of(installed(given.base, Path(folder)), Path(folder, "base.npz"))
        own = answers_of(ROOT / "src", Path(folder, "own.npz"))
    worst = {name: difference(base.get(name), own.get(name)) for name in {**base, **own}}
    for name, one in worst.items():
        size = own[name].size if name in own else 0
        print(f"{name:<40}{size:>10}  {'the same' if one == 0.0 else f'differs by {one:.2g}'}")
    return int(max(worst.values()) > given.relative)


def installed(commit: str, folder: Path) -> Path:
    """Install the package of a commit; the folder to import it from."""
    checkout, target = folder / "checkout", folder / "installed"
    checkout.mkdir()
    packed = subprocess.run(
        ["git", "archive", commit], cwd=ROOT, check=True, stdout=subprocess.PIPE
    )
    subprocess.run(["tar", "-x", "-C", checkout], input=packed.stdout, check=True)
    pip = [sys.executable, "-m", "pip", "--quiet", "install", "--no-deps"]
    subprocess.run([*pip, "--target", target, checkout], check=True)
    return target


def answers_of(source: Path, kept: Path) -> dict[str, np.ndarray]:
    """What the package in a folder answers, in a process of its own."""
    environment = os.environ | {"PYTHONPATH": str(source), "OPENBLAS_NUM_THREADS": "1"}
    subprocess.run([sys.executable, __file__, kept, "--answer"], env=environment, check=True)
    with np.load(kept, allow_pickle=False) as arrays:
        return dict(arrays)


def difference(one: np.ndarray | None, other: np.ndarray | None) -> float:
    """Largest difference, relative to the largest number of its array; infinite if not alike."""
    if one is None or other is None or one.shape != other.shape or one.dtype != other.dtype:
        return np.inf
    if one.dtype.kind != "f":
        return 0.0 if np.array_equal(one, other) else np.inf
    if not np.array_equal(np.isnan(one), np.isnan(other)):
        return np.inf
    largest = np.nanmax(np.abs(one), initial=0.0)
    return float(np.nanmax(np.abs(one - other), initial=0.0) / (largest or 1.0))


def answers() -> Iterator[tuple[str, np.ndarray]]:
    """Every array that is compared, by name."""
    yield from named("settle", settled_shapes())
    yield from named("simulate", simulations())
    yield from surrogates()
    yield from twin_and_alarms()


def named(name: str, value: Any) -> Iterator[tuple[str, np.ndarray]]:
    """Arrays of a dataclass, by the names of its fields."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiub":
        yield name, value
    elif is_dataclass(value):
        for field in fields(value):
            yield from named(f"{name}.{field.name}", getattr(value, field.name))


def settled_shapes() -> Any:
    """A moored cage in twenty currents."""
    from seacage.cage import Cage
    from seacage.dynamics import settle
    from seacage.testing import stand_in_seas

    cage = Cage.named("ace").altered(mesh={"spokes": 16})
    return settle(cage, stand_in_seas(20, seed=3, current_speed=1.2))


def simulations() -> Any:
    """A cage in waves and currents, in time."""
    from seacage.cage import Cage
    from seacage.dynamics import simulate
    from seacage.ocean import SeaState

    cage = Cage.named("ace").altered(mesh={"spokes": 8})
    waves = {"hs": 2.0, "tp": 7.0, "wave_from": 250.0}
    seas = [SeaState(current_speed=speed, current_to=80.0, **waves) for speed in (0.3, 0.8)]
    return simulate(cage, seas, duration=20.0, ramp=5.0, seed=4)


def surrogates() -> Iterator[tuple[str, np.ndarray]]:
    """A process and two levels, with hyperparameters that they have found themselves."""
    from seacage.surrogates import NARGP, GaussianProcess

    random = np.random.default_rng(5)
    x, new = random.uniform(-1.0, 1.0, (60, 3)), random.uniform(-1.0, 1.0, (40, 3))
    low = np.sin(4.0 * x[:, 0]) + x[:, 1] * x[:, 2]
    high = 1.2 * low[:20] + 0.1 * x[:20, 1] + 0.01 * random.standard_normal(20)
    yield from named("gaussian process", GaussianProcess().fit(x, low).predict(new))
    yield from named("nargp", NARGP().fit([(x, low), (x[:20], high)]).predict(new))


def twin_and_alarms() -> Iterator[tuple[str, np.ndarray]]:
    """A twin, and what is raised while a depth drifts, a shackle freezes and the buoy is lost."""
    from seacage.testing import stand_in_field, stand_in_seas, stand_in_twin
    from seacage.twin import AlarmBook, AlarmPolicy, Answered, assess

    twin = stand_in_twin()
    yield from named("twin", twin.predict(stand_in_seas(200, seed=6, current_speed=1.1)))
    policy = AlarmPolicy.default(twin.cage)
    state, book, journal = twin.start(), AlarmBook.new(), list[str]()
    samples = sorted(spoilt_samples(stand_in_field(twin.cage, seed=9, days=2.0)), key=by_time)
    now = samples[0].t
    while samples:
        now += timedelta(minutes=10)
        while samples and samples[0].t <= now:
            sample = samples.pop(0)
            state, _ = twin.step(state, sample, sample.t)
        state, events = twin.step(state, None, now)
        (answered,) = (event for event in events if isinstance(event, Answered))
        book, lines = assess(book, twin=twin, state=state, answered=answered, policy=policy)
        journal += [f"{one.t:%dT%H:%M} {one.alarm} {one.action}" for one in lines]
    yield "alarms", np.array(journal)
    yield from named("twin at the end", answered.answer)


def by_time(sample: Any) -> Any:
    """Order of samples."""
    return sample.t, sample.stream


def spoilt_samples(field: Any) -> Iterator[Any]:
    """A field's samples, some days of which have faults."""
    for record in (field.buoy, *field.sensors.values()):
        samples = list(record.samples())
        for sample in samples:
            hours = (sample.t - samples[0].t) / timedelta(hours=1)
            values = dict(sample.values)
            if sample.stream == "depth-2":
                values["depth_m"] += 0.1 * max(0.0, hours - 20.0)
            elif sample.stream == "shackle-1" and hours > 6.0:
                values["tension_kn"] = 12.3
            elif sample.stream == field.buoy.stream and 30.0 < hours < 34.0:
                continue
            yield replace(sample, values=values)


if __name__ == "__main__":
    sys.exit(main())
