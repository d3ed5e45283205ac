"""The quantities that streams carry: their door keys, units and CF names."""

import re
from collections.abc import Mapping
from dataclasses import dataclass

from seacage.conventions import InputError


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

# The keys whose 360 degrees is 0
DIRECTIONS = frozenset(name for name, key in KEYS.items() if key.unit == "deg")


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
    if not KEYS.keys() >= names.keys():
        unknown = next(name for name in names if name not in KEYS)
        raise InputError(
            f"{where}: no quantity has the key {unknown!r}. "
            f"The keys, with their units, are {', '.join(KEYS)}."
            f"{' ' + NO_MEAN_PERIOD if is_mean_period(unknown) else ''}"
        )
