"""A panel of netting in a flume, and the laws that say how it is loaded."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from seacage.conventions import WATER_DENSITY, WATER_VISCOSITY, InputError
from seacage.dynamics import aarsnes, kristiansen_faltinsen, loland
from seacage.dynamics._parts._assembly import Panels
from seacage.dynamics._physics._motion import NetLaw, twine_load


@dataclass(frozen=True, slots=True, kw_only=True)
class Panel:
    """A flat net in a frame.

    Attributes
    ----------
    twine_diameter, half_mesh
        Of the clean net [m].
    area
        Of the panel [m2]; only forces ask for it.
    solidity
        Of a net with growth; None: that of its twines [-].
    water_density
        [kg/m3].
    """

    twine_diameter: float
    half_mesh: float
    area: float
    solidity: float | None
    water_density: float

    @property
    def own_solidity(self) -> float:
        """As given, or 2d/l − (d/l)² [-]."""
        ratio = self.twine_diameter / self.half_mesh
        return 2.0 * ratio - ratio**2 if self.solidity is None else self.solidity


class PanelLaw(Protocol):
    """Drag and lift on the panel's area by solidity and by cosine of its normal to the flow."""

    def __call__(
        self, solidity: float, cosine: float, *, speed: float, half_mesh: float
    ) -> tuple[float, float]: ...


def _plain(law: Callable[[float, float], tuple[object, object]]) -> PanelLaw:
    def coefficients(
        solidity: float,
        cosine: float,
        *,
        speed: float,  # noqa: ARG001
        half_mesh: float,  # noqa: ARG001
    ) -> tuple[float, float]:
        cd, cl = law(solidity, cosine)
        return float(cd), float(cl)  # pyright: ignore[reportArgumentType]

    return coefficients


def _diameter(solidity: float, half_mesh: float) -> float:
    """Of the twine that alone would give a solidity [m]."""
    return half_mesh * (1.0 - math.sqrt(1.0 - solidity))


def _by_reynolds(
    solidity: float, cosine: float, *, speed: float, half_mesh: float
) -> tuple[float, float]:
    diameter = _diameter(solidity, half_mesh)
    reynolds = diameter * speed / (WATER_VISCOSITY * (1.0 - solidity))
    cd, cl = kristiansen_faltinsen(solidity, cosine, reynolds)
    return float(cd), float(cl)


def _twines(
    solidity: float, cosine: float, *, speed: float, half_mesh: float
) -> tuple[float, float]:
    """Twine by twine, one family of twines across the flow and one turned with the panel."""
    one, share = np.ones(1), np.full((1, 4), 0.25)
    panels = Panels(
        corners=np.array([[0, 1, 2, 3]]),
        share=share,
        solidity=solidity * one,
        twine_diameter=_diameter(solidity, half_mesh) * one,
        outward=np.array([[1.0, 0.0]]),
        half_width=one,
        depth=one,
        area=one,
        outline=one,
        twine_spacing=half_mesh * one,
        diamond=np.zeros(1, dtype=bool),
    )
    sine = math.sqrt(max(1.0 - cosine**2, 0.0))
    # a square metre, its normal turned from the flow (x) upwards, by θ
    corners = np.array([[0, 0, 0], [0, 1, 0], [-sine, 1, cosine], [-sine, 0, cosine]])
    law = NetLaw(name="morison", wake=np.ones((1, 1)))
    past = np.array([[[speed, 0.0, 0.0]]])
    load = twine_load(panels, law, corners[None].astype(float), past)[0, 0]
    drag, _, lift = load / (0.5 * WATER_DENSITY * max(speed, 1e-9) ** 2)
    return float(drag), float(lift)


PANEL_LAWS: dict[str, PanelLaw] = {
    "aarsnes": _plain(aarsnes),
    "loland": _plain(loland),
    "kristiansen-faltinsen": _by_reynolds,
    "morison": _twines,
}

KEYS = {
    "twine_diameter_m": True,
    "half_mesh_m": True,
    "area_m2": False,
    "solidity": False,
    "water_density_kg_m3": False,
}
"""Keys of [panel], and whether they are needed."""


def panel_of(table: dict[str, object], where: str) -> Panel:
    """A panel from the table of a case.

    Raises
    ------
    InputError
        A key that is unknown, missing or not above 0.
    """
    for key in table:
        if key not in KEYS:
            raise InputError(
                f"{where}: [panel] key {key!r} is unknown; known are: {', '.join(KEYS)}."
            )
    for key, needed in KEYS.items():
        value = table.get(key)
        if needed and value is None:
            raise InputError(f"{where}: [panel] key {key!r} is missing. Add it.")
        if value is not None and not (isinstance(value, int | float) and value > 0.0):
            raise InputError(f"{where}: [panel] {key} = {value!r} must be a number above 0.")
    numbers = {key: float(str(value)) for key, value in table.items()}
    return Panel(
        twine_diameter=numbers["twine_diameter_m"],
        half_mesh=numbers["half_mesh_m"],
        area=numbers.get("area_m2", 1.0),
        solidity=numbers.get("solidity"),
        water_density=numbers.get("water_density_kg_m3", 1000.0),
    )
