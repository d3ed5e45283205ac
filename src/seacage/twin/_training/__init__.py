"""Training: level 1 from a campaign, level 2 from sensors, intervals from held-out readings."""

from seacage.twin._training._data import Training
from seacage.twin._training._train import train, update

__all__ = ["Training", "train", "update"]
