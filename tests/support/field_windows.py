"""Windows of a made-up field, for tests of what is computed from them."""

import numpy as np

from seacage.cage import Cage
from seacage.conventions import compass
from seacage.studies._fidelity._windows import Sensors, Windows
from seacage.twin import Metocean

CAGE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
START = np.datetime64("2020-01-18T00:00", "us")


def make_windows(*, days: int = 16, each: int = 12, seed: int = 0) -> Windows:
    """Windows in a turning tide; the low fidelity answers by a formula, and so does the truth."""
    count = days * each
    rng = np.random.default_rng(seed)
    velocity = rng.normal(scale=0.4, size=(count, 2))
    sensors = Sensors(cage=CAGE, rest=np.zeros(len(CAGE.sensor_names)))
    low = answers(velocity, len(sensors.names))
    return Windows(
        sensors=sensors,
        end=START + (np.arange(1, count + 1) * (86400e6 / each)).astype("timedelta64[us]"),
        water=Metocean.without_waves(velocity),
        surveyed=np.ones(count, bool),
        truth=1.5 * low + rng.normal(scale=0.1, size=low.shape),
        low=low,
    )


def answers(velocity: np.ndarray, sensors: int) -> np.ndarray:
    """Responses that grow with the square of the speed, each strongest in its own direction."""
    speed = np.linalg.norm(velocity, axis=1)
    own = np.arange(sensors) * 360.0 / sensors
    facing = 1.0 + 0.5 * np.cos(np.deg2rad(compass(velocity)[:, None] - own))
    return 4.0 * speed[:, None] ** 2 * facing
