"""Tangent plane of a cage: latitude and longitude against its own east and north."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError

PerPoint = Float[np.ndarray, " point"]
Point3 = Float[np.ndarray, "point 3"]
EQUATOR_RADIUS = 6378137.0  # of the WGS84 ellipsoid [m]
FLATTENING = 1.0 / 298.257223563  # of the WGS84 ellipsoid [-]
REACH = 5000.0  # farthest from the cage that positions are turned into metres [m]
_ECCENTRICITY2 = FLATTENING * (2.0 - FLATTENING)
_ROUNDS = 4  # of Newton's way back; each squares an error of metres in thousands of kilometres


@dataclass(frozen=True, slots=True, kw_only=True)
class TangentPlane:
    """The plane that touches the WGS84 ellipsoid at a cage's centre.

    A place at a latitude, longitude and depth lies east and north of the centre where the sea's
    surface above it does, and as far below the still water as it is deep. Against the straight
    axes x, y, z this leaves out the Earth's roundness: at a distance d, sideways depth · d / R
    (8 mm at 31 m and 1.6 km), upwards d² / 2R (5 mm at 250 m, 8 cm at 1 km). Tides and the
    geoid are left out: a depth is below the water as it stands.

    ``latitude``, ``longitude``: of the centre, WGS84 [deg].
    """

    latitude: float
    longitude: float

    def local(self, latitude: PerPoint, longitude: PerPoint, depth: PerPoint) -> Point3:
        """East, north and up of places at a latitude, a longitude [deg] and a depth [m]."""
        centre = _on_ellipsoid(np.array([self.latitude]), np.array([self.longitude]))
        away = _on_ellipsoid(latitude, longitude) - centre
        east, north, _ = (away @ self._axes.T).T
        return self._near(np.column_stack([east, north, -depth]))

    def geographic(self, position: Point3) -> tuple[PerPoint, PerPoint, PerPoint]:
        """Latitude, longitude [deg] and depth [m] of places east, north and up of the centre."""
        position = self._near(position)
        latitude = np.full(len(position), self.latitude)
        longitude = np.full(len(position), self.longitude)
        phi = math.radians(self.latitude)
        root = math.sqrt(1.0 - _ECCENTRICITY2 * math.sin(phi) ** 2)
        # Radii of the meridian's curve and of the parallel [m]
        meridian = EQUATOR_RADIUS * (1.0 - _ECCENTRICITY2) / root**3
        parallel = EQUATOR_RADIUS * math.cos(phi) / root
        for _ in range(_ROUNDS):
            miss = position - self.local(latitude, longitude, -position[:, 2])
            latitude = latitude + np.rad2deg(miss[:, 1] / meridian)
            longitude = longitude + np.rad2deg(miss[:, 0] / parallel)
        return latitude, (longitude + 180.0) % 360.0 - 180.0, -position[:, 2]

    @property
    def _axes(self) -> Float[np.ndarray, "3 3"]:
        """East, north and up at the centre, in the Earth's own axes."""
        phi, lam = math.radians(self.latitude), math.radians(self.longitude)
        (sin_phi, cos_phi), (sin_lam, cos_lam) = ((math.sin(a), math.cos(a)) for a in (phi, lam))
        east, north = [-sin_lam, cos_lam, 0.0], [-sin_phi * cos_lam, -sin_phi * sin_lam, cos_phi]
        return np.array([east, north, [cos_phi * cos_lam, cos_phi * sin_lam, sin_phi]])

    def _near(self, position: Point3) -> Point3:
        far = np.hypot(position[:, 0], position[:, 1])
        if (far > REACH).any():
            raise InputError(
                f"TangentPlane: a point is {far.max() / 1e3:.1f} km from the cage at "
                f"{self.latitude:.5f}, {self.longitude:.5f} deg; {REACH / 1e3:g} km is the limit. "
                "Check that latitude and longitude are not exchanged."
            )
        return position


def _on_ellipsoid(latitude: PerPoint, longitude: PerPoint) -> Point3:
    phi, lam = np.deg2rad(latitude), np.deg2rad(longitude)
    across = EQUATOR_RADIUS / np.sqrt(1.0 - _ECCENTRICITY2 * np.sin(phi) ** 2)
    parallel, up = across * np.cos(phi), across * (1.0 - _ECCENTRICITY2) * np.sin(phi)
    return np.column_stack([parallel * np.cos(lam), parallel * np.sin(lam), up])
