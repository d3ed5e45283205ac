"""The quantities that streams carry: their door keys, units and CF names."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

from seacage.conventions import InputError

T = TypeVar("T")

CURRENT = ("current_speed_m_s", "current_to_deg")  # keys of a current at no stated depth


@dataclass(frozen=True, slots=True)
class Key:
    """A quantity at the door: its unit is in its name."""

    name: str  # as in JSON, MQTT and column names: ``tension_kn``
    unit: str  # as people write it
    # As CF-1.11 spells them; the standard name is None where CF has none
    cf_unit: str
    standard_name: str | None
    long_name: str  # one line for a figure's axis


KEYS: Mapping[str, Key] = {
    key.name: key
    for key in (
        Key("current_speed_m_s", "m/s", "m s-1", "sea_water_speed", "Current speed"),
        Key(
            "current_to_deg",
            "deg",
            "degree",
            "sea_water_velocity_to_direction",
            "Direction the current goes to, clockwise from true north",
        ),
        Key("hs_m", "m", "m", "sea_surface_wave_significant_height", "Significant wave height"),
        Key(
            "tp_s",
            "s",
            "s",
            "sea_surface_wave_period_at_variance_spectral_density_maximum",
            "Peak period",
        ),
        Key(
            "wave_from_deg",
            "deg",
            "degree",
            "sea_surface_wave_from_direction",
            "Direction the waves come from, clockwise from true north",
        ),
        Key("tension_kn", "kN", "kN", None, "Tension of a bridle, by its shackle"),
        Key("depth_m", "m", "m", "depth", "Depth of a sensor on the net below still water"),
    )
}
"""Every quantity that a sample or a record may carry, by its door key."""

_BIN = re.compile(r"(current_(?:speed|to))_((?:0|[1-9]\d{0,2})(?:\.\d)?)m(_m_s|_deg)")


def bin_keys(depth: float) -> tuple[str, str]:
    """Keys of the speed and the direction of the current at a depth [m], in steps of 0.1 m."""
    return f"current_speed_{depth:.4g}m_m_s", f"current_to_{depth:.4g}m_deg"


def keys_at(depth: float, values: Mapping[str, T]) -> dict[str, T]:
    """The current among some values, by its keys at a depth [m]; others are left out."""
    keys = zip(CURRENT, bin_keys(round(depth, 1)), strict=True)
    return {key: values[one] for one, key in keys if one in values}


def key_of(name: str) -> Key | None:
    """The quantity of a door key, at a depth or none; None where no quantity has the key."""
    found = _BIN.fullmatch(name)
    if found is None or (known := KEYS.get(found[1] + found[3])) is None:
        return KEYS.get(name)
    return replace(known, name=name, long_name=f"{known.long_name}, at {found[2]} m")


def plain_key(name: str) -> str:
    """The key of a quantity without its depth."""
    found = _BIN.fullmatch(name)
    return name if found is None else found[1] + found[3]


def depth_of(name: str) -> float | None:
    """The depth in a key [m]; None where it has none."""
    found = _BIN.fullmatch(name)
    return None if found is None else float(found[2])


def current_bins(names: Iterable[str]) -> tuple[float, ...]:
    """Depths at which some keys have a current, speed and direction, ascending [m]."""
    there = set(names)
    depths = {float(found[2]) for name in there if (found := _BIN.fullmatch(name))}
    return tuple(sorted(depth for depth in depths if there.issuperset(bin_keys(depth))))


def is_direction(name: str) -> bool:
    """Whether a key is of a direction, whose 360 degrees is 0."""
    return name.endswith("_deg")


NO_MEAN_PERIOD = (
    "This is a mean period, and tp_s is the peak period, some 1.2 to 1.4 times as long. Give the "
    "peak period, or leave the period out: a twin takes Tp as it is distributed at the same Hs."
)
"""Why a mean wave period is not taken for the peak period, and what to do."""
_MEAN_PERIOD = re.compile(
    r"(apd|mwp|t_?[zae]|t_?av|v?t_?m_?-?[012]{0,3}|t0?[12]|vtza)(_s)?"
    r"|.*(mean|average|zero|energy|upcross).*period.*|.*period.*(mean|average|zero|first|second).*",
    re.IGNORECASE,
)


def is_mean_period(name: str) -> bool:
    """Whether a column or a variable has the name of a mean wave period, such as Tz or tm02."""
    return _MEAN_PERIOD.fullmatch(name.strip()) is not None


def check_keys(names: Mapping[str, object], *, where: str) -> None:
    """Refuse a key that no quantity has. Raises InputError: at the first unknown key."""
    if KEYS.keys() >= names.keys():
        return
    unknown = next((name for name in names if key_of(name) is None), None)
    if unknown is not None:
        raise InputError(
            f"{where}: no quantity has the key {unknown!r}. "
            f"The keys, with their units, are {', '.join(KEYS)}, and of a current at a depth "
            f"{' and '.join(bin_keys(5.0))}."
            f"{' ' + NO_MEAN_PERIOD if is_mean_period(unknown) else ''}"
        )
