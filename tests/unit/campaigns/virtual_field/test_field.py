"""The virtual field."""

from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, VirtualField, generated_current, virtual_field
from seacage.conventions import Origin
from stand_in import StandIn

HIDDEN = TruthParameters.read()
EXACT = replace(
    HIDDEN,
    buoy=replace(HIDDEN.buoy, speed_sd_m_s=0.0, direction_sd_deg=0.0),
    current=replace(HIDDEN.current, residual_sd_m_s=0.0),
)
BUOY = generated_current(0, start=datetime(2020, 1, 18, tzinfo=UTC), days=10.0)
STEP = 300.0


@pytest.fixture(scope="module")
def field(small_cage: Cage) -> Iterator[VirtualField]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("seacage.campaigns._cases.settle", StandIn().settle)
        yield virtual_field(
            small_cage, BUOY, hidden=HIDDEN, seed=1, method="settle", workers=1, every_s=STEP
        )


def test_the_field_says_what_it_is(field: VirtualField) -> None:
    for record in (field.record, field.truth):
        assert record.origin is Origin.VIRTUAL_FIELD
        assert record.hidden_sha256 == HIDDEN.sha256
        assert record.notes[0].startswith("Virtual field")
        assert {sensor.origin for sensor in record.sensors.values()} == {Origin.VIRTUAL_FIELD}
        assert sum("the error is" in note for note in record.notes) == 8
        assert record.cage == "ace"


def test_the_buoys_stream_passes_through_unchanged(field: VirtualField) -> None:
    assert field.record.buoy is BUOY
    assert field.truth.buoy is BUOY


def test_every_sensor_of_the_cage_speaks_and_the_truth_never_pauses(
    small_cage: Cage, field: VirtualField
) -> None:
    assert tuple(field.record.sensors) == small_cage.sensor_names
    assert tuple(field.truth.sensors) == small_cage.sensor_names
    for name, sensor in field.truth.sensors.items():
        assert set(np.diff(sensor.time)) == {np.timedelta64(300, "s")}
        (values,) = sensor.values.values()
        assert np.isfinite(values).all()
        assert len(field.record.sensors[name]) < len(sensor)


def test_the_truth_is_near_what_the_sensors_say(field: VirtualField) -> None:
    for name, outcome in field.record.sensors.items():
        (key,) = outcome.values
        exact = field.truth.sensors[name]
        error = outcome.values[key] - exact.values[key][np.isin(exact.time, outcome.time)]
        assert abs(np.median(error)) < (0.6 if key == "tension_kn" else 0.1)


@pytest.mark.slow
def test_the_seed_changes_the_noise_and_neither_the_cage_nor_its_responses(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    options = {
        "hidden": EXACT,
        "method": "settle",
        "kept": tmp_path,
        "workers": 1,
        "every_s": 600.0,
    }
    one = virtual_field(small_cage, BUOY, seed=1, **options)
    settled = len(stand_in.settled)
    two = virtual_field(small_cage, BUOY, seed=2, **options)
    assert len(stand_in.settled) == settled
    exact = [field.truth.sensors["depth-2"].values["depth_m"] for field in (one, two)]
    np.testing.assert_array_equal(*exact)
    reading = [field.record.sensors["depth-2"].values["depth_m"][0] for field in (one, two)]
    assert reading[0] != reading[1]
