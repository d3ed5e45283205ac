"""A family of hidden cages and waters: one drawn for each number."""

import hashlib
import json
from typing import Any, Literal, get_args

import numpy as np

from seacage.conventions import InputError, read_packaged_table

Water = Literal["tame", "coastal", "shallow"]
"""Water of a truth: as on the shelf, or as an ADCP measured it."""
WATERS: tuple[Water, ...] = get_args(Water)
"""Waters of the family of truths."""


def draw_truth(
    table: dict[str, Any], number: int, water: str, *, unseal: bool
) -> tuple[dict[str, Any], str]:
    """The table of hidden parameters with what is drawn by a number, and the family's SHA-256.

    Raises InputError: a number or a water that is none, or a sealed number without ``unseal``.
    """
    family = read_packaged_table("seacage.campaigns._virtual_field", "family.toml")
    _check_number(number, family["numbers"] | family.pop("later"), unseal=unseal)
    if water not in WATERS:
        raise InputError(f"Truth {number}: water {water!r} is none of {', '.join(WATERS)}.")
    if water != "shallow":
        del family["water"]["shallow"]  # came later, and changes the identity of no other truth
    outside = family["outside"].get(str(number), {})
    drawn = {**table, "seed": number}
    for part in (family["cage"], family["water"][water], outside):
        drawn = _over(drawn, part, number, "")
    return drawn, hashlib.sha256(json.dumps(family, sort_keys=True).encode()).hexdigest()


def _check_number(number: int, numbers: dict[str, list[int]], *, unseal: bool) -> None:
    kind = next((k for k, (first, last) in numbers.items() if first <= number <= last), None)
    known = ", ".join(f"{first} to {last} ({kind})" for kind, (first, last) in numbers.items())
    if kind is None:
        raise InputError(f"Truth {number} does not exist; there are {known}.")
    if kind == "sealed" and not unseal:
        raise InputError(
            f"Truth {number} is sealed, so that no setting is fitted to it. Take one of {known}, "
            "or unseal it for a judgement that is the last."
        )


def _over(base: dict[str, Any], part: dict[str, Any], number: int, where: str) -> dict[str, Any]:
    """A table with the keys of another drawn over its own."""
    found = dict(base)
    for key, value in part.items():
        name = f"{where}{key}"
        if isinstance(value, dict) and not value.keys() & {"between", "one_of"}:
            found[key] = _over(base.get(key, {}), value, number, f"{name}.")
        else:
            found[key] = _draw(value, np.random.default_rng([number, *name.encode()]))
    return found


def _draw(value: Any, rng: np.random.Generator) -> Any:
    """One value of a distribution, or what is none as it is."""
    if not isinstance(value, dict):
        return value
    if "one_of" in value:
        return value["one_of"][rng.integers(len(value["one_of"]))]
    if "at_most" in value:
        count = rng.integers(value["at_most"], endpoint=True)
        return sorted(rng.uniform(*value["between"], size=count).tolist())
    return float(rng.uniform(*value["between"]))
