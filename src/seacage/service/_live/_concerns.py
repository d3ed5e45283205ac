"""Why a cage is not called well, though no alarm may be active."""

from collections.abc import Iterator
from datetime import timedelta
from typing import Literal

from seacage.service._live._answers import loads_of, usable_value
from seacage.service._schemas._state import Concern, State
from seacage.twin import ADAPTATION_BLOCK, AlarmPolicy, TwinState

# Factor on a sensor's interval from which on the twin no longer fits its cage (decision 75) [-]
WIDEST = 2.0


def concerns_of(
    state: State, memory: TwinState, *, policy: AlarmPolicy, least_volume: float
) -> Iterator[Concern]:
    """Say what of a cage is beyond its limits, or not measured; the gravest comes first."""
    limits = {one.name: policy.limit(f"load.{one.name}").raise_at for one in state.bridles}
    shares = [(share - limits[name], share, name, by) for share, name, by in loads_of(state)]
    over, share, bridle, source = max(shares, default=(-1.0, 0.0, "", ""))
    if over >= 0.0:
        words = f"{bridle} bears {_percent(share)} of its capacity, {source}"
        yield _beyond("load", "Load at its limit", words, limits[bridle])
    if state.volume_fraction is not None and state.volume_fraction < least_volume:
        words = f"The net holds {_percent(state.volume_fraction)} of its volume in still water"
        yield _beyond("volume", "Volume low", words, least_volume)
    names = {one.name for one in state.sensors}
    factor = {name: one.factor for name, one in memory.tracked.items() if name in names}
    if wide := sorted(name for name in factor.keys() - memory.silent if factor[name] >= WIDEST):
        words = (
            f"Readings of {', '.join(wide)} miss the twin's intervals so often that these are "
            f"widened {max(factor[name] for name in wide):.1f} times: the cage, or a sensor, has "
            "changed since training. Train the twin anew."
        )
        yield Concern(kind="fit", title="Twin no longer fits", message=words)
    measured = {name for name in names if _is_measured(memory, state, name, policy)}
    if not measured:
        words = "No sensor has given a valid reading within its timeout: all is predicted."
        yield Concern(kind="measured", title="Nothing measured", message=words)
    elif missing := sorted(memory.streams.keys() & names - measured):
        words = f"No valid reading within its timeout: {', '.join(missing)}."
        yield Concern(kind="measured", title="Partly measured", message=words)


def _beyond(kind: Literal["load", "volume"], title: str, words: str, limit: float) -> Concern:
    return Concern(kind=kind, title=title, message=f"{words}; {_percent(limit)} is the limit.")


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %"


def _is_measured(memory: TwinState, state: State, sensor: str, policy: AlarmPolicy) -> bool:
    """Whether a sensor has given a valid reading within its timeout, as every start remembers."""
    timeout = timedelta(seconds=policy.limit(f"silent.{sensor}").raise_at)
    known = [one.sample for one in memory.streams.get(sensor, ()) if one.sample.t <= state.t]
    recent = [one for one in known if one.t >= state.t - min(timeout, ADAPTATION_BLOCK)]
    within = recent or [one for one in known[-1:] if one.t >= state.t - timeout]
    return any(usable_value(one) is not None for one in within)
