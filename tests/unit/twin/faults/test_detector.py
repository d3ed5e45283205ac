"""The fault detector, on half-hours made up from a known cause."""

from collections.abc import Iterable
from copy import copy
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import cache

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import Flag, InputError
from seacage.records import Sample
from seacage.twin import AlarmBook, FaultDetectorSettings
from seacage.twin._faults._baseline import Baseline, as_tuples
from seacage.twin._faults._cusum import Evidence
from seacage.twin._faults._detector import FaultDetector
from seacage.twin._faults._hypotheses import hypotheses, load_shares
from seacage.twin._faults._residuals import ResidualBlock
from seacage.twin._faults._sensor import SensorMonitor

ACE = Cage.named("ace")
NAMES = ACE.sensor_names
SLOPE = np.array(
    [
        *([-1.5, -8.0], [-2.0, -12.0], [-4.0, -25.0]),
        *([2e4, 6e4], [3e3, 2e4], [1e4, 7e4], [-3e4, 6e4], [-4e3, 2e4]),
    ]
)
OWN = np.array([0.2, 0.3, 1.1, 6e3, 3e3, 6e3, 5e3, 3e3])
TENSION = 1e3 * np.array([1.0, 5.0, 1.0, 1.0, 5.0, 1.0, 40.0, 20.0, 42.0, 41.0, 18.0, 38.0])
NORTH = np.array([0.1, 0.5])
NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)
DAY = 48
ALL = np.ones(len(NAMES), dtype=bool)
SETTINGS = FaultDetectorSettings()
LIMIT, LEAD = SETTINGS.limit, SETTINGS.lead


def block(error, names: Iterable[str] = NAMES, *, tide: float = 1.0) -> ResidualBlock:
    """A half-hour in a current to the north, with readings of these sensors."""
    received = np.isin(NAMES, list(names))
    return ResidualBlock(
        sensors=NAMES,
        received=received,
        residual=np.where(received, error, 0.0),
        own_sd=OWN,
        carried=np.array([name.startswith("shackle") for name in NAMES]),
        gradient=SLOPE,
        current=tide * NORTH,
        tension=TENSION,
        half_drag=-0.25 * tide * SLOPE @ NORTH,
    )


def noise(seed: int, count: int, *, memory: float = 0.4, size: float = 0.6) -> np.ndarray:
    """Independent noise of each sensor, correlated from block to block as on the virtual field."""
    random = np.random.default_rng(seed)
    own, now = [], np.zeros(len(NAMES))
    for _ in range(count):
        now = memory * now + np.sqrt(1 - memory**2) * random.normal(size=len(NAMES))
        own.append(size * now * OWN)
    return np.array(own)


def eddies(seed: int, count: int, sd: float = 0.06) -> np.ndarray:
    """Residuals that all sensors share, by the current."""
    return np.random.default_rng(seed).normal(scale=sd, size=(count, 2)) @ SLOPE.T


def quiet(seed: int, days: float) -> np.ndarray:
    count = round(days * DAY)
    return noise(seed, count) + eddies(seed + 1, count)


def only(name: str, size: float) -> np.ndarray:
    return np.where(np.array(NAMES) == name, size, 0.0)


def cut(bridle: int) -> np.ndarray:
    """Shift of the shackles' readings when a bridle has parted, a little off."""
    shift = 0.9 * load_shares(ACE, bridle, SETTINGS) * TENSION[bridle]
    return np.array([0.0] * 3 + [shift[one.bridle] for one in ACE.shackles])


