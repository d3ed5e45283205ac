import numpy as np
import pytest

from seacage.conventions import Flag, Origin
from seacage.ocean import SeaState
from seacage.records import Record
from seacage.twin import Metocean


def test_a_sea_state_becomes_vectors_of_one_row():
    sea = SeaState(current_speed=0.5, current_to=90.0, hs=1.2, wave_from=270.0)
    water = Metocean.of(sea)
    assert water.current_velocity == pytest.approx(np.array([[0.5, 0.0]]))
    assert water.wave_direction == pytest.approx(np.array([[1.0, 0.0]]))
    assert len(water) == 1


def test_the_features_of_the_current_have_no_seam_at_north():
    west = Metocean.of(SeaState(current_speed=0.4, current_to=359.99)).features(("current",))
    east = Metocean.of(SeaState(current_speed=0.4, current_to=0.01)).features(("current",))
    assert west == pytest.approx(east, abs=1e-3)


def test_the_features_of_the_waves_are_their_height_and_its_vector():
    water = Metocean.of(SeaState(current_speed=0.0, current_to=0.0, hs=2.0, wave_from=180.0))
    assert water.features(("current", "waves"))[0, 3:] == pytest.approx([2.0, 0.0, 2.0])


def test_a_value_that_failed_its_check_is_not_known():
    record = Record(
        stream="buoy-1",
        time=np.array(["2020-01-01T00:00", "2020-01-01T00:12"], dtype="datetime64[us]"),
        values={
            "current_speed_m_s": np.array([0.3, 0.4]),
            "current_to_deg": np.array([412.0, 90.0]),
        },
        flags={"current_to_deg": np.array([Flag.FAIL, Flag.GOOD])},
        origin=Origin.MEASURED,
    )
    water = Metocean.of_record(record)
    assert water.known(("current",)).tolist() == [False, True]
    assert not water.known(("current", "waves")).any()


def test_limited_water_is_milder_and_keeps_its_direction():
    seas = [
        SeaState(current_speed=1.5, current_to=135.0, hs=4.0, wave_from=30.0),
        SeaState(current_speed=0.0, current_to=0.0, hs=0.5, wave_from=30.0),
    ]
    water = Metocean.of(seas)
    milder = water.limited(current_speed=1.0, hs=3.0)
    assert milder.current_velocity[0] == pytest.approx(water.current_velocity[0] / 1.5)
    assert milder.current_velocity[1] == pytest.approx([0.0, 0.0])
    assert milder.hs.tolist() == [3.0, 0.5]
    assert milder.wave_direction == pytest.approx(water.wave_direction)


def test_the_same_water_is_known_again_also_where_nobody_knows_its_waves():
    def water(speed, **rest):
        columns = {"current_speed_m_s": speed, "current_to_deg": 90.0, **rest}
        return Metocean.from_columns({key: np.array([v]) for key, v in columns.items()}, 1)

    assert water(0.5).same(water(0.5))
    assert not water(0.5).same(water(0.51))
    assert not water(0.5).same(water(0.5, hs_m=1.0))
