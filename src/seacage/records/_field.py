"""A buoy and the sensors on one cage: what a twin learns its upper level from."""

from collections.abc import Mapping
from dataclasses import dataclass

from seacage.conventions import InputError, Origin
from seacage.records._record import Record

_CURRENT = ("current_speed_m_s", "current_to_deg")
_SENSOR = (("tension_kn",), ("depth_m",))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FieldRecord:
    """A buoy and the shackles and depth sensors on one cage, over one time.

    Parameters
    ----------
    cage
        The cage's name.
    buoy
        Carries the current at least; waves where it measures them.
    sensors
        By their names in the cage's file; each carries ``tension_kn`` (a shackle) or
        ``depth_m`` (a depth sensor). Each keeps its own times.
    origin
        How the sensors' numbers were made.
    hidden_sha256
        Of the hidden parameters behind a virtual field; None where it was measured.
    notes
        What the maker noticed, one sentence each.

    Raises
    ------
    InputError
        A buoy without a current, a sensor with other quantities or under another's name.
    """

    cage: str
    buoy: Record
    sensors: Mapping[str, Record]
    origin: Origin
    hidden_sha256: str | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not self.buoy.values.keys() >= set(_CURRENT):
            raise InputError(
                f"{self.buoy.stream}: a field record's buoy carries {' and '.join(_CURRENT)}, "
                f"this one {', '.join(self.buoy.values)}. Map the current's columns too."
            )
        for name, sensor in self.sensors.items():
            if sensor.stream != name:
                raise InputError(
                    f"The sensor {name!r} holds the stream {sensor.stream!r}. "
                    "Name each sensor as its stream."
                )
            if tuple(sensor.values) not in _SENSOR:
                raise InputError(
                    f"{name}: a sensor carries tension_kn or depth_m, alone; "
                    f"this one {', '.join(sensor.values) or 'nothing'}."
                )
        object.__setattr__(self, "sensors", dict(self.sensors))