class Watched:
    """A detector fed block by block, with an operator who changes nothing."""

    def __init__(self, settings: FaultDetectorSettings = SETTINGS) -> None:
        self.settings = settings
        self.detector = FaultDetector(monitors={name: SensorMonitor() for name in NAMES})
        self.active = frozenset[str]()
        self.raised: list[str] = []
        self.detail: dict[str, str] = {}
        self.blocks = 0
        self.in_waves = False

    def through(
        self,
        errors,
        names: Iterable[str] = NAMES,
        *,
        lost: np.ndarray | float = 0.0,
        halved: np.ndarray | None = None,
    ) -> "Watched":
        """Go on through errors, and through tides in which drag is lost at each sensor.

        ``halved``: shift at full tide if half the drag were lost, which then is, and of which the
        gradients show little.
        """
        for error in errors:
            self.blocks += 1
            seen = block(error, names, tide=0.6 + 0.4 * np.sin(2.0 * np.pi * self.blocks / 12.4))
            kept = seen.residual - lost * seen.drag * seen.received
            seen = replace(seen, residual=kept, in_waves=self.in_waves)
            if halved is not None:
                half_drag = halved * (seen.current[1] / NORTH[1]) ** 2
                seen = replace(seen, half_drag=half_drag, residual=seen.residual + half_drag)
                seen = replace(seen, gradient=0.15 * seen.gradient)
            self.detector = self.detector.updated(seen, ACE, self.settings, active=self.active)
            for one in self.detector.inputs(ACE, self.settings):
                assert one.value is not None
                if one.alarm in self.active and one.value <= 0.5:
                    self.active -= {one.alarm}
                elif one.alarm not in self.active and one.value >= 1.0:
                    self.active |= {one.alarm}
                    self.raised.append(one.alarm)
                    self.detail[one.alarm] = one.detail
        return self


@cache
def _learned() -> Watched:
    return Watched().through(quiet(1, 2.0))


def learned() -> Watched:
    """After two quiet days."""
    watch = copy(_learned())
    watch.raised, watch.detail = [], {}
    return watch


def test_a_current_that_the_buoy_did_not_measure_is_no_evidence():
    watch = learned().through([SLOPE @ np.array([0.08, -0.1])] * 4)
    assert max(watch.detector.cusums().values(), default=0.0) < 0.5 * LIMIT


@pytest.mark.parametrize("name", NAMES)
def test_a_sensor_that_is_far_off_is_named_within_hours_and_no_other(name):
    off = only(name, 8.0 * OWN[NAMES.index(name)])
    watch = learned().through(quiet(3, 0.5) + off)
    assert watch.raised == [f"irregular.{name}"]
    assert "more" in watch.detail[f"irregular.{name}"]


@pytest.mark.slow
def test_quiet_days_raise_nothing():
    assert Watched().through(quiet(5, 5.0)).raised == []


@pytest.mark.slow
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_drift_raises_its_sensor_alone_and_within_days(way):
    days = 6
    drift = np.linspace(0.0, way * 0.1 * days, days * DAY)[:, None] * only("depth-1", 1.0)
    watch = learned().through(quiet(7, days) + drift)
    assert watch.raised == ["irregular.depth-1"]
    assert ("more" if way > 0.0 else "less") in watch.detail["irregular.depth-1"]


def test_a_sensor_that_is_usually_off_by_as_much_is_not_raised():
    assert Watched().through(quiet(9, 3.0) + only("depth-2", 0.8 * OWN[1])).raised == []


def turning(days: float, seed: int = 51) -> list[ResidualBlock]:
    """Blocks in a tide that turns round, in which shackle-1 is off by the current's direction."""
    found = list[ResidualBlock]()
    for number, error in enumerate(quiet(seed, days)):
        angle = 2.0 * np.pi * number / 24.8
        current = (0.5 + 0.2 * np.sin(number / 100.0)) * np.array([np.cos(angle), np.sin(angle)])
        off = 2.5 * np.cos(angle) - 1.5 * np.sin(2.0 * angle)
        seen = block(error + only("shackle-1", off * OWN[3]))
        found.append(replace(seen, current=current))
    return found


def test_the_baseline_finds_how_a_sensor_s_offset_turns_with_the_current():
    blocks = turning(10.0)
    baseline = Baseline().of(blocks[0], SETTINGS)
    for seen in blocks[: 8 * DAY]:
        baseline = baseline.updated(seen, [], SETTINGS, quiet=ALL)
    late = blocks[8 * DAY :]
    shift = np.array([baseline.shift(seen, SETTINGS).mean[3] for seen in late])
    residual = np.array([seen.residual[3] for seen in late])
    assert np.std(residual - shift) < 0.6 * np.std(residual)
    still = np.array([baseline.shift(seen, SETTINGS).mean[0] for seen in late])
    assert np.abs(still).max() < 0.5 * OWN[0]


