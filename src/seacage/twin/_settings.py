"""Settings of the live twin that are saved with it: timeouts of its streams, fault detection."""

import math
from dataclasses import dataclass, fields

from seacage.conventions import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class StreamTimeouts:
    """Timeouts of a twin's streams, and the rate at which its intervals adapt.

    Parameters
    ----------
    stale_after_s
        Longest time for which a buoy's value is held [s]. The default suits the sparse records of
        coastal buoys, where it also spans the longest gaps.
    sensor_silent_after_s
        Timeout of a cage sensor [s].
    disorder_s
        Time within which samples without flags may come out of order [s]; a later one is
        checked alone.
    future_s
        A sample further ahead of the clock has a wrong time [s].
    adapt_rate
        Rate of adaptation of the intervals: step of the logarithm of their width per reading
        that counts [-]; 0 leaves them as trained.
    adapt_every_s
        Time between readings that count [s].
    """

    stale_after_s: float = 10800.0
    sensor_silent_after_s: float = 900.0
    disorder_s: float = 600.0
    future_s: float = 60.0
    adapt_rate: float = 0.01
    adapt_every_s: float = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultDetectorSettings:
    """Numbers by which the fault detector averages readings and compares hypotheses.

    The defaults were tuned on settled virtual fields of cage ``ace``, without waves
    (``docs/alarms.md``). Where real failures are on record, tune them again. Standard deviations
    without a unit of their own are in those of the sensor's residual. All numbers are above 0.

    Parameters
    ----------
    block_s
        Length of a block [s]; a mean over half an hour holds little of eddies and waves.
    least_readings, least_sensors
        Least readings of a sensor in a block, and least sensors: with fewer, the faulty one of
        them cannot be identified.
    stuck_s
        Time after which a repeated value is a stuck sensor [s]: a live one is too noisy for it.
    stuck_readings
        Least repetitions of a stuck sensor; one with a slow rate needs longer than ``stuck_s``.
    water_sd
        Standard deviation of each component of the current at the cage about the buoy's, over
        half an hour [m/s]. Too large a value does little harm: the sensors then find the current.
    current_step
        Step of the central difference over the current, to either side [m/s].
    own_share, carried_share
        Fraction of a sensor's residual standard deviation that is independent of the other
        sensors [-], where its interval was calibrated on its own readings and where it was carried
        over. The remainder is current that the buoy did not measure, which all sensors share. A
        training window of some hours does not show the independent fraction, so there all of it
        counts.
    degrees_of_freedom
        Of the t distribution of a block's residuals [-].
    offset_sd, drag_sd
        Prior standard deviations of a sensor's offset, and of the relative change of the drag
        that it responds to [-]. Training windows are short and nets get fouled.
    direction_sd
        Prior standard deviation of the first two harmonics of a sensor's offset over the direction
        of the current, in one of 0.5 m/s; in proportion to its speed. Training windows see few
        directions.
    baseline_memory
        Blocks after which the baseline forgets: sixteen weeks. A change within days is none of it.
    mean_square, mean_square_memory
        Prior mean square of a sensor's own residuals, in its own variances; and the blocks over
        which it is estimated: half a week.
    most_square
        Largest square of a residual that one block adds to that.
    noisy
        That mean square from which on it is estimated while evidence rises too, of a sensor whose
        interval was carried over: half a day of training may have shown too little of its noise.
    carried_factor, carried_blocks
        Factor on the variance of such a sensor when it is first evaluated [-]; and the time
        constant, in blocks, with which it falls to 1: half a day.
    cleared_factor
        Factor on that mean square, or on its prior where that is larger, of a sensor whose alarm
        has cleared [-], so that the same noise does not raise it again and again.
    inflation
        Factor on that mean square, because residuals last from one block to the next [-]; the
        twin's own variance is the least.
    calm
        Share of the limit below which the baseline is updated [-].
    drift, drift_sd, drift_walk
        A sensor that begins to drift: prior mean and standard deviation of its offset, and the
        standard deviation of the offset's change from block to block.
    wide_sd, offset_walk
        A faulty sensor with any offset: its prior standard deviation; and that of its change from
        block to block where the offset is constant.
    own_load_sd, corner_load_sd, far_load_sd
        Standard deviations of the change of load at a parted bridle's own shackle, those of its
        corner and the others, about the change by balance of forces, over the bridle's load [-].
    corner_stiffness
        Stiffness that holds a corner in its place when a bridle parts, over a bridle's [-]; fitted
        to settled shapes with a bridle cut. The frame's own is larger, but the collar moves too,
        and slack lines do not hold it.
    drag_loss, drag_loss_sd
        Mean and standard deviation, from sensor to sensor, of the relative loss of drag by a hole
        large enough for an alarm [-]: a hole acts on the sensors near it and on the lines that
        bear the load there. Fouling adds drag and never takes any away.
    half_loss, half_loss_sd
        Mean and standard deviation, from sensor to sensor, of the shift by a cleaning over that
        by the loss of half the drag [-].
    net_change_sd, net_change_blocks
        Standard deviation of the relative change of drag by another or a cleaned net, the same at
        all sensors [-]; and blocks after it in which another one is not expected: four weeks.
    running_mean_blocks, long_run_memory, long_run_factor
        Time constant, in blocks, of the running mean that shows how long a sensor's own residuals
        last: six hours; the blocks over which their long-run variance is estimated by it: two
        weeks; and the factor on that variance where a twin has waves among its inputs [-], as what
        these leave unexplained lasts as long as the sea state.
    block_weight
        Weight of a block's log-likelihood ratio [-], as residuals of neighbouring blocks are
        correlated.
    evidence_memory
        Blocks after which evidence is forgotten: three days. A fault goes on showing.
    active_widening
        Factor on the prior standard deviation of an active alarm's shift [-], so that no other
        alarm is raised for residuals that it may explain.
    limit
        Log-likelihood ratio (CUSUM) at which the alarm of a hypothesis is raised [-].
    lead
        Least difference to the CUSUM of the next alarm [-]; with less, none is raised yet.
    lead_blocks
        Blocks after which the best is raised without that lead, its detail naming the next: a day.
    most_limits
        Largest CUSUM over the limit [-], so that an alarm clears soon after the repair.
    """

    block_s: float = 1800.0
    least_readings: int = 3
    least_sensors: int = 3
    stuck_s: float = 1800.0
    stuck_readings: int = 6
    water_sd: float = 0.1
    current_step: float = 0.03
    own_share: float = 0.5
    carried_share: float = 1.0
    degrees_of_freedom: float = 8.0
    offset_sd: float = 0.5
    drag_sd: float = 0.1
    direction_sd: float = 0.5
    baseline_memory: float = 5376.0
    mean_square: float = 0.5
    mean_square_memory: float = 168.0
    most_square: float = 9.0
    noisy: float = 1.0
    carried_factor: float = 8.0
    carried_blocks: float = 24.0
    cleared_factor: float = 4.0
    inflation: float = 2.0
    calm: float = 0.25
    drift: float = 1.0
    drift_sd: float = 0.5
    drift_walk: float = 0.05
    wide_sd: float = 10.0
    offset_walk: float = 0.1
    own_load_sd: float = 0.15
    corner_load_sd: float = 0.25
    far_load_sd: float = 0.15
    corner_stiffness: float = 0.05
    drag_loss: float = 0.25
    drag_loss_sd: float = 0.15
    half_loss: float = 0.8
    half_loss_sd: float = 0.4
    net_change_sd: float = 0.4
    net_change_blocks: int = 1344
    running_mean_blocks: float = 12.0
    long_run_memory: float = 672.0
    long_run_factor: float = 1.5
    block_weight: float = 0.6
    evidence_memory: float = 144.0
    active_widening: float = 3.0
    limit: float = 28.0
    lead: float = 10.0
    lead_blocks: int = 48
    most_limits: float = 2.0

    def __post_init__(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            if not 0.0 < value < math.inf:
                raise InputError(
                    f"FaultDetectorSettings: {one.name} = {value:g} is not finite or not above 0. "
                    f"Give a number such as the default, {one.default:g}."
                )
