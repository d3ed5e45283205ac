"""Names, units, axes, errors and codes that every room shares."""

from seacage.conventions._codes import RESULTS, Flag, Result
from seacage.conventions._constants import GRAVITY, WATER_DENSITY, WATER_VISCOSITY
from seacage.conventions._directions import compass, folded, towards
from seacage.conventions._errors import InputError, ModelError, RecordError, SeacageError
from seacage.conventions._origin import Origin
from seacage.conventions._progress import Progress, unheard

__all__ = [
    "GRAVITY",
    "RESULTS",
    "WATER_DENSITY",
    "WATER_VISCOSITY",
    "Flag",
    "InputError",
    "ModelError",
    "Origin",
    "Progress",
    "RecordError",
    "Result",
    "SeacageError",
    "compass",
    "folded",
    "towards",
    "unheard",
]
