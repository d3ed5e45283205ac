"""Why a cage is not called well, though no alarm may be active."""

from collections.abc import Iterator
from datetime import timedelta

from seacage.conventions import SentenceValue, fill_sentence, read_packaged_table
from seacage.service._live._answers import loads_of, usable_value
from seacage.service._schemas._state import Concern, State
from seacage.twin import ADAPTATION_BLOCK, AlarmPolicy, TwinState

# Factor on a sensor's interval from which on the twin no longer fits its cage (decision 75) [-]
WIDEST = 2.0
_TEXTS: dict[str, dict[str, str]] = read_packaged_table("seacage.service._live", "concerns.toml")


def concerns_of(
    state: State, memory: TwinState, *, policy: AlarmPolicy, least_volume: float, unlike: str
) -> Iterator[Concern]:
    """Say what of a cage is beyond its limits, or not measured; the gravest comes first.

    ``unlike``: why the cage is unlike those of the family; "" where it is not.
    """
    limits = {one.name: policy.limit(f"load.{one.name}").raise_at for one in state.bridles}
    shares = [(share - limits[name], share, name, by) for share, name, by in loads_of(state)]
    over, share, line, shackle = max(shares, default=(-1.0, 0.0, "", ""))
    if over >= 0.0:
        about = {"line": line, "load_share": share, "limit_share": limits[line]}
        by_shackle = {"shackle": shackle} if shackle else {}
        yield _concern("load_measured" if shackle else "load_predicted", **about, **by_shackle)
    if state.volume_fraction is not None and state.volume_fraction < least_volume:
        yield _concern("volume", volume_share=state.volume_fraction, limit_share=least_volume)
    names = {one.name for one in state.sensors}
    factor = {name: one.factor for name, one in memory.tracked.items() if name in names}
    if wide := sorted(name for name in factor.keys() - memory.silent if factor[name] >= WIDEST):
        yield _concern("fit", sensors=wide, factor=max(factor[name] for name in wide))
    if unlike and state.valid:
        yield _concern("unlike")
    measured = {name for name in names if _is_measured(memory, state, name, policy)}
    if not measured:
        yield _concern("measured_none")
    elif missing := sorted(memory.streams.keys() & names - measured):
        yield _concern("measured_partly", sensors=missing)


def _concern(key: str, **values: SentenceValue) -> Concern:
    written = {name: fill_sentence(text, values) for name, text in _TEXTS[key].items()}
    about = {"kind": key.partition("_")[0], "key": key, "values": values}
    return Concern.model_validate(about | written)


def _is_measured(memory: TwinState, state: State, sensor: str, policy: AlarmPolicy) -> bool:
    """Whether a sensor has given a valid reading within its timeout, as every start remembers."""
    timeout = timedelta(seconds=policy.limit(f"silent.{sensor}").raise_at)
    known = [one.sample for one in memory.streams.get(sensor, ()) if one.sample.t <= state.t]
    recent = [one for one in known if one.t >= state.t - min(timeout, ADAPTATION_BLOCK)]
    within = recent or [one for one in known[-1:] if one.t >= state.t - timeout]
    return any(usable_value(one) is not None for one in within)