def test_a_baseline_that_was_saved_without_harmonics_goes_on_and_so_does_an_alarm():
    parted = learned().through(quiet(45, 1.0) + cut(7))
    now, rows = parted.detector.baseline, 2 * len(NAMES)
    covariance = as_tuples(np.array(now.covariance)[:rows, :rows])
    before = replace(
        parted.detector, baseline=replace(now, size=now.size[:rows], covariance=covariance)
    )
    seen = block((quiet(47, 0.1) + cut(7))[0])
    after = before.updated(seen, ACE, SETTINGS, active=parted.active)
    assert after.cusums()["bridle.bridle-8"] > LIMIT
    assert len(after.baseline.size) == len(now.size)
    for alarm in ("net.net", "irregular.depth-1"):
        changed = before.after_change(alarm, SETTINGS)
        assert changed.updated(seen, ACE, SETTINGS, active=parted.active).baseline.sensors == NAMES


@pytest.mark.slow
def test_the_alarm_of_a_repaired_sensor_clears_within_two_days():
    watch = learned().through(quiet(11, 1.0) + only("depth-1", 10.0 * OWN[0]))
    assert watch.active == {"irregular.depth-1"}
    watch.through(quiet(13, 2.0))
    assert watch.active == set()
    assert watch.raised == ["irregular.depth-1"]


@pytest.mark.slow
@pytest.mark.parametrize("seed", [41, 43])
def test_a_shackle_that_is_noisy_at_spring_tides_alarms_at_the_first_of_them_alone(seed):
    days = 20
    spring = np.arange(days * DAY) % (5 * DAY) < 2 * DAY
    more = noise(seed, days * DAY, memory=0.8, size=4.0) * only("shackle-4", 1.0)
    watch = learned().through(quiet(seed + 1, days) + spring[:, None] * more)
    assert watch.raised == ["irregular.shackle-4"]


@pytest.mark.parametrize(
    ("name", "quiet_days", "found"),
    [("shackle-4", 0.02, False), ("shackle-4", 2.0, True), ("depth-1", 0.02, True)],
)
def test_only_a_carried_over_sensor_may_be_off_in_its_first_hours(name, quiet_days, found):
    off = 8.0 * only(name, OWN[NAMES.index(name)])
    watch = Watched().through(quiet(51, quiet_days)).through(quiet(53, 0.25) + off)
    assert watch.raised == ([f"irregular.{name}"] if found else [])


def test_an_alarm_that_clears_makes_its_sensor_noisier_and_no_other():
    watch = learned().through(quiet(11, 1.0) + only("depth-1", 10.0 * OWN[0]))
    before = watch.detector.baseline.mean_square
    after = watch.detector.updated(
        block(np.zeros(8)), ACE, SETTINGS, active=frozenset()
    ).baseline.mean_square
    assert after[0] > 0.9 * SETTINGS.cleared_factor * before[0]
    np.testing.assert_allclose(after[1:], before[1:], rtol=0.05)


def test_a_sensor_that_was_stuck_is_no_noisier_when_its_alarm_clears():
    watch = learned()
    stuck = replace(watch.detector, active=("irregular.depth-1",))
    after = stuck.updated(block(np.zeros(8)), ACE, SETTINGS, active=frozenset())
    assert after.baseline.mean_square[0] <= watch.detector.baseline.mean_square[0]


def test_sensors_that_fail_one_after_the_other_each_raise_an_alarm():
    first, then = only("depth-1", 8.0 * OWN[0]), only("shackle-4", 8.0 * OWN[6])
    watch = learned().through(quiet(15, 0.5) + first).through(quiet(16, 0.5) + first - then)
    assert watch.raised == ["irregular.depth-1", "irregular.shackle-4"]


