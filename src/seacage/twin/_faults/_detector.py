"""Of all that may explain what the sensors read, what is told: the best, if it leads."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Self

from seacage.cage import Cage
from seacage.twin._alarms import Number
from seacage.twin._events import Answered
from seacage.twin._faults._baseline import Usual
from seacage.twin._faults._evidence import Belief, Beliefs, told_already, weighed
from seacage.twin._faults._hypotheses import explanations
from seacage.twin._faults._residuals import Block, Open, closed
from seacage.twin._faults._sensor import STUCK_S, Sense, unheard
from seacage.twin._state import TwinState
from seacage.twin._twin import Twin

LIMIT = 20.0
"""Logarithm of the odds at which an explanation is told."""

LEAD = 10.0
"""And by how much it has to be ahead of the next alarm's, or it is not yet told."""

PATIENCE = 48
"""Blocks after which the best is told though it does not lead, with a word of the next: a day."""

CLEARLY = 2.0
"""Evidence is held at so many limits, so that what was mended is believed soon."""

CALM = 0.25
"""Share of the limit below which nothing is suspected, and habits are learned."""

_JUDGED = ("irregular", "bridle", "net")
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
    usual
        The sensors' habits.
    beliefs
        By explanation: "irregular.depth-1 more" is one of the alarm "irregular.depth-1".
    told
        The raised alarms that the last block was judged beside.
    waited
        For how many blocks something has been beyond the limit without being told.
    """

    senses: Mapping[str, Sense] = field(default_factory=dict[str, Sense])
    opened: Open = field(default_factory=Open)
    usual: Usual = field(default_factory=Usual)
    beliefs: Beliefs = field(default_factory=dict[str, Belief])
    told: tuple[str, ...] = ()
    waited: int = 0

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
        after = self._ended(twin, answered, active) if over else self
        return replace(after, senses=_heard(after.senses, state, answered.t), opened=opened)

    def _ended(self, twin: Twin, answered: Answered, active: frozenset[str]) -> Self:
        block = closed(self.opened, self.senses, twin, answered)
        senses = {name: sense.begun_anew() for name, sense in self.senses.items()}
        begun = replace(self, senses=senses)
        buoy = self.senses.get(twin.buoy)
        if block is None or (buoy is not None and buoy.stuck):
            return begun
        return begun.judged(block, twin.cage, active=active)

    def judged(self, block: Block, cage: Cage, *, active: frozenset[str]) -> Self:
        """Weigh all explanations by one more block.

        Parameters
        ----------
        block, cage
            What was read, and where.
        active
            The alarms that are raised.
        """
        told = tuple(sorted(name for name in active if name.partition(".")[0] in _JUDGED))
        before = self._beside(told, block)
        among = list(explanations(block, cage))
        beliefs = weighed(before.beliefs, block, before.usual, among, told)
        after = replace(before, beliefs=_held(beliefs, told))
        best = max((value for _, value in after.suspects()), default=0.0)
        if best < CALM * LIMIT:
            known = told_already(beliefs, among, told)
            after = replace(after, usual=before.usual.learned(block, known.values()))
        return replace(after, waited=before.waited + 1 if best >= LIMIT else 0)

    def _beside(self, told: tuple[str, ...], block: Block) -> Self:
        """Begin anew, but for what is told, where that has changed; all of it for other sensors."""
        usual = self.usual.of(block.sensors)
        if usual is not self.usual:
            return replace(self, usual=usual, beliefs={}, told=told, waited=0)
        if told == self.told:
            return replace(self, usual=usual)
        if any(not name.startswith("irregular") for name in {*told} ^ {*self.told}):
            usual = usual.doubted()
        beliefs = {name: one for name, one in self.beliefs.items() if _alarm(name) in told}
        return replace(self, usual=usual, beliefs=beliefs, told=told, waited=0)

    def evidence(self) -> dict[str, float]:
        """Return for each alarm the evidence of its best explanation."""
        most = dict[str, float]()
        for name, belief in self.beliefs.items():
            most[_alarm(name)] = max(most.get(_alarm(name), 0.0), belief.evidence)
        return most

    def suspects(self) -> list[tuple[str, float]]:
        """Return alarms that are not raised and their evidence, the most first."""
        found = ((name, value) for name, value in self.evidence().items() if name not in self.told)
        return sorted(found, key=lambda one: -one[1])

    def numbers(self, cage: Cage) -> Iterator[Number]:
        """Say at the end of a block what is to be raised: one cause, if one is clear.

        Parameters
        ----------
        cage
            Says which bridles and sensors there are.
        """
        for name in (
            *(f"bridle.{bridle}" for bridle in cage.bridle_names),
            "net.net",
            *(f"irregular.{stream}" for stream in self.senses),
        ):
            yield self._stuck(name) or self._number(name)

    def stuck(self) -> Iterator[Number]:
        """Say at any time which streams repeat themselves."""
        for stream in self.senses:
            if (number := self._stuck(f"irregular.{stream}")) is not None:
                yield number

    def _number(self, name: str) -> Number:
        value = self.evidence().get(name, 0.0)
        detail = self._detail(name)
        if name in self.told:
            return Number(alarm=name, value=value / LIMIT, detail=detail)
        others = [(other, least) for other, least in self.suspects() if other != name]
        second, next_best = others[0] if others else ("", 0.0)
        lead = (value - next_best) / LEAD
        if lead < 1.0 and value >= max(LIMIT, next_best) and self.waited >= PATIENCE:
            return Number(
                alarm=name, value=value / LIMIT, detail=f"{detail} {_instead(second)}".strip()
            )
        return Number(alarm=name, value=max(0.0, min(value / LIMIT, lead)), detail=detail)

    def _detail(self, name: str) -> str:
        kind = name.partition(".")[0]
        if kind == "irregular":
            return self._wandered(name)
        return _LOSS if kind == "net" else ""

    def _wandered(self, alarm: str) -> str:
        here = [one for name, one in self.beliefs.items() if _alarm(name) == alarm]
        if not here:
            return ""
        (size, *_) = max(here, key=lambda one: one.evidence).size
        way = "more" if size > 0.0 else "less"
        return f"It reads {way} than the twin and the other sensors let expect."

    def _stuck(self, name: str) -> Number | None:
        kind, _, stream = name.partition(".")
        sense = self.senses.get(stream)
        if kind != "irregular" or sense is None or not sense.stuck:
            return None
        detail = f"It has repeated the same reading for {sense.still_s / 60.0:.0f} min."
        return Number(alarm=name, value=sense.still_s / STUCK_S, detail=detail)


def distrusted_in(senses: Mapping[str, Sense], active: frozenset[str]) -> frozenset[str]:
    """Name the streams whose readings are not to be believed."""
    stuck = {name for name, sense in senses.items() if sense.stuck}
    wrong = {name.partition(".")[2] for name in active if name.startswith("irregular.")}
    return frozenset(stuck | wrong)


def _heard(senses: Mapping[str, Sense], state: TwinState, now: datetime) -> dict[str, Sense]:
    after = dict(senses)
    for name, stream in state.streams.items():
        sense = after.get(name, Sense())
        # As trained: the intervals that follow the readings would follow a drift too.
        tracked = state.tracked.get(name)
        said = tracked.expected[0] if tracked and tracked.expected else None
        for sample in unheard(stream, sense.heard, now):
            sense = sense.taken(sample, said)
        after[name] = sense
    return after


def _held(beliefs: Beliefs, told: tuple[str, ...]) -> dict[str, Belief]:
    """Take from all that is not told as much as the best of it has too much, so that leads stay."""
    most = CLEARLY * LIMIT
    others = (one.evidence for name, one in beliefs.items() if _alarm(name) not in told)
    best = max(others, default=0.0)
    after = dict[str, Belief]()
    for name, one in beliefs.items():
        ahead = one.evidence if _alarm(name) in told else best
        held = one.less(max(0.0, ahead - most))
        if held.evidence > 0.0:
            after[name] = held
    return after


def _alarm(explanation: str) -> str:
    return explanation.partition(" ")[0]


def _instead(alarm: str) -> str:
    """Name what else may be the cause."""
    kind, _, source = alarm.partition(".")
    if kind == "bridle":
        return f"Or {source} has parted: the sensors do not tell which."
    if kind == "net":
        return "Or the net is torn: the sensors do not tell which."
    return f"Or {source} reads irregularly: the sensors do not tell which."
