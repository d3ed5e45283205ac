from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import (
    TruthParameters,
    generated_current,
    true_nets,
    true_shapes,
    virtual_field,
)
from seacage.conventions import InputError
from stand_in import StandIn

SMALL = Cage.named("ace").altered(mesh={"spokes": 8})
HIDDEN = TruthParameters.read()


@pytest.fixture(autouse=True)
def stand_in(monkeypatch):
    simulator = StandIn()
    monkeypatch.setattr("seacage.campaigns._cases.settle", simulator.settle)
    return simulator


def shapes(seeds=(0, 1), cases=40, **options):
    return true_shapes(SMALL, hidden=HIDDEN, seeds=seeds, cases=cases, workers=1, **options)


def test_every_case_has_a_report_and_a_shape_and_the_same_seeds_the_same_ones():
    messages = []
    once = shapes(progress=lambda *report: messages.append(report))
    again = shapes()
    assert once.node_position.shape == (80, SMALL.node_count, 3)
    np.testing.assert_array_equal(once.node_position, again.node_position)
    np.testing.assert_array_equal(once.current_velocity, again.current_velocity)
    assert messages[-1] == ("shape error", 80, 80)


def test_a_seed_is_the_same_among_others_and_others_are_not():
    both, second = shapes(seeds=(0, 1)), shapes(seeds=(1,))
    np.testing.assert_array_equal(both.current_velocity[40:], second.current_velocity)
    np.testing.assert_array_equal(both.node_position[40:], second.node_position)
    assert not np.allclose(both.current_velocity[:40], second.current_velocity)


def test_the_currents_are_spread_over_all_speeds_and_not_as_a_record_is():
    speed = np.hypot(*shapes(seeds=(0,), cases=120).current_velocity.T)
    share = np.histogram(speed, bins=4, range=(0.0, speed.max()))[0] / 120
    np.testing.assert_allclose(share, 0.25, atol=0.1)


def test_the_cage_meets_another_current_than_the_buoy_reports(stand_in):
    reported = shapes(seeds=(0,)).current_velocity
    met = np.array([sea.current_velocity for sea in stand_in.settled])
    factor = np.sort(np.hypot(*met.T)) / np.maximum(np.sort(np.hypot(*reported.T)), 1e-3)
    assert len(met) == len(reported)
    # Sheltered or hastened between 0.75 and 1.15, and with eddies.
    assert 0.7 < np.median(factor) < 1.2
    assert not np.allclose(np.sort(met, axis=0), np.sort(reported, axis=0), atol=0.01)


def test_a_case_that_does_not_settle_is_left_out(stand_in):
    stand_in.reach = 0.6
    lost = shapes(seeds=(0,))
    assert 10 < len(lost.node_position) < 40
    assert len(lost.node_position) == len(lost.current_velocity)
    assert np.isfinite(lost.node_position).all()


def test_the_growth_of_the_net_matters():
    bare = replace(HIDDEN.fouling, shallow_most=HIDDEN.fouling.shallow_least)
    clean = true_shapes(
        SMALL, hidden=replace(HIDDEN, fouling=bare), seeds=(0,), cases=40, workers=1
    )
    assert not np.allclose(clean.node_position, shapes(seeds=(0,)).node_position, atol=0.01)


@pytest.mark.parametrize(("seeds", "cases"), [((), 10), ((0,), 0)])
def test_no_query_has_no_answer(seeds, cases):
    with pytest.raises(InputError, match="Ask for 1"):
        shapes(seeds=seeds, cases=cases)


def test_the_true_net_is_where_the_errorless_depth_sensors_are(tmp_path):
    buoy = generated_current(3, start=datetime(2020, 1, 18, tzinfo=UTC), days=2.0)
    how = {"hidden": TruthParameters.of_family(3), "seed": 3, "kept": tmp_path, "workers": 1}
    truth = virtual_field(SMALL, buoy, method="settle", **how).truth
    depth = np.column_stack([truth.sensors[f"depth-{k}"].values["depth_m"] for k in (1, 2, 3)])
    rows = np.arange(0, len(depth), 97)
    net = true_nets(SMALL, buoy, truth.sensors["depth-1"].time[rows], **how)
    nodes = [one.node for one in SMALL.depth_sensors]
    np.testing.assert_allclose(-net[:, nodes, 2], depth[rows], atol=1e-9)
