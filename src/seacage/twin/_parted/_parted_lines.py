"""Level 1 of the loads that are left to the other lines where one has parted."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.surrogates import Domain, LoadChange, Symmetry
from seacage.twin._lines._line_loads import HeldSeas, LineLoads
from seacage.twin._lines._site_waves import mean_over_members
from seacage.twin._metocean import Metocean
from seacage.twin._parted._if_parted import IfParted

# Quantities of the damaged cage that are learned beside the loads, as ``IfParted`` has them
STATE = ("volume_share", "clearance", "drift")

NO_PARTED_LINES = (
    "This twin has not learned what happens if a line parts. Run `seacage campaign run "
    "--parted-lines` with the plan and the seed of its campaign, and train it with --parted."
)
"""Why a twin has no answer about a parted line, and what to do."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PartedKind:
    """What one line leaves to the others, which its images under a symmetry leave likewise."""

    line: str  # that had parted in the simulations
    surrogate: LoadChange  # of the change of all lines' loads, and of ``STATE``
    domain: Domain  # of the currents and waves that it was trained on, as that of ``LineLoads``
    # Cases that were learned from, and all: the others ended without an answer
    learned: int
    simulated: int
    campaign_sha256: str  # hash of their campaign


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PartedLines:
    """Surrogates of a damaged cage: one for each line that its symmetry tells apart."""

    kinds: tuple[PartedKind, ...]  # of which each stands for its line's images too
    # Of the lines' places; None where there is none, and each line stands for itself
    symmetry: Symmetry | None

    def predict(
        self, cage: Cage, whole: LineLoads, water: Metocean, lines: Sequence[str] | None = None
    ) -> IfParted:
        """Loads of each sea if each line parted, from one evaluation of the whole cage's.

        What is not known of the waves is taken from those of the site, as ``LineLoads.predict``
        does: the mean over a period that is not known, and of other unknown waves means alone.

        ``cage``: whose lines they are. ``whole``: loads of the cage as it is. ``water``: the seas.
        ``lines``: that part, one at a time; None for all that were learned.

        Raises InputError: a line that was not learned.
        """
        places = list(self._places(whole.names))
        known = [whole.names[line] for _, line, _ in places]
        wanted = sorted(known, key=whole.names.index) if lines is None else list(lines)
        for name in wanted:
            if name not in known:
                raise InputError(
                    f"If {name!r} parted: this twin has learned no such line. It has: "
                    f"{', '.join(sorted(known, key=whole.names.index))}."
                )
        members, row = whole.members(water)
        seas = whole.hold(members)
        loads = whole.surrogate.predict(seas.x, hs=seas.hs, spread=False)
        before = np.stack([loads.mean.mean, loads.maximum_3h.mean])
        shape = len(members), len(wanted)
        load, state = np.full((2, *shape, len(whole.names)), np.nan), np.full((3, *shape), np.nan)
        inside = np.zeros(shape, dtype=bool)
        for kind, line, image in places:
            if whole.names[line] in wanted:
                at = wanted.index(whole.names[line])
                inside[:, at] = seas.inside & kind.domain.contains(seas.places)
                load[:, :, at], state[:, :, at] = self._after(kind, image, seas, before)
                load[:, :, at, line] = 0.0
        inside = mean_over_members(inside, row) >= 0.5
        load, state = (
            np.stack([mean_over_members(one, row) for one in part]) for part in (load, state)
        )
        load[:, ~inside] = state[:, ~inside] = load[1, whole.gaps(water)[0]] = np.nan
        return IfParted(
            cage=cage,
            parted=tuple(wanted),
            kinds=tuple(whole.kinds[whole.names.index(name)] for name in wanted),
            line_names=whole.names,
            line_kinds=whole.kinds,
            mean=load[0],
            maximum_3h=load[1],
            **dict(zip(STATE, state, strict=True)),
            in_domain=inside,
            reason=whole.reasons(water, mean_over_members(seas.inside, row) >= 0.5),
        )

    def _places(self, names: Sequence[str]) -> Iterator[tuple[PartedKind, int, int]]:
        """Each line that can part: its kind, its number, and an image that puts the kind there."""
        for kind in self.kinds:
            own = names.index(kind.line)
            if self.symmetry is None:
                yield kind, own, 0
                continue
            image, line = np.nonzero(self.symmetry.source == own)
            _, first = np.unique(line, return_index=True)
            for at in first:
                yield kind, int(line[at]), int(image[at])

    def _after(
        self, kind: PartedKind, image: int, seas: HeldSeas, before: Float[np.ndarray, "2 case line"]
    ) -> tuple[Float[np.ndarray, "2 case line"], Float[np.ndarray, "3 case"]]:
        """Mean and largest loads, and the state, without one image of a kind's line."""
        if self.symmetry is None:
            x, there, here = seas.x, slice(None), slice(None)
        else:
            back = self.symmetry.back(image)
            x = self.symmetry.turned(seas.x, back)
            there, here = self.symmetry.source[back], self.symmetry.source[image]
        mean, maximum = before[:, :, there]
        mean, maximum, state = kind.surrogate.predict(x, hs=seas.hs, mean=mean, maximum=maximum)
        return np.stack([mean, maximum])[:, :, here], state.T