def test_the_other_bridles_of_a_corner_take_over_what_one_bore():
    for bridle in range(ACE.bridle_count):
        shares = load_shares(ACE, bridle, SETTINGS)
        assert shares[bridle] == -1.0
        assert (shares[ACE.bridle_corner != ACE.bridle_corner[bridle]] == 0.0).all()
    # Near settled cages with that bridle cut, whose neighbours take 0.49 each, or 1.2 and -0.26.
    assert load_shares(ACE, 7, SETTINGS)[[6, 8]] == pytest.approx([0.49, 0.49], abs=0.05)
    assert load_shares(ACE, 8, SETTINGS)[[7, 6]] == pytest.approx([1.2, -0.26], abs=0.3)


@pytest.mark.parametrize("bridle", [6, 7, 8, 9, 10])
def test_a_parted_bridle_is_found_by_its_own_shackle_and_its_neighbours(bridle):
    watch = learned().through(quiet(17, 1.0) + cut(bridle))
    assert watch.raised == [f"bridle.{ACE.bridle_names[bridle]}"]


def test_a_shackle_that_reads_nothing_while_its_neighbours_are_as_usual_is_no_parted_bridle():
    watch = learned().through(quiet(19, 1.0) + only("shackle-2", -TENSION[7]))
    assert watch.raised == ["irregular.shackle-2"]


def test_the_alarm_of_a_repaired_bridle_clears_within_two_days():
    watch = learned().through(quiet(21, 1.0) + cut(7)).through(quiet(23, 2.0))
    assert watch.raised == ["bridle.bridle-8"]
    assert watch.active == set()


def test_one_shackle_at_a_corner_says_nothing_about_its_bridles():
    alone = replace(block(np.zeros(8)), sensors=(*NAMES[:4], *"abcd"))
    named = {one.alarm for one in hypotheses(alone, ACE, SETTINGS)}
    assert not any(name.startswith("bridle") for name in named)
    assert "net.net" in named


def test_a_hole_that_some_sensors_feel_is_the_net_s_and_no_sensor_s():
    felt = np.array([0.35, 0.35, 0.1, 0.0, 0.0, 0.25, 0.3, 0.3])
    watch = learned().through(quiet(24, 1.0)).through(quiet(25, 3.0), lost=felt)
    assert watch.raised == ["net.net"]


def test_a_cleaned_net_is_the_net_s_though_depths_change_by_more_than_their_gradients_say():
    # A net that was lifted by its fouling falls by some metres, and the gradient of its depths is
    # small where it was lifted (truth 46 of the family).
    fell = OWN * [30.0, 15.0, 8.0, -0.5, -0.5, -0.5, 0.0, -0.5]
    watch = learned().through(quiet(24, 0.5)).through(quiet(25, 3.0), halved=fell)
    assert watch.raised == ["net.net"]
    assert watch.through(quiet(26, 6.0)).active == set()
    watch = learned()
    watch.detector = watch.detector.after_change("net.net", SETTINGS)
    assert "net.net" not in watch.through(quiet(25, 3.0), halved=fell).raised


def test_a_higher_limit_raises_nothing_and_a_larger_weight_raises_sooner():
    off = quiet(3, 0.5) + only("depth-1", 8.0 * OWN[0])
    watch = learned()
    watch.settings = replace(SETTINGS, limit=1e4)
    assert watch.through(off).raised == []
    blocks = []
    for weight in (SETTINGS.block_weight, 1.0):
        watch = learned()
        watch.settings = replace(SETTINGS, block_weight=weight)
        before = watch.blocks
        while not watch.raised:
            watch.through([off[watch.blocks - before]])
        blocks.append(watch.blocks - before)
    assert blocks[1] < blocks[0]


def lasting(seed: int, days: float, memory: float) -> np.ndarray:
    """Quiet residuals, and at depth-1 more of them, which last."""
    more = noise(seed, round(days * DAY), memory=memory)
    return quiet(seed + 1, days) + more * only("depth-1", 1.0)


def test_in_waves_residuals_that_last_count_as_more_noise():
    more = list[float]()
    for memory in (0.0, 0.9):
        watch = Watched().through(lasting(61, 20.0, memory))
        assert watch.raised == []
        rough, calm = (
            watch.detector.baseline.shift(
                replace(block(np.zeros(8)), in_waves=waves), SETTINGS
            ).covariance
            for waves in (True, False)
        )
        more.append((rough - calm)[0, 0] / OWN[0] ** 2)
    assert 0.0 <= more[0] < 0.5
    assert more[1] > 1.0


