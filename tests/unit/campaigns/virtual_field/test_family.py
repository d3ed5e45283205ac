"""Hidden cages and waters drawn by their number."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, generated_current, virtual_field
from seacage.campaigns._virtual_field._family import Water, draw_truth
from seacage.campaigns._virtual_field._weather import true_weather
from seacage.conventions import InputError, compass, has_answer
from seacage.dynamics import settle
from seacage.ocean import SeaState
from stand_in import StandIn

ACE = Cage.named("ace")
COARSE = ACE.altered(mesh={"spokes": 16})
NUMBERS = [*range(1, 61), *range(201, 205)]


def test_each_number_is_a_cage_of_its_own_and_always_the_same() -> None:
    truths = [TruthParameters.of_family(number) for number in NUMBERS]
    assert len({one.sha256 for one in truths}) == len(NUMBERS)
    assert len({one.true_cage(ACE, 1.0).to_toml() for one in truths}) == len(NUMBERS)
    assert TruthParameters.of_family(7) == truths[6]
    family = truths[:60]
    assert {one.law for one in family} == {"loland", "aarsnes"}
    assert {len(one.fouling.cleaned_days) for one in family} == {0, 1, 2}
    # Of 60 even draws the span misses a tenth of the range with a probability of 1 in 80.
    growth = [one.fouling.shallow_most for one in family]
    assert 0.06 <= min(growth) < 0.07
    assert 0.15 < max(growth) <= 0.16


def test_waters_of_one_number_meet_the_same_cage() -> None:
    tame, coastal = (TruthParameters.of_family(7, water=water) for water in ("tame", "coastal"))
    assert tame.true_cage(ACE, 0.5) == coastal.true_cage(ACE, 0.5)
    assert tame.current == coastal.current
    assert tame.profile.shear_sd_m_s == 0.0 < coastal.profile.shear_sd_m_s
    assert tame.sha256 != coastal.sha256


def test_a_sealed_truth_is_given_only_where_it_is_unsealed() -> None:
    with pytest.raises(InputError, match="Truth 103 is sealed, so that no setting is fitted to it"):
        TruthParameters.of_family(103)
    assert TruthParameters.of_family(103, unseal=True).title == "Truth 103, tame water."


@pytest.mark.parametrize("number", [0, 61, 111, 205, 401, -7])
def test_a_number_that_is_none_is_refused(number: int) -> None:
    with pytest.raises(InputError, match=rf"Truth {number} does not exist; there are 1 to 60"):
        TruthParameters.of_family(number, unseal=True)


def test_a_water_that_is_none_is_refused() -> None:
    with pytest.raises(InputError, match="'estuary' is none of tame, coastal, shallow"):
        draw_truth({}, 7, "estuary", unseal=False)


@pytest.mark.parametrize("number", [7, 19, 201, 202, 203, 204])
def test_truths_settle_wherever_a_cage_holds(number: int) -> None:
    hidden = TruthParameters.of_family(number)
    seas = [SeaState(current_speed=speed, current_to=70.0) for speed in (0.0, 0.3, 0.7)]
    for growth in (0.0, 1.0):
        found = settle(
            hidden.true_cage(COARSE, growth),
            seas,
            law=hidden.law,
            skin_friction=hidden.skin_friction,
            lift_factor=hidden.lift_factor,
        )
        assert has_answer(found.result).all()


def test_truths_outside_the_family_lie_beyond_its_ranges() -> None:
    law, sheared, frame, tube = (TruthParameters.of_family(number) for number in range(201, 205))
    assert (law.law, law.lift_factor) == ("kristiansen-faltinsen", 2.2)
    turns = np.sign(np.diff(sheared.profile.factor))
    assert turns.tolist() == [-1.0, 1.0, -1.0]
    corners = frame.true_cage(ACE, 0.0).frame.corners
    assert 1.0 < np.abs(corners - ACE.frame.corners).max() < 12.0
    built = tube.true_cage(ACE, 0.0)
    # Weight is lost from north on, 22 degrees clockwise; of a cage turned by 90 degrees, from east.
    for cage, light in ((built, 10.0), (replace(built, heading=90.0), 100.0)):
        seas = [SeaState(current_speed=0.4, current_to=light + side) for side in (0.0, 180.0)]
        ring = settle(cage, seas).node_position[:, cage.ring_nodes(cage.tube_ring)]
        assert ring[1, :, 2].max() > ring[0, :, 2].max() + 0.5
        highest = compass(ring[1, ring[1, :, 2].argmax(), :2])
        assert abs(highest - light) < 20.0


def test_a_net_that_is_fouled_when_the_record_begins_has_grown_before() -> None:
    clean = TruthParameters.read().fouling
    fouled = replace(clean, age_days=20.0)
    day = np.array([0.0, 3.0])
    np.testing.assert_allclose(fouled.grown(day), clean.grown(day + 20.0))
    later = np.array([30.0])  # after the first cleaning
    np.testing.assert_allclose(fouled.grown(later), clean.grown(later))


def statistics(number: int, water: Water) -> tuple[float, float, float]:
    """Remainder between 3 and 17 m [m/s], and scatter of ratio [-] and turn [deg] above 0.2 m/s."""
    hidden = TruthParameters.of_family(number, water=water)
    buoy = generated_current(number, start=datetime(2020, 1, 18, tzinfo=UTC), days=14.0)
    speed = buoy.values["current_speed_m_s"]
    # As fast as the record at Long Beach.
    scaled = {"current_speed_m_s": speed * 0.31 / np.sqrt(np.mean(speed**2))}
    buoy = replace(buoy, values={**buoy.values, **scaled}, flags={})
    weather = true_weather(buoy, None, hidden=hidden, seed=number, every_s=60.0)
    rows = [weather.current(second) for second in np.arange(0.0, 13.9 * 86400.0, 600.0).tolist()]
    east, north = np.moveaxis(np.array(rows), 2, 0)
    upper, middle = (
        np.array(
            [
                complex(*(np.interp(depth, weather.level_depth, part) for part in both))
                for both in zip(east, north, strict=True)
            ]
        )
        for depth in (3.0, 17.0)
    )
    factor = np.vdot(upper, middle) / np.vdot(upper, upper)
    fast = np.abs(upper) > 0.2
    ratio = middle[fast] / upper[fast]
    remainder = np.sqrt(np.mean(np.abs(middle - factor * upper) ** 2))
    return float(remainder), float(np.abs(ratio).std()), float(np.angle(ratio, deg=True).std())


def test_coastal_water_lies_between_what_two_adcps_measured() -> None:
    numbers = range(1, 61)
    shear = [TruthParameters.of_family(n, water="coastal").profile.shear_sd_m_s for n in numbers]
    least, most = (numbers[int(pick(shear))] for pick in (np.argmin, np.argmax))
    western_shoal, long_beach = (0.044, 0.10, 7.0), (0.113, 0.26, 14.0)
    np.testing.assert_allclose(statistics(least, "coastal"), western_shoal, rtol=0.25)
    np.testing.assert_allclose(statistics(most, "coastal"), long_beach, rtol=0.25)
    assert np.all(np.array(statistics(most, "tame")) < western_shoal)


def test_shallow_water_is_as_the_adcp_at_western_shoal_measured_it() -> None:
    found = np.mean([statistics(number, "shallow") for number in range(1, 7)], axis=0)
    np.testing.assert_allclose(found, (0.044, 0.10, 7.0), rtol=0.2)


def test_the_adcp_at_western_shoal_measured_what_shallow_water_was_made_after(shared: Path) -> None:
    rows = (shared / "data/adcp_western_shoal_2022.txt").read_text().splitlines()[3:]
    bins = [[float(cell) for cell in row.split(",")[7:]] for row in rows]
    speed, to = np.array(bins[1::3]), np.array(bins[2::3])
    upper, middle = (speed * np.exp(1j * np.deg2rad(to)))[:, [7, 4]].T
    known = np.isfinite(upper)
    upper, middle = upper[known], middle[known]
    factor = np.vdot(upper, middle) / np.vdot(upper, upper)
    ratio = (middle / upper)[np.abs(upper) > 0.2]
    found = (
        np.sqrt(np.mean(np.abs(middle - factor * upper) ** 2)),
        np.abs(ratio).std(),
        np.angle(ratio, deg=True).std(),
    )
    np.testing.assert_allclose(found, (0.044, 0.10, 7.0), rtol=0.25)


def test_a_later_water_changes_the_identity_of_no_other_truth() -> None:
    assert TruthParameters.of_family(7).sha256.startswith("5204e97d21bf")
    assert TruthParameters.of_family(7, water="shallow").profile.shear_sd_m_s > 0.05


def test_a_settled_field_has_the_mean_of_the_shear_over_the_nets_depth(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    buoy = generated_current(1, start=datetime(2020, 1, 18, tzinfo=UTC), days=2.0)
    hidden = TruthParameters.of_family(3, water="coastal")
    even = replace(hidden, profile=replace(hidden.profile, shear_sd_m_s=0.0))
    fields = [
        virtual_field(
            small_cage,
            buoy,
            hidden=one,
            seed=1,
            method="settle",
            every_s=600.0,
            kept=tmp_path,
            workers=1,
        )
        for one in (hidden, even)
    ]
    assert hidden.title in fields[0].record.notes
    depth = [one.truth.sensors["depth-2"].values["depth_m"] for one in fields]
    assert 0.05 < np.std(depth[0] - depth[1]) < 2.0
