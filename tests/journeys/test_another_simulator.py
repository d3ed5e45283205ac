"""From the files of another simulator to a twin."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.ocean import SeaState
from seacage.records import read_results
from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas
from seacage.twin import Training, train
from simulators import write_results
from wavy import CAGE, wavy_campaign

FEW = Training(high_fidelity_points=60, days=2.0, restarts=0)
SEAS = (
    SeaState(current_speed=0.4, current_to=75.0, hs=1.2, tp=6.0, wave_from=250.0),
    SeaState(current_speed=0.6, current_to=200.0, hs=0.5, tp=9.0, wave_from=20.0),
)


def few_sensors(cage):
    """Two depth sensors, for level 2 of the net, and a shackle."""
    field, kept = stand_in_field(cage), ("depth-1", "depth-2", "shackle-2")
    return replace(field, sensors={name: field.sensors[name] for name in kept})


@pytest.mark.slow
def test_renamed_and_shuffled_results_train_the_twin_that_the_campaign_trains(tmp_path):
    """The campaign's own twin is trained without symmetry too."""
    field, loads = few_sensors(CAGE), wavy_campaign().lines["mean"]
    own = replace(wavy_campaign(), bridle_tension=loads[:, :12], simulator="seacage")
    folder = write_results(tmp_path, own)
    found = read_results(folder, CAGE, simulator="Other 1", duration=900.0)
    twins = [train(CAGE, one, field, training=FEW) for one in (own, found)]
    answers = [twin.predict(SEAS) for twin in twins]
    assert answers[0].shape_level == 2
    assert twins[0].models.loads is not None
    for part in ("mean", "std"):
        for name in ("bridle_tension", "sensor"):
            one, other = (getattr(getattr(answer, name), part) for answer in answers)
            np.testing.assert_array_equal(one, other)
        for name in ("mean", "std", "maximum_3h", "damage_equivalent"):
            one, other = (getattr(getattr(answer.line, name), part) for answer in answers)
            np.testing.assert_array_equal(one, other)
    for name in ("node_position", "node_std", "node_motion", "depth_std", "volume_fraction"):
        np.testing.assert_array_equal(*(getattr(answer, name) for answer in answers))
    assert [twin.provenance.law for twin in twins] == ["stand-in", "Other 1"]


@pytest.mark.slow
def test_a_net_of_another_mesh_trains_a_twin_whose_sensors_hang_on_it(tmp_path):
    cage = Cage.named("ace").altered(mesh={"spokes": 12, "ring_depths_m": [0.0, 5.0, 15.0, 23.0]})
    campaign = stand_in_campaign(cage, stand_in_seas(60))
    found = read_results(write_results(tmp_path, campaign), CAGE, simulator="Other 1")
    simulated = Cage.from_toml(found.cage_toml)
    twins = [train(one, campaign, few_sensors(cage), training=FEW) for one in (cage, simulated)]
    assert twins[1].cage.node_count == 49
    own, other = (twin.predict(SEAS[:1]) for twin in twins)
    np.testing.assert_allclose(other.node_position, own.node_position, atol=1e-3)
    np.testing.assert_allclose(other.sensor.mean, own.sensor.mean, rtol=1e-6)


def test_what_a_parted_line_leaves_is_not_learned_from_another_simulator():
    campaign = replace(wavy_campaign(30), simulator="Other 1")
    with pytest.raises(InputError, match=r"and the campaign is of Other 1\. Leave parted out"):
        train(CAGE, campaign, parted=[wavy_campaign(30, parted=["bridle-1"])], training=FEW)


def test_means_alone_train_a_twin_without_loads_in_waves(tmp_path):
    means = replace(wavy_campaign(), lines={"mean": wavy_campaign().lines["mean"]})
    found = read_results(write_results(tmp_path, means), CAGE, simulator="Other 1")
    twin = train(CAGE, found, training=FEW)
    assert twin.models.loads is None
    assert twin.predict(SEAS).line is None