def test_in_waves_a_sensor_that_is_off_is_found():
    watch = learned()
    watch.in_waves = True
    watch.through(quiet(63, 1.0) + only("depth-1", 6.0 * OWN[0]))
    assert watch.raised == ["irregular.depth-1"]


@pytest.mark.parametrize("alarm", ["irregular.depth-1", "net.net"])
def test_the_long_run_variance_of_a_sensor_with_an_alarm_stays(alarm):
    watch = learned()
    before = watch.detector.baseline.long_run_variance
    detector = watch.detector
    for _ in range(DAY):
        off = block(only("depth-1", 5.0 * OWN[0]) + only("depth-2", 2.0 * OWN[1]))
        detector = detector.updated(off, ACE, SETTINGS, active=frozenset({alarm}))
    after = detector.baseline.long_run_variance
    assert after[0] == before[0]
    assert (after[1] == before[1]) == (alarm == "net.net")


def test_a_baseline_that_was_saved_without_a_long_run_variance_begins_with_the_prior():
    watch = learned()
    old = replace(watch.detector.baseline, running_mean=(), long_run_variance=())
    after = replace(watch.detector, baseline=old).updated(
        block(np.zeros(8)), ACE, SETTINGS, active=frozenset()
    )
    np.testing.assert_allclose(after.baseline.long_run_variance, SETTINGS.mean_square, rtol=0.01)
    assert after.baseline.mean_square != old.with_priors(SETTINGS).long_run_variance


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_a_setting_that_is_no_size_is_refused_by_its_name(value):
    with pytest.raises(InputError, match=r"water_sd = .* the default, 0\.1"):
        FaultDetectorSettings(water_sd=value)


def test_growth_that_adds_drag_raises_nothing():
    assert learned().through(quiet(27, 3.0), lost=-0.15).raised == []


def test_three_sensors_are_enough_to_say_which_of_them_is_wrong():
    watch = Watched().through(quiet(29, 2.0), NAMES[:3])
    assert watch.raised == []
    watch.through(quiet(31, 0.5) + only("depth-1", 8.0 * OWN[0]), NAMES[:3])
    assert watch.raised == ["irregular.depth-1"]


def detector(**cusums: float) -> FaultDetector:
    """A detector with evidence for sensors and bridles, by names with underscores."""
    evidence = {
        name.replace("__", ".").replace("_", "-"): Evidence(
            cusum=value, size=(1.0,), covariance=((1.0,),)
        )
        for name, value in cusums.items()
    }
    monitors = {name: SensorMonitor() for name in NAMES}
    return FaultDetector(monitors=monitors, evidence=evidence)


def raised(state: FaultDetector) -> dict[str, str]:
    found = ((one.alarm, one.value, one.detail) for one in state.inputs(ACE, SETTINGS))
    return {alarm: detail for alarm, value, detail in found if value is not None and value >= 1.0}


def test_a_hypothesis_that_leads_is_raised_at_the_limit_and_one_that_does_not_waits():
    lead = detector(bridle__bridle_8=LIMIT + LEAD, irregular__shackle_2=LIMIT)
    assert [*raised(lead)] == ["bridle.bridle-8"]
    near = detector(bridle__bridle_8=LIMIT + LEAD, irregular__shackle_2=LIMIT + 1.0)
    assert raised(near) == {}
    assert raised(detector(bridle__bridle_8=LIMIT - 0.1)) == {}


def test_hypotheses_that_stay_close_raise_one_alarm_that_names_both():
    near = detector(bridle__bridle_12=LIMIT + 3.0, irregular__shackle_5=LIMIT + 1.0)
    assert raised(replace(near, waited=SETTINGS.lead_blocks - 1)) == {}
    details = raised(replace(near, waited=SETTINGS.lead_blocks))
    assert [*details] == ["bridle.bridle-12"]
    assert "shackle-5" in details["bridle.bridle-12"]


