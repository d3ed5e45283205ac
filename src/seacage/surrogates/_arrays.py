"""A fitted model as plain settings and named arrays, and the checks on the way back."""

from collections.abc import Mapping
from typing import TypeVar

import numpy as np

from seacage.conventions import ModelError

Settings = dict[str, object]
"""Values that JSON can hold."""

Arrays = dict[str, np.ndarray]
"""Float64 arrays by name."""

Kind = TypeVar("Kind")


def setting(settings: Mapping[str, object], name: str, kind: type[Kind]) -> Kind:
    """One setting of the kind that the model needs.

    Raises ModelError: missing, or of another kind.
    """
    value = settings.get(name)
    if not isinstance(value, kind):
        raise ModelError(
            f"The saved model's setting {name!r} is {value!r}, not of kind {kind.__name__}. "
            "The file is damaged or of another version. Train the model again."
        )
    return value


def setting_list(settings: Mapping[str, object], name: str, kind: type[Kind]) -> tuple[Kind, ...]:
    """Entries of a list among the settings, each of the kind that the model needs."""
    return tuple(setting({name: one}, name, kind) for one in setting(settings, name, list))


def array(arrays: Mapping[str, np.ndarray], name: str, *shape: int | None) -> np.ndarray:
    """One array of the shape that the model needs; None accepts any length of at least 1.

    Raises ModelError: missing, not float64, of another shape, or with a number that is not finite.
    """
    values = arrays.get(name)
    if values is None:
        raise ModelError(f"The saved model has no array {name!r}. Train the model again.")
    fits = values.ndim == len(shape) and all(
        have == want if want is not None else have > 0
        for have, want in zip(values.shape, shape, strict=True)
    )
    if values.dtype != np.float64 or not fits or not np.isfinite(values).all():
        expected = ", ".join("any" if length is None else str(length) for length in shape)
        raise ModelError(
            f"The saved model's array {name!r} is {values.dtype} {values.shape}; expected finite "
            f"float64 ({expected}). The file is damaged. Train the model again."
        )
    # Conditioning wants C order, and an array read from a file may be read-only or misaligned.
    return np.require(values, requirements=["C", "A"])
