"""A virtual ADCP, and a settled cage that feels the shear that it measures."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.campaigns import TruthParameters, generated_current
from seacage.campaigns._virtual_field._adcp import (
    BINS,
    Place,
    bins_of_settled,
    bins_of_simulated,
    with_bins,
)
from seacage.campaigns._virtual_field._responses import Responses
from seacage.campaigns._virtual_field._weather import (
    Even,
    current_at_cage,
    shear,
    true_weather,
    water_chance,
)
from seacage.ocean import current_modes
from seacage.records import current_bins

BUOY = generated_current(3, start=datetime(2020, 1, 18, tzinfo=UTC), days=10.0)
HIDDEN = TruthParameters.of_family(3, water="coastal")
SECONDS = np.arange(0.0, 10.0 * 86400.0, 60.0)


def settled_modes(place: Place) -> tuple[np.ndarray, np.ndarray]:
    """Mean and shear that an ADCP without errors would see, and those at the cage."""
    surface = current_at_cage(BUOY, SECONDS, hidden=HIDDEN, rng=np.random.default_rng(3))
    sheared = shear(HIDDEN.profile, len(SECONDS), 60.0, seed=3)
    at_cage = tuple(Even(step=60.0, values=one) for one in (surface + 0.5 * sheared, sheared))
    bins = bins_of_settled(
        BUOY, place, at_cage, hidden=HIDDEN, rng=np.random.default_rng(3), seed=3
    )
    second = (BUOY.time - BUOY.time[0]) / np.timedelta64(1, "s")
    return np.hstack(current_modes(BINS, bins)), np.hstack([one.at(second) for one in at_cage])


def test_an_adcp_at_the_cage_sees_the_current_that_the_cage_feels() -> None:
    seen, felt = settled_modes("cage")
    np.testing.assert_allclose(seen, felt, atol=1e-9)


def test_an_adcp_at_the_buoy_sees_most_of_the_shear_and_sees_it_before_the_cage() -> None:
    seen, felt = settled_modes("buoy")
    alike = np.corrcoef(seen[:, 2], felt[:, 2])[0, 1]
    assert 0.6 < alike < 0.99
    # what has arrived by the time that the water takes is more alike than what is there now
    later = np.corrcoef(seen[:-1, 2], felt[1:, 2])[0, 1]
    assert later > alike


def test_a_bin_has_noise_a_compass_that_is_off_and_gaps() -> None:
    velocity = np.tile([0.3, 0.4], (len(BUOY), len(BINS), 1))
    record = with_bins(BUOY, velocity, seed=5)
    assert current_bins(record.values) == tuple(BINS.tolist())
    speed, to = record.values["current_speed_15m_m_s"], record.values["current_to_15m_deg"]
    missing = np.isnan(speed)
    assert missing.mean() == pytest.approx(0.03, abs=0.02)
    assert np.all(record.flags["current_speed_15m_m_s"][missing] == 9)
    assert speed[~missing].std() == pytest.approx(0.015, rel=0.2)
    assert 0.01 < abs(to[~missing].mean() - 36.87) < 8.0
    for key in BUOY.values:  # what the buoy said is left as it was
        np.testing.assert_array_equal(record.values[key], BUOY.values[key])
        np.testing.assert_array_equal(record.flags[key], BUOY.flags[key])


@pytest.mark.parametrize("place", ["buoy", "cage"])
def test_beside_a_simulated_cage_the_bins_are_those_of_its_weather(place: Place) -> None:
    buoy = BUOY.rows(slice(0, 40))
    weather = true_weather(buoy, None, hidden=HIDDEN, seed=3, every_s=60.0)
    rng = water_chance(3)[0]
    bins = bins_of_simulated(buoy, place, weather, hidden=HIDDEN, rng=rng, seed=3)
    assert bins.shape == (40, len(BINS), 2)
    if place == "cage":
        levels = weather.current(0.0)
        for axis in (0, 1):
            own = np.interp(BINS, weather.level_depth, levels[:, axis])
            np.testing.assert_allclose(bins[0, :, axis], own)


def test_answers_are_linear_in_the_shear() -> None:
    grid = {
        "speed": np.array([0.0, 0.5, 1.0, 1.5]),
        "direction": np.deg2rad(np.arange(0.0, 360.0, 45.0)),
    }
    base = Responses(**grid, growth=np.array([0.0, 0.5, 1.0]), value=np.full((3, 4, 8, 1), 20.0))
    east, north = (
        Responses(**grid, growth=np.array([0.5]), value=np.full((1, 4, 8, 1), one))
        for one in (2.0, -3.0)
    )
    whole = replace(base, by_shear=(east, north))
    velocity, growth = np.array([[0.3, 0.1], [0.0, -0.7]]), np.array([0.2, 0.9])
    change = np.array([[0.1, 0.2], [0.0, 10.0]])
    found = whole.at(velocity, growth, shear=change)[:, 0]
    np.testing.assert_allclose(found, [20.0 + 0.2 - 0.6, 0.0])  # no sensor leaves the water
    np.testing.assert_allclose(whole.at(velocity, growth), base.at(velocity, growth))
