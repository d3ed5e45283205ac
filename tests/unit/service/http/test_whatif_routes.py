from dataclasses import replace
from datetime import UTC, datetime

import pytest

from page_frames import decode_frame
from running_service import Running
from seacage.ocean import SeaState
from seacage.service._http._whatif_routes import effective_water, training_domain_of
from seacage.service._live._answers import topology_of, what_if_parted
from seacage.service._schemas._state import Water
from seacage.testing import stand_in_twin
from seacage.twin import Answered, Metocean
from wavy import twin_of_damage, wavy_twin

SEA = {"current_speed": 0.4, "current_to": 40.0, "hs": 1.5, "tp": 7.0, "wave_from": 200.0}
WAVES = {"hs_m": 1.0, "wave_from_deg": 270.0}


@pytest.fixture(scope="module")
def twin():
    """A twin that was taught with currents alone."""
    return stand_in_twin()


@pytest.fixture(scope="module")
def of_waves(twin):
    """The same, as if it had been taught with waves too."""
    models = replace(twin.models, inputs=("current", "waves"), edge=(1.1, 2.5))
    return replace(twin, models=models)


def test_a_twin_names_the_inputs_it_was_trained_with_and_those_it_does_not_know(idle: Running):
    learned = idle.reader.get("/api/v1/cages/ace/whatif").json()
    speed, direction = learned["inputs"]
    assert (speed["key"], direction["key"]) == ("current_speed_m_s", "current_to_deg")
    assert (speed["most"], direction["most"]) == (idle.cage.twin.models.edge[0], None)
    assert learned["unknown"] == ["hs_m", "tp_s", "wave_from_deg"]


def test_beyond_what_a_twin_names_it_extrapolates_whichever_way_the_water_runs(idle: Running):
    most = idle.reader.get("/api/v1/cages/ace/whatif").json()["inputs"][0]["most"]
    for speed, somewhere in ((most - 0.01, True), (most + 0.01, False)):
        seas = [SeaState(current_speed=speed, current_to=10.0 * k) for k in range(36)]
        assert bool(idle.cage.twin.predict(seas).in_domain.any()) is somewhere


def test_a_twin_that_was_trained_with_waves_names_them(of_waves):
    learned = training_domain_of(of_waves)
    assert [(one.key, one.most) for one in learned.inputs if one.most] == [
        ("current_speed_m_s", 1.1),
        ("hs_m", 2.5),
    ]
    assert learned.unknown == ["tp_s"]


def test_waves_that_the_twin_knows_nothing_of_are_not_reported_to_have_counted(idle: Running):
    calm = {"current_speed_m_s": 0.5, "current_to_deg": 90.0}
    with_waves, without = (
        decode_frame(idle.reader.post("/api/v1/cages/ace/whatif", json=sea).content).state
        for sea in (calm | WAVES, calm)
    )
    assert with_waves["bridles"] == without["bridles"]
    water = with_waves["water"]
    assert (water["hs_m"], water["tp_s"], water["wave_from_deg"]) == (None, None, None)


def test_the_period_that_goes_with_the_height_is_reported(of_waves):
    water = Water(
        current_speed_m_s=0.5, current_to_deg=90.0, hs_m=1.0, tp_s=None, wave_from_deg=270.0
    )
    sea = SeaState(current_speed=0.5, current_to=90.0, hs=1.0, tp=None, wave_from=270.0)
    assert effective_water(water, sea, of_waves).tp_s == 5.0
    calm = water.model_copy(update={"hs_m": 0.0})
    assert effective_water(calm, replace(sea, hs=0.0), of_waves) == calm


def test_a_twin_that_learned_loads_in_waves_names_their_height_and_period():
    twin = wavy_twin()
    learned = training_domain_of(twin)
    assert [one.key for one in learned.inputs[2:]] == ["hs_m", "tp_s", "wave_from_deg"]
    assert [one.most for one in learned.inputs[2:]] == [2.98, 17.7, None]  # of 40 cases
    assert learned.unknown == []
    water = Water(
        current_speed_m_s=0.5, current_to_deg=90.0, hs_m=1.0, tp_s=None, wave_from_deg=270.0
    )
    sea = SeaState(current_speed=0.5, current_to=90.0, hs=1.0, wave_from=270.0)
    assert effective_water(water, sea, twin) == water.model_copy(update={"tp_s": 5.0})


def test_the_topology_says_where_the_lines_run_whose_loads_are_known(twin):
    topology = topology_of("ace", wavy_twin(), speed=1.0)
    assert topology.water_depth_m == 191.0
    ends = {one.name: one.ends_m for one in topology.lines}
    kinds = {one.kind for one in topology.lines}
    assert (len(ends), kinds) == (16, {"frame line", "anchor line", "buoy line"})
    north_east = topology.corner_position_m[0]
    assert ends["frame-1"] == [north_east, topology.corner_position_m[1]]
    assert ends["anchor-1"][0] == north_east  # from there on along the frame's side, and down
    assert ends["anchor-1"][1][0] > 60.0
    assert ends["anchor-1"][1][2] < -8.0
    assert ends["buoy-1"] == [north_east, [*north_east[:2], 0.0]]
    assert topology_of("ace", twin, speed=1.0).lines == []


def test_a_twin_that_learned_no_parted_lines_says_how_it_could(idle: Running):
    answer = idle.reader.get("/api/v1/cages/ace/what-if-parted")
    assert answer.status_code == 200
    assert answer.json()["lines"] == []
    assert "--parted-lines" in answer.json()["reason"]


def parted_in(**sea):
    twin, water = twin_of_damage(), Metocean.of(SeaState(**SEA | sea))
    now = datetime(2020, 1, 18, tzinfo=UTC)
    answered = Answered(t=now, answer=twin.predict(water), metocean=water, input_age_s=0.0)
    return what_if_parted("ace", twin, answered)


def test_each_line_that_could_part_is_ranked_by_what_it_leaves_to_the_others():
    told, found = parted_in(), twin_of_damage().if_parted(SeaState(**SEA))
    assert (told.reason, told.level, len(told.lines)) == (None, 1, 24)
    shares = [one.utilisation for one in told.lines]
    assert None not in shares
    assert shares == sorted(shares, reverse=True)
    worst = told.lines[0]
    row = found.parted.index(worst.parted)
    assert worst.utilisation == pytest.approx(found.utilisation[0, row], abs=1e-4)
    assert worst.largest_maximum_3h is not None
    assert worst.largest_mean is not None
    line = found.line_names.index(worst.largest_maximum_3h.line)
    assert worst.largest_maximum_3h.kn == pytest.approx(
        found.maximum_3h[0, row, line] / 1e3, abs=1e-3
    )
    assert worst.largest_maximum_3h.kn > worst.largest_mean.kn
    assert worst.second_would_part is False


def test_outside_what_was_learned_no_line_has_a_number():
    told = parted_in(hs=4.0, tp=11.0)
    assert told.lines == []
    assert told.reason is not None
    assert told.reason.startswith("Outside")
