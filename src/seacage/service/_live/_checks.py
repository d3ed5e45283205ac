"""What the checks remember of a cage's streams, while commits are still under way."""

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from seacage.records import Amendment, QualityState, Sample, check_sample

_Memory = Mapping[str, QualityState]


@dataclass(slots=True, kw_only=True, eq=False)
class Checked:
    """Samples on their way to the disk.

    Parameters
    ----------
    samples, amendments
        With their flags, and what they taught of samples before them.
    before
        What was remembered without them.
    kept
        Whether they are on disk.
    """

    samples: tuple[Sample, ...]
    amendments: tuple[Amendment, ...]
    before: _Memory
    kept: bool = False


class Checks:
    """Checks samples against those before them that are on disk or on their way there.

    What the disk refuses will be sent again, and must not be checked against itself; what was
    checked after it and came through stays remembered.

    Parameters
    ----------
    memory
        What is remembered of each stream.
    """

    def __init__(self, memory: _Memory) -> None:
        self._memory = memory
        self._asked: deque[Checked] = deque()  # in order, from the first that is under way

    def check(self, samples: Sequence[Sample]) -> Checked:
        """Check samples; to be followed by ``keep`` or ``forget``."""
        before = self._memory
        self._memory, flagged, amendments = _checked(before, samples)
        checked = Checked(samples=flagged, amendments=amendments, before=before)
        self._asked.append(checked)
        return checked

    def keep(self, checked: Checked) -> None:
        """They are on disk."""
        checked.kept = True
        self._drop_kept()

    def forget(self, checked: Checked) -> None:
        """They are not: remember all but them."""
        place = self._asked.index(checked)
        self._memory = checked.before
        for later in list(self._asked)[place + 1 :]:
            later.before = self._memory
            self._memory, _, _ = _checked(later.before, later.samples)
        del self._asked[place]
        self._drop_kept()

    def _drop_kept(self) -> None:
        # Those before the first that is under way can no longer be asked about.
        while self._asked and self._asked[0].kept:
            self._asked.popleft()


def _checked(
    before: _Memory, samples: Sequence[Sample]
) -> tuple[_Memory, tuple[Sample, ...], tuple[Amendment, ...]]:
    memory, flagged, amendments = dict(before), list[Sample](), list[Amendment]()
    for sample in samples:
        quality, one = check_sample(memory.get(sample.stream, QualityState()), sample)
        memory[sample.stream] = quality
        flagged.append(one)
        amendments += quality.amended
    return memory, tuple(flagged), tuple(amendments)
