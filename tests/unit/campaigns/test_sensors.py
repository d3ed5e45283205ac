"""Virtual sensors."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.campaigns import Hidden
from seacage.campaigns._sensors import sensed
from seacage.conventions import Flag, Origin
from seacage.records import Record

HIDDEN = Hidden.read()
CALM = replace(
    HIDDEN,
    outages=replace(
        HIDDEN.outages, lost_share=0.0, gaps_per_week=0.0, spikes_per_week=0.0, stuck_per_week=0.0
    ),
)
DAYS, STEP = 48, 300.0
SECONDS = np.arange(0.0, DAYS * 86400.0, STEP)
TIME = np.datetime64("2020-01-18") + (SECONDS * 1e6).astype("timedelta64[us]")


def truth(stream: str, key: str) -> Record:
    values = 12.0 + 4.0 * np.sin(2.0 * np.pi * SECONDS / 44714.0)
    return Record(stream=stream, time=TIME, values={key: values}, origin=Origin.VIRTUAL_FIELD)


DEPTH, TENSION = truth("depth-1", "depth_m"), truth("shackle-1", "tension_kn")


def errors(said: Record, exact: Record) -> np.ndarray:
    (key,) = exact.values
    return said.values[key] - exact.values[key][np.isin(exact.time, said.time)]


def test_a_shackle_lives_in_its_two_windows() -> None:
    said = sensed(TENSION, CALM, np.random.default_rng(1))
    (silence,) = np.flatnonzero(np.diff(said.time) > np.timedelta64(300, "s"))
    first, second = silence + 1, len(said) - silence - 1
    assert (first, second) == (12 * 12, 24 * 12)
    days = (said.time[silence + 1] - said.time[silence]) / np.timedelta64(1, "D")
    assert 20.0 < days < 35.0


def test_a_shackle_has_gain_bias_and_noise() -> None:
    exact = TENSION.values["tension_kn"][np.isin(TENSION.time, sensed_tension(0).time)]
    fits = [np.polyfit(exact, sensed_tension(seed).values["tension_kn"], 1) for seed in range(8)]
    gain, bias = np.transpose(fits)
    assert np.ptp(gain) > 0.01
    # At 12 kN on average a line through the readings trades bias for gain a little.
    assert np.abs(gain - 1.0).max() < 0.025
    assert 0.1 < np.ptp(bias) < 0.6
    noise = sensed_tension(0).values["tension_kn"] - np.polyval(fits[0], exact)
    assert np.std(noise) == pytest.approx(0.15, rel=0.2)


def sensed_tension(seed: int) -> Record:
    return sensed(TENSION, CALM, np.random.default_rng(seed))


def test_a_depth_sensor_drifts_and_is_noisy_all_the_time() -> None:
    said = sensed(DEPTH, CALM, np.random.default_rng(1))
    assert len(said) == len(DEPTH)
    error = errors(said, DEPTH)
    slope, _ = np.polyfit(SECONDS / 604800.0, error, 1)
    assert abs(slope) == pytest.approx(0.02, rel=0.1)
    assert np.std(error - np.polyval(np.polyfit(SECONDS, error, 1), SECONDS)) == pytest.approx(
        0.03, rel=0.05
    )


def test_a_calm_sensor_is_good_throughout() -> None:
    for said in (sensed(DEPTH, CALM, np.random.default_rng(1)), sensed_tension(1)):
        (flags,) = said.flags.values()
        assert np.mean(flags == Flag.GOOD) > 0.995


def test_readings_are_lost_one_by_one_and_in_gaps() -> None:
    said = sensed(DEPTH, HIDDEN, np.random.default_rng(3))
    lost = 1.0 - len(said) / len(DEPTH)
    # Single losses are 0.3 %; a gap of two hours a week adds 1.2 % on average.
    assert 0.003 < lost < 0.08
    assert np.diff(said.time).max() > np.timedelta64(30, "m")


def test_quality_control_sees_most_spikes_and_long_flat_lines() -> None:
    said = sensed(DEPTH, HIDDEN, np.random.default_rng(4))
    wrong = np.abs(errors(said, DEPTH)) > 2.0
    flagged = said.flags["depth_m"] != Flag.GOOD
    assert 5 < wrong.sum() < 300
    assert flagged[wrong].mean() > 0.5
    assert flagged.mean() < 0.03


def test_chance_is_the_generators_alone() -> None:
    first, again, other = (sensed_tension(seed).values["tension_kn"] for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other)
