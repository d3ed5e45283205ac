"""A winter at 2 s through a whole twin: every bridle and sensor, by the twin and by its table.

The twin learns a formula, as what it has learned does not change how long it takes. Two million
rows are asked for day by day, as a replay would; the twin itself makes the net's shape besides.
"""

import time

import numpy as np
from _timing import ONCE

from seacage.testing import stand_in_twin
from seacage.twin import Metocean, TabulatedTwin

DAYS, ROWS = (2, 1000) if ONCE else (46, 43_200)
QUERIES = 100 if ONCE else 2000


def day(index: int) -> Metocean:
    """A day's currents, a tide that grows and turns from day to day."""
    phase = 2.0 * np.pi * np.arange(ROWS) * 86400.0 / ROWS / 44700.0 + index
    speed = 0.3 + 0.15 * np.sin(0.4 * index)
    velocity = speed * np.column_stack([np.cos(phase), 0.6 * np.sin(phase)])
    return Metocean.from_table(np.column_stack([velocity, np.full((ROWS, 4), np.nan)]))


twin = stand_in_twin()
start = time.process_time()
tabulated = TabulatedTwin.of(twin, tolerance=1.0 if ONCE else 1e-2)
made = time.process_time() - start

by_table = 0.0
for index in range(DAYS):
    water = day(index)
    start = time.process_time()
    tabulated.predict(water)
    by_table += time.process_time() - start

start = time.process_time()
twin.predict(day(0).rows(np.arange(QUERIES)))
by_twin = (time.process_time() - start) * DAYS * ROWS / QUERIES

table = tabulated.table
print(f"a winter of {DAYS * ROWS:,} ticks, CPU time on one core")
for name, taken in (
    (f"the twin itself (from {QUERIES:,} ticks)", by_twin),
    ("its table", by_table),
    ("making the table", made),
):
    print(f"  {name:<48}{taken:12.2f} s{by_twin / max(taken, 1e-9):12.0f} × the twin")
print(
    f"  nodes {' x '.join(map(str, table.nodes))}; largest error found {table.mean_error:.1e} "
    f"predictive sd of a mean, {table.std_error:.1e} of an sd"
)
