from dataclasses import replace

import pytest

from page_frames import decode_frame
from running_service import Running
from seacage.ocean import SeaState
from seacage.service._http._whatif_routes import effective_water, training_domain_of
from seacage.service._schemas._state import Water
from seacage.testing import stand_in_twin
from wavy import wavy_twin

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
