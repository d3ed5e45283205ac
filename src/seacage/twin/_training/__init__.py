"""Training: level 1 from a campaign, level 2 from sensors, intervals from held-out readings."""

from seacage.twin._training._data import Training
from seacage.twin._training._loads import representative_lines
from seacage.twin._training._train import train, update
from seacage.twin._training._windows import Windows, sensor_windows

__all__ = ["Training", "Windows", "representative_lines", "sensor_windows", "train", "update"]
