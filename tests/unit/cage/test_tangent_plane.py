import numpy as np
import pytest

from seacage.cage import Cage, TangentPlane
from seacage.conventions import InputError

PLANE = TangentPlane(latitude=63.5, longitude=8.2)


def placed(latitude: float, longitude: float) -> Cage:
    return Cage.named("ace").altered(site={"latitude_deg": latitude, "longitude_deg": longitude})


def test_the_centre_is_the_origin_and_depth_is_downwards():
    there = PLANE.local(np.array([63.5]), np.array([8.2]), np.array([12.0]))
    np.testing.assert_allclose(there, [[0.0, 0.0, -12.0]], atol=1e-9)


def test_a_minute_of_latitude_is_a_nautical_mile_and_one_of_longitude_less_by_the_cosine():
    # From the ellipsoid's radii of curvature there.
    phi, e2 = np.deg2rad(63.5), 0.00669437999014
    root = np.sqrt(1.0 - e2 * np.sin(phi) ** 2)
    minute = np.deg2rad(1.0 / 60.0) * 6378137.0
    expected = [minute * np.cos(phi) / root, minute * (1.0 - e2) / root**3]
    east, north = (
        PLANE.local(np.array([63.5 + up]), np.array([8.2 + along]), np.zeros(1))[0]
        for up, along in ((0.0, 1.0 / 60.0), (1.0 / 60.0, 0.0))
    )
    # A mile of arc and its chord's shadow on the plane differ by 2 cm at most.
    np.testing.assert_allclose([east[0], north[1]], expected, atol=0.05)
    assert east[0] / north[1] == pytest.approx(np.cos(phi), rel=0.01)


@pytest.mark.parametrize("latitude", [-63.5, 0.0, 35.0, 89.0])
@pytest.mark.parametrize("longitude", [-180.0, 8.2, 179.999])
def test_there_and_back_is_the_same_place(latitude, longitude):
    plane = TangentPlane(latitude=latitude, longitude=longitude)
    position = np.random.default_rng(0).uniform([-900, -900, -40], [900, 900, 0], (50, 3))
    again = plane.local(*plane.geographic(position))
    np.testing.assert_allclose(again, position, atol=1e-6)


def test_a_place_far_from_the_cage_is_refused():
    with pytest.raises(InputError, match="exchanged"):
        PLANE.local(np.array([8.2]), np.array([63.5]), np.zeros(1))


def test_a_cage_file_may_say_where_it_lies_and_one_that_does_not_is_as_it_was():
    cage = placed(63.5, -8.2)
    assert Cage.from_toml(cage.to_toml()) == cage
    assert cage.plane == TangentPlane(latitude=63.5, longitude=-8.2)
    assert "latitude" not in Cage.named("ace").to_toml()
    with pytest.raises(InputError, match="latitude_deg and longitude_deg"):
        _ = Cage.named("ace").plane


@pytest.mark.parametrize("site", [{"latitude_deg": 63.5}, {"longitude_deg": 8.2}])
def test_half_a_position_is_refused(site):
    with pytest.raises(InputError, match="both or none"):
        Cage.named("ace").altered(site=site)


@pytest.mark.parametrize("place", [(90.0, 0.0), (-91.0, 0.0), (10.0, 181.0)])
def test_a_position_off_the_earth_is_refused(place):
    with pytest.raises(InputError, match="latitude_deg"):
        placed(*place)