def test_evidence_starts_again_where_other_sensors_have_level_2():
    before = learned().through(quiet(33, 0.2) - only("depth-1", 1.5)).detector
    seen = block(np.zeros(8))
    cut_off = ("received", "residual", "own_sd", "carried", "gradient", "half_drag")
    four = {name: getattr(seen, name)[:4] for name in cut_off}
    fewer = replace(seen, sensors=NAMES[:4], **four)
    after = before.updated(fewer, ACE, SETTINGS, active=frozenset({"irregular.depth-1"}))
    assert before.cusums()["irregular.depth-1"] > LIMIT
    assert after.cusums().get("irregular.depth-1", 0.0) == 0.0
    assert after.baseline.sensors == NAMES[:4]


def test_the_memory_of_a_quiet_week_and_of_a_parted_bridle_survive_a_restart():
    state = learned().through(quiet(33, 0.5) + cut(7)).detector
    book = replace(AlarmBook.new(), detector=state)
    assert AlarmBook.from_json(book.to_json()) == book


def reading(minutes: float, metres: float, flag: Flag = Flag.GOOD) -> Sample:
    return Sample(
        stream="depth-1",
        t=NOON + timedelta(minutes=minutes),
        values={"depth_m": metres},
        flags={"depth_m": flag},
    )


def test_a_sensor_that_repeats_itself_is_stuck_and_one_that_does_not_is_not():
    still = moving = seldom = SensorMonitor()
    for minutes in range(0, 40, 2):
        still = still.extended(reading(minutes, 14.0), 14.0)
        moving = moving.extended(reading(minutes, 14.0 + 0.01 * (minutes % 3)), 14.0)
    for minutes in (0, 20, 40):
        seldom = seldom.extended(reading(minutes, 14.0), 14.0)
    assert still.is_stuck(SETTINGS)
    assert not moving.is_stuck(SETTINGS)
    assert not seldom.is_stuck(SETTINGS)


def test_a_reading_that_failed_its_checks_is_the_latest_and_not_averaged():
    monitor = SensorMonitor().extended(reading(0, 90.0, Flag.FAIL), 14.0)
    assert monitor.latest == NOON
    assert monitor.count == 0


UNEVEN = 0.5 * np.array([1.2, 0.9, 0.5, 1.1, 0.3, 1.0, 1.3, 0.7])


@pytest.mark.parametrize("seed", [33, 35, 37])
def test_a_cleaning_looks_like_a_hole_unless_it_was_written_down(seed):
    assert learned().through(quiet(seed, 3.0), lost=UNEVEN).raised == ["net.net"]
    watch = learned()
    watch.detector = watch.detector.after_change("net.net", SETTINGS)
    assert watch.through(quiet(seed, 3.0), lost=UNEVEN).raised == []


@pytest.mark.parametrize("seed", [39, 41, 43])
def test_a_moved_sensor_is_irregular_unless_that_was_written_down_and_others_stay_watched(seed):
    moved = quiet(seed, 3.0) + only("depth-1", 8.0 * OWN[0])
    assert learned().through(moved).raised == ["irregular.depth-1"]
    watch = learned()
    watch.detector = watch.detector.after_change("irregular.depth-1", SETTINGS)
    assert watch.through(moved).raised == []
    assert watch.through(moved[:DAY] + cut(7)).raised == ["bridle.bridle-8"]


def test_a_parted_bridle_goes_on_showing_after_a_cleaning_and_a_net_alarm_does_not():
    parted = quiet(45, 2.0) + cut(7)
    watch = learned().through(parted)
    assert watch.active == {"bridle.bridle-8"}
    watch.detector = watch.detector.after_change("net.net", SETTINGS)
    assert watch.through(parted).active == {"bridle.bridle-8"}
    torn = learned().through(quiet(47, 3.0), lost=UNEVEN)
    assert torn.active == {"net.net"}
    torn.detector = torn.detector.after_change("net.net", SETTINGS)
    assert torn.through(quiet(49, 1.0), lost=UNEVEN).active == set()
