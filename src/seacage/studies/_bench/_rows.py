"""Rows of the benchmark: predictions of each method for a case, from what is given alone."""

from collections.abc import Callable, Sequence
from datetime import timedelta
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import Extension, Origin
from seacage.records import Record, moment
from seacage.studies._bench._cases import Given
from seacage.studies._bench._peaks import seas_of
from seacage.studies._bench._stretches import CURRENT
from seacage.studies._paper._sensor_baselines import predict_by_sensor_baselines
from seacage.studies._paper._wave_loads import predict_statistic, regress_on_sea
from seacage.twin import (
    FaultWatch,
    Metocean,
    Training,
    Twin,
    align,
    block_residuals,
    residual_blocks,
    sensor_windows,
    train,
)

OURS, LOW, SIGMA = "seacage", "low fidelity", "three-sigma limit"
MEAN_ALONE, SEA_REGRESSION = "mean load alone", "sea-state regression"
TRAINING = Training(restarts=1)
SIGMAS = 3.0
NO_TREES = (
    "Boosted trees are left out: scikit-learn is not installed (pip install 'seacage[bench]')."
)
Rows = dict[str, dict[str, np.ndarray]]  # arrays of each row's file, by row and name


class LevelOne(NamedTuple):
    """Twins that have learned the low fidelity: settled, and in waves."""

    settled: Twin
    waves: Twin


def write_rows(
    begun: Path, given: Given, level_1: LevelOne, learners: Sequence[Extension] = ()
) -> None:
    """Write a file of predictions for each method here, and for each learner of other packages."""
    twin = train(given.cage, None, given.field, base=level_1.settled, training=TRAINING)
    rows: Rows = {}
    for part in (
        _mean_loads(given, twin, learners),
        {OURS: {"node_m": _nets(given, twin)}, LOW: {"node_m": _nets(given, level_1.settled)}},
        _alarms(given, twin),
        _peaks(given, level_1.waves),
    ):
        for name, arrays in part.items():
            rows.setdefault(name, {}).update(arrays)
    for name, arrays in rows.items():
        np.savez_compressed(begun / f"{name}.npz", allow_pickle=False, **arrays)


def trees_of_scikit_learn() -> Callable[..., np.ndarray] | None:
    """Boosted trees at scikit-learn's defaults; None where it is not installed."""
    if find_spec("sklearn") is None:
        return None

    def predict(x: np.ndarray, y: np.ndarray, at: np.ndarray) -> np.ndarray:
        from sklearn.ensemble import HistGradientBoostingRegressor

        return HistGradientBoostingRegressor(random_state=0).fit(x, y).predict(at)

    return predict


def _mean_loads(given: Given, twin: Twin, learners: Sequence[Extension]) -> Rows:
    water = twin.travel_time.water_at(given.field.buoy, given.queries["time"])
    answer = twin.predict(water).without_nodes()
    columns = dict[str, list[np.ndarray]]()
    for shackle in given.cage.shackles:
        column = answer.sensor_names.index(shackle.name)
        found = predict_by_sensor_baselines(
            twin,
            given.field,
            shackle.name,
            water,
            TRAINING,
            learners=learners,
            trees=trees_of_scikit_learn(),
        )
        each = {name: np.stack([one.mean, one.std]) for name, one in found.items()}
        best, low = answer.sensor, answer.sensor_low.mean[:, column]
        each[OURS] = np.stack([best.mean[:, column], best.std[:, column]])
        each[LOW] = np.stack([low, np.full_like(low, np.nan)])
        for name, one in each.items():
            columns.setdefault(name, []).append(one / 1e3)
    rows: Rows = {}
    for name, parts in columns.items():
        mean, sd = np.stack(parts, axis=2)
        rows[name] = {"mean_kn": mean} | ({"sd_kn": sd} if np.isfinite(sd).all() else {})
    return rows


def _nets(given: Given, twin: Twin) -> Float[np.ndarray, "t node 3"]:
    water = twin.travel_time.water_at(given.field.buoy, given.queries["net_time"])
    return twin.predict(water).node_position


def _alarms(given: Given, twin: Twin) -> Rows:
    """Raised alarms of the fault detector, and of a plain limit on the same residuals."""
    raised = {name: np.zeros(given.shapes["raised"], dtype=bool) for name in (OURS, SIGMA)}
    for stretch in range(len(raised[OURS])):
        _watch(given, twin, stretch, raised[OURS][stretch], raised[SIGMA][stretch])
    return {name: {"raised": one} for name, one in raised.items()}


def _watch(
    given: Given,
    twin: Twin,
    stretch: int,
    ours: Bool[np.ndarray, "block alarm"],
    limit: Bool[np.ndarray, "block alarm"],
) -> None:
    """Mark what is raised in a stretch; the last column is of alarms of no single sensor."""
    own = {
        name.removeprefix("stretch_"): one[stretch]
        for name, one in given.queries.items()
        if name.startswith("stretch_")
    }
    time, values = own["time"], {key: own[key] for key in CURRENT}
    buoy = Record(
        stream=given.field.buoy.stream,
        time=own["buoy_time"],
        values=values,
        origin=Origin.VIRTUAL_FIELD,
    )
    names = list(twin.sensor_names)
    newton = np.repeat([1.0, 1e3], [len(given.cage.depth_sensors), len(given.cage.shackles)])
    found = block_residuals(twin, buoy, time, own["reading"] * newton, np.arange(len(time)))
    places = [names.index(name) for name in found["sensors"].tolist()]
    begin, watch = moment(time[0]), FaultWatch.over(given.cage, found["sensors"].tolist())
    outside = np.abs(found["residual"]) > SIGMAS * found["std"]
    crossed = outside & ~np.vstack([np.zeros_like(outside[:1]), outside[:-1]])
    for number, one, crosses in zip(
        found["number"].tolist(), residual_blocks(found), crossed, strict=True
    ):
        limit[number, places] = crosses
        for alarm in watch.see(begin + timedelta(minutes=30 * (number + 1)), one):
            sensor = alarm.removeprefix("irregular.")
            ours[number, names.index(sensor) if sensor in names else -1] = True


def _peaks(given: Given, base: Twin) -> Rows:
    """Expected largest loads of ten minutes in seas that no shackle saw."""
    twin = train(given.cage, None, given.waves, base=base, training=TRAINING)
    water = Metocean.of(seas_of(given.queries))
    best, emulator = twin.predict(water).line, base.emulator
    assert best is not None
    assert emulator is not None
    low, _, _ = emulator.predict(water, spread=False)
    rows: dict[str, list[np.ndarray]] = {}
    for shackle in given.cage.shackles:
        ours, level_1 = (
            predict_statistic(one, "maximum", shackle.bridle)[0] for one in (best, low)
        )
        found = {
            OURS: np.where(np.isfinite(ours), ours, level_1),
            LOW: level_1,
            MEAN_ALONE: low.mean.mean[:, shackle.bridle],
            SEA_REGRESSION: _regress_on_sea(given, shackle.name, water),
        }
        for name, one in found.items():
            rows.setdefault(name, []).append(one / 1e3)
    return {name: {"peak_kn": np.column_stack(parts)} for name, parts in rows.items()}


def _regress_on_sea(given: Given, shackle: str, water: Metocean) -> Float[np.ndarray, " sea"]:
    """Largest loads by least squares of their logarithms on the sea state [N]."""
    windows = sensor_windows(align(given.waves, shackle))
    assert windows is not None
    # In the shortest waves no largest value is known between readings.
    windows = windows.rows(windows.maximum > 0.0)
    return np.exp(regress_on_sea(windows.metocean, np.log(windows.maximum), water))
