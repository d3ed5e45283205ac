"""Two million ticks of one sensor: by the model itself, by its table, and by the bare machine.

Two million ticks are a winter at 2 s. The sensor is a two-level NARGP of 1,000 simulated and 300
measured cases of the current alone. What the loop could not do without is timed in the same run:
to read two numbers per tick and write two, and the multiplications and additions of a bicubic
spline of three fields at the rate of a matrix product.
"""

import time
from collections.abc import Callable

import numpy as np
from _timing import ONCE

from seacage.surrogates import NARGP, Disc, Table

TICKS = 20_000 if ONCE else 2_000_000
QUERIES = 200 if ONCE else 20_000
FLOPS = 2 * 12 + 16 + 2 * 16 * 3
"""Of one tick: two axes' weights, their products, three sums of sixteen."""


def spent(work: Callable[[], object], *, rounds: int = 3) -> float:
    """The least CPU time of several rounds [s]; a shared machine only ever adds."""
    times: list[float] = []
    for _ in range(1 if ONCE else rounds):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)


def currents(count: int, random: np.random.Generator) -> np.ndarray:
    """All directions and speeds up to 1 m/s alike likely, towards (east, north)."""
    speed, angle = random.uniform(size=count), random.uniform(0.0, 2.0 * np.pi, count)
    return speed[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])


def simulated(x: np.ndarray) -> np.ndarray:
    """A bridle's tension [kN], as a formula: steepest where the current pulls along it."""
    along = x @ np.array([np.cos(0.8), np.sin(0.8)])
    return 8.0 + 25.0 * np.logaddexp(0.0, 4.0 * along * np.hypot(*x.T)) / 4.0


def measured(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """The same bridle of a softer, fouled cage through a noisy shackle [kN]."""
    low = simulated(x)
    return 1.2 * low - 0.004 * low**2 + x[:, 0] + 0.8 * random.standard_normal(len(x))


random = np.random.default_rng(0)
many, few = currents(100 if ONCE else 1000, random), currents(30 if ONCE else 300, random)
fitted = NARGP().fit([(many, simulated(many)), (few, measured(few, random))])
region = Disc(radius=1.0, length_first=False)
start = time.process_time()
table = Table.of(fitted, region, tolerance=0.1 if ONCE else 1e-3)
made = time.process_time() - start

x = currents(TICKS, random)

exact, quick = fitted.predict(x[:QUERIES]), table.predict(x[:QUERIES])
error = float(np.max(np.abs(quick.mean - exact.mean) / exact.std))
std_error = float(np.max(np.abs(quick.std / exact.std - 1.0)))

by_model = spent(lambda: fitted.predict(x[:QUERIES]), rounds=1) * TICKS / QUERIES
by_table = spent(lambda: table.predict(x))
noisy = spent(lambda: table.predict(x, noisy=True))

answer = np.empty_like(x)
moved = spent(lambda: np.copyto(answer, x))
size = 64 if ONCE else 1024
square = random.standard_normal((size, size))
flop_rate = 2.0 * size**3 / max(spent(lambda: square @ square), 1e-9)
limit = max(moved, TICKS * FLOPS / flop_rate)

print(f"table of a NARGP, {TICKS:,} ticks, CPU time on one core")
rows = {
    f"the model itself (from {QUERIES:,} ticks)": by_model,
    "the table": by_table,
    "the table, of a new observation": noisy,
    "making the table": made,
    "limit: reading and writing": moved,
    "limit: multiplying and adding": TICKS * FLOPS / flop_rate,
}
for name, taken in rows.items():
    print(f"  {name:<48}{taken:12.3f} s{by_model / max(taken, 1e-9):12.0f} × the model")
print(f"  nodes {' x '.join(map(str, table.nodes))}; {by_table / limit:.0f} × the machine's limit")
print(
    f"  largest error found: {table.mean_error:.1e} predictive sd of the mean, "
    f"{table.std_error:.1e} of the sd, stated; {error:.1e} and {std_error:.1e} at the ticks"
)
