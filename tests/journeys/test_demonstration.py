"""The demonstration, from its kept field to a twin that knows the loads of lines in waves."""

from datetime import timedelta

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import Plan, generated_current
from seacage.records import moment
from seacage.studies import Demonstration, _demonstration, prepare_demonstration
from seacage.studies._demonstration_field import DAYS, START, TRAINING_DAYS
from seacage.twin import Metocean, Twin

COARSE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
HALF = START + timedelta(days=TRAINING_DAYS)

# Half a minute of simulations.
pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]


@pytest.fixture(scope="module", autouse=True)
def small():
    """A coarse cage in few seas; what it learns is as in the demonstration."""
    with pytest.MonkeyPatch.context() as patch:
        plan = Plan.named("loads", 0, 32, duration=600.0)
        patch.setattr(_demonstration, "PLAN", plan)
        patch.setattr(_demonstration, "SPIN_UP", 100.0)
        patch.setattr(_demonstration, "SEEDS", (0,))
        patch.setattr(_demonstration, "CASES", 16)
        patch.setattr(Cage, "named", lambda _: COARSE)
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("demonstration")


@pytest.fixture(scope="module")
def made(folder) -> Demonstration:
    return prepare_demonstration(folder, workers=1)


def test_it_is_a_twin_a_buoy_and_virtual_sensors(made):
    twin = Twin.read(made.twin_folder)
    assert twin.sensor_names == made.cage.sensor_names == tuple(made.field.sensors)
    assert twin.discrepancy is not None
    assert twin.discrepancy.origin == "virtual field"
    assert made.buoy is made.field.buoy
    assert {made.buoy.origin, made.field.origin, twin.origin} == {"virtual field"}


def test_it_shows_the_days_that_it_did_not_learn_from(made):
    twin = Twin.read(made.twin_folder)
    for stream in (made.buoy, *made.field.sensors.values()):
        assert HALF <= moment(stream.time[0]) < moment(stream.time[-1])
        assert moment(stream.time[-1]) <= START + timedelta(days=DAYS)
    assert all(window.end <= HALF for window in twin.provenance.training_windows.values())


def test_it_knows_the_loads_of_all_lines_in_the_shown_waves(made):
    twin = Twin.read(made.twin_folder)
    keys = ("current_speed_m_s", "current_to_deg", "hs_m", "tp_s", "wave_from_deg")
    assert set(keys) <= set(made.buoy.values)
    answer = twin.predict(Metocean.of_record(made.buoy).rows(np.arange(3)))
    assert np.isfinite(answer.line.maximum_3h.mean).all()
    assert np.all(answer.line.maximum_3h.mean >= answer.line.mean.mean)


def test_what_is_made_is_not_made_again(made, folder):
    def refuse_again(stage, done, total):
        raise AssertionError(f"{stage} was made again")

    again = prepare_demonstration(folder, workers=1, progress=refuse_again)
    assert again.twin_folder == made.twin_folder


def test_another_buoys_record_drives_the_show_and_teaches_nobody(made, folder):
    record = generated_current(3, start=START, days=0.5)
    shown = prepare_demonstration(folder, record=record, workers=1)
    assert shown.twin_folder == made.twin_folder
    assert len(shown.buoy) == len(record)
