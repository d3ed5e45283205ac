"""Of all that looks wrong, the one cause: a sensor, a bridle or the net."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Self

from seacage.cage import Cage
from seacage.twin._alarm_numbers import Number
from seacage.twin._events import Answered
from seacage.twin._irregular import STUCK_S, Sense, unheard
from seacage.twin._irregular_block import Block, Open, closed
from seacage.twin._irregular_bridle import WHOLE_LIMIT, Parting, judged_bridles
from seacage.twin._irregular_drag import Drag
from seacage.twin._irregular_sensor import judged_sensors, wandering
from seacage.twin._state import TwinState
from seacage.twin._twin import Twin

_LOSS = "A large hole does that, and so does a cleaning."


@dataclass(frozen=True, slots=True, kw_only=True)
class Suspicion:
    """What the tests for irregularity remember.

    Parameters
    ----------
    senses
        By stream, the buoy's too.
    opened
        The block that is being averaged.
    partings
        Evidence by bridle.
    drag
        Evidence that the net has lost drag.
    """

    senses: Mapping[str, Sense] = field(default_factory=dict[str, Sense])
    opened: Open = field(default_factory=Open)
    partings: Mapping[str, Parting] = field(default_factory=dict[str, Parting])
    drag: Drag = field(default_factory=Drag)

    def interrupted(self) -> Self:
        """Return the same without the block that was being averaged."""
        senses = {name: sense.interrupted() for name, sense in self.senses.items()}
        return replace(self, senses=senses, opened=Open())

    def followed(
        self, twin: Twin, state: TwinState, answered: Answered, *, active: frozenset[str]
    ) -> Self:
        """Take in what was heard since the last look, and judge a block that has ended.

        Parameters
        ----------
        twin, state, answered
            The twin, its state, and its word now.
        active
            The alarms that are raised: what they explain is not suspicious once more.
        """
        opened = self.opened.ticked(answered)
        over = self.opened.number is not None and opened.number != self.opened.number
        after = self._judged(twin, answered, active) if over else self
        return replace(after, senses=_heard(after.senses, state), opened=opened)

    def _judged(self, twin: Twin, answered: Answered, active: frozenset[str]) -> Self:
        block = closed(self.opened, self.senses, twin, answered)
        begun = replace(
            self, senses={name: sense.begun_anew() for name, sense in self.senses.items()}
        )
        buoy = self.senses.get(twin.buoy)
        if block is None or (buoy is not None and buoy.stuck):
            return begun
        distrusted = distrusted_in(self.senses, active)
        broken = _kind(active, "bridle")
        cut = _beside(twin.cage, block, broken)
        rows = [row for row, name in enumerate(block.sensors) if name not in distrusted | cut]
        anew = bool(broken | _kind(active, "net"))
        return replace(
            begun,
            senses=judged_sensors(
                begun.senses, block, distrusted=distrusted, beside=cut, anew=anew
            ),
            partings=judged_bridles(self.partings, block, twin.cage, self.senses, distrusted, cut),
            drag=self.drag.judged(block, rows) if rows else self.drag,
        )

    def numbers(self, cage: Cage, *, active: frozenset[str]) -> Iterator[Number]:
        """Say at the end of a block what is to be raised: the cause alone.

        Parameters
        ----------
        cage
            Says which shackles and bridles share a corner.
        active
            The alarms that are raised.
        """
        partings = _cause_at_each_corner(self.partings, cage, _kind(active, "bridle"))
        broken = {name for name, value in partings.items() if value is not None and value >= 1.0}
        broken |= _kind(active, "bridle")
        for name, value in partings.items():
            yield Number(alarm=f"bridle.{name}", value=value)
        lost = None if broken else self.drag.value
        yield Number(alarm="net.net", value=lost, detail=_LOSS)
        changed = self.drag.undecided or (lost or 0.0) >= 1.0 or bool(broken | _kind(active, "net"))
        undecided = {name for name, parting in self.partings.items() if parting.undecided}
        for name, sense in self.senses.items():
            corner = _corner(cage, name)
            value = None if changed or corner & undecided else wandering(sense)
            detail = _wandered(sense, self._instead(cage, corner))
            yield _stuck(name, sense) or Number(
                alarm=f"irregular.{name}", value=value, detail=detail
            )

    def stuck(self) -> Iterator[Number]:
        """Say at any time which streams repeat themselves."""
        for name, sense in self.senses.items():
            if (number := _stuck(name, sense)) is not None:
                yield number

    def _instead(self, cage: Cage, corner: frozenset[str]) -> str:
        """Name a bridle without a shackle that may have parted where a shackle seems wrong."""
        bare = corner - {cage.bridle_names[one.bridle] for one in cage.shackles}
        likely = (name for name in bare if self._likely(name))
        return min(likely, default="")

    def _likely(self, bridle: str) -> bool:
        return bridle in self.partings and self.partings[bridle].whole > WHOLE_LIMIT


def distrusted_in(senses: Mapping[str, Sense], active: frozenset[str]) -> frozenset[str]:
    """Name the streams whose readings are not to be believed."""
    stuck = {name for name, sense in senses.items() if sense.stuck}
    return frozenset(stuck | _kind(active, "irregular"))


def _heard(senses: Mapping[str, Sense], state: TwinState) -> dict[str, Sense]:
    after = dict(senses)
    for name, stream in state.streams.items():
        sense = after.get(name, Sense())
        # As trained: the intervals that follow the readings would follow a drift too.
        tracked = state.tracked.get(name)
        for sample in unheard(stream, sense.heard):
            sense = sense.taken(sample, tracked.said if tracked else None)
        after[name] = sense
    return after


def _beside(cage: Cage, block: Block, broken: set[str]) -> frozenset[str]:
    """Name the shackles at the corner of a parted bridle, its own among them."""
    return frozenset(name for name in block.sensors if _corner(cage, name) & broken)


def _cause_at_each_corner(
    partings: Mapping[str, Parting], cage: Cage, broken: set[str]
) -> dict[str, float | None]:
    """Return the evidence of every bridle, but None where another at its corner is the cause.

    A parted bridle makes its neighbours look a little as if they had.
    """
    corners = {name: cage.bridle_corner[cage.bridle_names.index(name)] for name in partings}
    cause = {corners[name]: name for name in broken & partings.keys()}
    for name in sorted(partings, key=lambda one: partings[one].whole, reverse=True):
        cause.setdefault(corners[name], name)
    return {
        name: parting.value if cause[corners[name]] == name else None
        for name, parting in partings.items()
    }


def _stuck(name: str, sense: Sense) -> Number | None:
    if not sense.stuck:
        return None
    detail = f"It has repeated the same reading for {sense.still_s / 60.0:.0f} min."
    return Number(alarm=f"irregular.{name}", value=sense.still_s / STUCK_S, detail=detail)


def _wandered(sense: Sense, instead: str) -> str:
    way = "more" if sense.above > sense.below else "less"
    said = f"It reads {way} than the twin and the other sensors let expect."
    if instead:
        said += f" It may be right if {instead}, which has no shackle, has parted."
    return said


def _corner(cage: Cage, shackle: str) -> frozenset[str]:
    """Name the bridles at a shackle's corner; none of another sensor."""
    line = next((one.bridle for one in cage.shackles if one.name == shackle), None)
    if line is None:
        return frozenset()
    same = cage.bridle_corner == cage.bridle_corner[line]
    return frozenset(name for name, here in zip(cage.bridle_names, same, strict=True) if here)


def _kind(active: frozenset[str], kind: str) -> set[str]:
    """Name the sources of the raised alarms of a kind."""
    return {name.partition(".")[2] for name in active if name.partition(".")[0] == kind}
