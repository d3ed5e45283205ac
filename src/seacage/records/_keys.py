"""The quantities that streams carry: their door keys, units and CF names."""

from collections.abc import Mapping
from dataclasses import dataclass

from seacage.conventions import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Key:
    """A quantity at the door: its unit is in its name.

    Parameters
    ----------
    name
        As in JSON, MQTT and column names: ``tension_kn``.
    unit
        As people write it.
    cf_unit, standard_name
        As CF-1.11 spells them; the standard name is None where CF has none.
    long_name
        One line for a figure's axis.
    """

    name: str
    unit: str
    cf_unit: str
    standard_name: str | None
    long_name: str


KEYS: Mapping[str, Key] = {
    key.name: key
    for key in (
        Key(
            name="current_speed_m_s",
            unit="m/s",
            cf_unit="m s-1",
            standard_name="sea_water_speed",
            long_name="Current speed",
        ),
        Key(
            name="current_to_deg",
            unit="deg",
            cf_unit="degree",
            standard_name="sea_water_velocity_to_direction",
            long_name="Direction the current goes to, clockwise from true north",
        ),
        Key(
            name="hs_m",
            unit="m",
            cf_unit="m",
            standard_name="sea_surface_wave_significant_height",
            long_name="Significant wave height",
        ),
        Key(
            name="tp_s",
            unit="s",
            cf_unit="s",
            standard_name="sea_surface_wave_period_at_variance_spectral_density_maximum",
            long_name="Peak period",
        ),
        Key(
            name="wave_from_deg",
            unit="deg",
            cf_unit="degree",
            standard_name="sea_surface_wave_from_direction",
            long_name="Direction the waves come from, clockwise from true north",
        ),
        Key(
            name="tension_kn",
            unit="kN",
            cf_unit="kN",
            standard_name=None,
            long_name="Tension of a bridle, by its shackle",
        ),
        Key(
            name="depth_m",
            unit="m",
            cf_unit="m",
            standard_name="depth",
            long_name="Depth of a sensor on the net below still water",
        ),
    )
}
"""Every quantity that a sample or a record may carry, by its door key."""

DIRECTIONS = frozenset(name for name, key in KEYS.items() if key.unit == "deg")
"""The keys whose 360 degrees is 0."""


def check_keys(names: Mapping[str, object], *, where: str) -> None:
    """Refuse a key that no quantity has.

    Raises
    ------
    InputError
        At the first unknown key.
    """
    if not KEYS.keys() >= names.keys():
        unknown = next(name for name in names if name not in KEYS)
        raise InputError(
            f"{where}: no quantity has the key {unknown!r}. "
            f"The keys, with their units, are {', '.join(KEYS)}."
        )
