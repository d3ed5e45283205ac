"""Level 2 of lines' loads in waves, trained on a shackle of known ratio to level 1."""

from dataclasses import fields, replace
from datetime import UTC, datetime
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from seacage.ocean import SeaState
from seacage.records import Sample
from seacage.service._live._answers import state_of
from seacage.twin import Answered, Training, Twin, train
from seacage.twin._saving import from_parts, to_parts
from wavy import CAGE, wavy_field, wavy_twin

SEA = SeaState(current_speed=0.4, current_to=40.0, hs=1.5, tp=6.0, wave_from=220.0)
SETTINGS = Training(high_fidelity_points=25, restarts=0)


@cache
def corrected(factor: float, *, hours: float = 12.0, every: float = 1.0) -> Twin:
    field = wavy_field(factor, hours=hours, every=every)
    return train(CAGE, None, field, base=wavy_twin(), training=SETTINGS)


def line_of(twin: Twin) -> int:
    return next(one.bridle for one in twin.cage.shackles if one.name == "shackle-2")


def test_the_line_of_a_shackle_scatters_as_its_windows_did():
    twin, low = corrected(1.4), wavy_twin()
    line, (answer, below) = line_of(twin), (one.predict(SEA) for one in (twin, low))
    assert answer.line is not None
    assert below.line is not None
    assert answer.line_level.tolist() == [1 + (n == line) for n in range(len(answer.line_names))]
    ratio = answer.line.std.mean[0] / below.line.std.mean[0]
    assert ratio[line] == pytest.approx(1.4, abs=0.06)
    others = np.delete(ratio, line)
    np.testing.assert_allclose(others, 1.0)
    above = [(one.maximum_3h.mean - one.mean.mean)[0, line] for one in (answer.line, below.line)]
    peak = twin.models.line_upper["shackle-2"].peak
    assert peak is not None
    assert above[0] / above[1] == pytest.approx(ratio[line] * peak, rel=0.03)
    lower, upper = answer.line.maximum_3h.interval(0.95)
    assert lower[0, line] < answer.line.maximum_3h.mean[0, line] < upper[0, line]
    assert np.isnan(np.delete(lower, line)).all()


def test_the_state_has_the_interval_of_level_2_alone():
    twin, now = corrected(1.4), datetime(2020, 1, 18, tzinfo=UTC)
    current = {"current_speed_m_s": 0.4, "current_to_deg": 40.0}
    waves = {"hs_m": 1.5, "tp_s": 6.0, "wave_from_deg": 220.0}
    sample = Sample(stream="buoy-1", t=now, values=current | waves)
    state, events = twin.step(twin.start(), sample, now)
    (answered,) = (one for one in events if isinstance(one, Answered))
    lines = state_of("ace", twin, answered, state).lines
    two = lines[line_of(twin)]
    largest = two.maximum_3h_kn
    assert two.level == 2
    assert largest.lower is not None
    assert largest.mean is not None
    assert largest.upper is not None
    assert largest.lower < largest.mean < largest.upper
    one = next(line for line in lines if line is not two)
    assert (one.level, one.maximum_3h_kn.lower) == (1, None)


def test_the_correction_says_how_fast_its_shackle_is():
    found = corrected(1.4).models.line_upper["shackle-2"]
    assert (found.every_s, found.peak_samples, found.windows) == (1.0, 6.0, 72)
    assert found.rate == "a reading every 1 s, 6.0 per peak period"


def test_the_errors_of_level_1_are_kept_of_every_shackle_in_waves():
    (off,), (right,) = (corrected(one).models.line_errors.values() for one in (1.4, 1.0))
    assert off.std == pytest.approx(0.4, abs=0.15)  # a window's scatter, and a scale near its own
    assert right.std < 0.5 * off.std
    assert right.maximum < off.maximum < 0.2  # of some 40 kN, of which 6 are by waves


def test_where_level_1_is_right_nothing_is_corrected():
    found = corrected(1.0).models.line_upper.get("shackle-2")
    assert found is None or (abs(found.std.constant) < 0.03 and found.std.variable == "")


def test_three_hours_are_too_short():
    assert corrected(1.4, hours=3.0).models.line_upper == {}


def test_a_slow_shackle_corrects_the_scatter_alone():
    found = corrected(1.4, every=3.0).models.line_upper["shackle-2"]
    assert found.std.constant == pytest.approx(np.log(1.4), abs=0.06)
    assert (found.peak, found.damage, found.maximum_log_sd) == (None, None, None)


def test_level_2_is_saved_with_its_twin_and_old_twins_have_none(tmp_path: Path):
    twin = corrected(1.4)
    twin.write(tmp_path / "twin")
    again = Twin.read(tmp_path / "twin")
    assert again.models.line_upper == twin.models.line_upper
    parts = {one.name: getattr(twin, one.name) for one in fields(twin) if one.init}
    settings, arrays = to_parts(**parts)
    del settings["line_upper"]
    assert from_parts(settings, arrays, source="old")["models"].line_upper == {}


def test_a_shackle_that_has_not_moved_keeps_its_level_2():
    twin = corrected(1.4)
    moved = [replace(one, bridle=12) if one.name == "shackle-1" else one for one in CAGE.shackle]
    again = train(replace(CAGE, shackle=tuple(moved)), None, base=twin, training=SETTINGS)
    assert again.models.line_upper == twin.models.line_upper
