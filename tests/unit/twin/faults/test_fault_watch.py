"""Residuals of a record, as the fault detector takes them."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas, stand_in_twin
from seacage.twin import Metocean, Training, block_residuals, residual_blocks, train


def twin_in_waves():
    """A twin with waves among its inputs, and the field that trained it."""
    cage, random = stand_in_twin().cage, np.random.default_rng(0)
    seas = tuple(
        replace(sea, hs=float(random.uniform(0.0, 3.0)), tp=None, wave_from=220.0)
        for sea in stand_in_seas(40)
    )
    field = stand_in_field(cage, days=1.0)
    rows = len(field.buoy)
    waves = {"hs_m": np.linspace(0.5, 2.5, rows), "wave_from_deg": np.full(rows, 220.0)}
    buoy = replace(field.buoy, values={**field.buoy.values, **waves})
    sensors = {name: field.sensors[name] for name in ("depth-1", "shackle-2")}
    field = replace(field, buoy=buoy, sensors=sensors)
    training = Training(inputs=("current", "waves"), restarts=0, high_fidelity_points=40)
    return train(cage, stand_in_campaign(cage, seas), field, training=training), field


@pytest.mark.slow
def test_a_half_hour_is_predicted_at_its_mean_current_in_its_last_waves():
    twin, field = twin_in_waves()
    time = field.buoy.time[[10, 11, 12, 40, 41, 42]]
    block = np.array([0, 0, 0, 1, 1, 1])
    found = block_residuals(twin, field.buoy, time, np.zeros((6, len(twin.sensor_names))), block)
    water = twin.travel_time.water_at(field.buoy, time)
    means = water.current_velocity.reshape(2, 3, 2).mean(axis=1)
    here = replace(water.rows(np.array([2, 5])), current_velocity=means)
    columns = [twin.sensor_names.index(name) for name in found["sensors"].tolist()]
    assert columns
    own = [twin.models.upper[name].spread.by == "own" for name in found["sensors"].tolist()]
    share = np.where(own, twin.fault_detector.own_share, 1.0)
    std = twin.predict(here).sensor.std[:, columns]
    np.testing.assert_allclose(found["own_sd"], share * std)
    assert all(one.in_waves for one in residual_blocks(found))
    np.testing.assert_array_equal(found["carried"], np.tile(~np.array(own), (2, 1)))
    np.testing.assert_allclose(found["tension"], twin.predict(here).bridle_tension.mean)
    calm = twin.predict(Metocean.without_waves(means))
    assert not np.allclose(found["tension"], calm.bridle_tension.mean)
