"""How far nodes move in waves, at level 1, and what a depth sensor's windows add."""

from dataclasses import fields, replace

import numpy as np
import pytest

from seacage.ocean import SeaState
from seacage.records import FieldRecord, Record
from seacage.surrogates import FittedMotionGP, decode, encode
from seacage.twin import Metocean, Training, Twin, train
from seacage.twin._lines._line_loads import load_features
from seacage.twin._saving import from_parts, to_parts
from seacage.twin._training._loads import line_symmetry
from wavy import SQUARE, gaussian_series, true_motion, wavy_campaign, wavy_field, wavy_twin

SEA = SeaState(current_speed=0.4, current_to=40.0, hs=1.5, tp=6.0, wave_from=220.0)


def true_pair(seas: tuple[SeaState, ...]) -> np.ndarray:
    """Of each node of the cage in horizontal and vertical [m]."""
    std = true_motion(SQUARE, seas)
    return np.stack([np.hypot(std[..., 0], std[..., 1]), std[..., 2]], axis=-1)


@pytest.fixture(scope="module")
def learned() -> FittedMotionGP:
    campaign = wavy_campaign(60, cage=SQUARE)
    lines = line_symmetry(SQUARE, campaign.line_names)
    assert lines is not None
    return FittedMotionGP.fit(
        load_features(Metocean.of(campaign.seas)),
        true_motion(SQUARE, campaign.seas),
        symmetry=lines.at(SQUARE.design_position),
        restarts=0,
    )


def test_the_motion_of_every_node_is_learned_in_both_directions(learned: FittedMotionGP):
    seas = wavy_campaign(90, cage=SQUARE).seas[60:]
    x = load_features(Metocean.of(seas))
    error = np.abs(learned.mean(x, hs=x[:, 3]) / true_pair(seas) - 1.0)
    assert np.median(error) < 0.01
    assert np.quantile(error, 0.9) < 0.1


def test_lower_waves_move_nodes_in_proportion(learned: FittedMotionGP):
    x = load_features(Metocean.of(SEA))
    whole, half = (learned.mean(x, hs=hs * x[:, 3]) for hs in (1.0, 0.5))
    np.testing.assert_allclose(half, 0.5 * whole)


def test_it_survives_saving(learned: FittedMotionGP):
    again = decode(*encode(learned))
    assert isinstance(again, FittedMotionGP)
    x = load_features(Metocean.of(SEA))
    np.testing.assert_allclose(again.mean(x, hs=x[:, 3]), learned.mean(x, hs=x[:, 3]), rtol=1e-12)


def test_a_turned_sea_moves_the_nodes_that_turn_with_it(learned: FittedMotionGP):
    turned = replace(SEA, current_to=130.0, wave_from=310.0)
    x = load_features(Metocean.of([SEA, turned]))
    one, other = learned.mean(x, hs=x[:, 3])
    # ring by ring, the bottom's middle aside
    ring, image = (each[:-1].reshape(-1, SQUARE.spokes, 2) for each in (one, other))
    quarter = SQUARE.spokes // 4
    np.testing.assert_allclose(np.roll(ring, -quarter, axis=1), image, rtol=1e-6)


def test_unknown_waves_move_no_node_by_a_number():
    twin = wavy_twin()
    unknown = Metocean.of([SEA, SEA, SEA])
    unknown = replace(
        unknown,
        hs=np.array([1.5, np.nan, 1.5]),
        tp=np.array([6.0, 6.0, np.nan]),
    )
    answer = twin.predict(unknown)
    assert answer.node_motion is not None
    assert np.isfinite(answer.node_motion).all(axis=(1, 2)).tolist() == [True, False, True]
    assert np.isfinite(answer.depth_std).all(axis=1).tolist() == [True, False, True]


def field_with_depth(factor: float) -> FieldRecord:
    """The tide and waves of ``wavy_field``, and a depth that scatters by a factor more."""
    field = wavy_field(1.0)
    twin, time = wavy_twin(), field.sensors["shackle-2"].time
    buoy, names = field.buoy, [one.name for one in twin.cage.depth_sensors]
    answer = twin.predict_record(buoy)
    row = np.minimum(np.arange(len(time)) // 600, len(buoy) - 1)
    series = gaussian_series(np.random.default_rng(8), len(time), every=1.0)
    column = names.index("depth-2")
    depth = answer.sensor.mean[row, column] + factor * answer.depth_std[row, column] * series
    record = Record(
        stream="depth-2",
        time=time,
        values={"depth_m": depth},
        origin=field.sensors["shackle-2"].origin,
    )
    return replace(field, sensors={"depth-2": record})


def trained(factor: float) -> Twin:
    settings = Training(high_fidelity_points=25, restarts=0)
    base = wavy_twin()
    return train(base.cage, None, field_with_depth(factor), base=base, training=settings)


def test_a_depth_sensor_says_how_much_it_moves_in_waves():
    twin, low = trained(1.3), wavy_twin()
    found, below = (one.predict(SEA) for one in (twin, low))
    assert found.depth_std_level.tolist() == [1, 2, 1]
    ratio = found.depth_std[0] / below.depth_std[0]
    assert ratio[1] == pytest.approx(1.3, abs=0.05)
    np.testing.assert_allclose(ratio[[0, 2]], 1.0)
    parts = {one.name: getattr(twin, one.name) for one in fields(twin) if one.init}
    again = Twin(**from_parts(*to_parts(**parts), source="here"))
    np.testing.assert_allclose(again.predict(SEA).depth_std, found.depth_std)


def test_where_level_1_is_right_no_depth_is_corrected():
    assert trained(1.0).predict(SEA).depth_std_level.tolist() == [1, 1, 1]
