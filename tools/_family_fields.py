"""Virtual fields of the family's cages, with the truth at the times that are scored."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, VirtualField, Water, generated_current, virtual_field
from seacage.records import FieldRecord, Record
from seacage.studies._bench._cases import values_at
from seacage.studies._bench._scores import share_by_third

__all__ = ["Water", "field_of", "options_for", "scored_times", "share_by_third", "values_at"]

START, DAYS, SCORED_FROM = datetime(2020, 1, 18, tzinfo=UTC), 50.0, 25.0
EVERY = np.timedelta64(1800, "s")
_EXTRA = "extra-"  # before the names of the shackles that the twin does not see


def options_for(doc: str | None, *, truths: str) -> argparse.ArgumentParser:
    """Options that the scores of such fields share.

    ``doc``: of the script. ``truths``: numbers where none are given.
    """
    options = argparse.ArgumentParser(description=(doc or "").split("\n")[0])
    options.add_argument("campaign", type=Path)
    options.add_argument("out", type=Path)
    options.add_argument("--truths", type=numbers, default=numbers(truths))
    options.add_argument("--unseal", action="store_true")
    options.add_argument("--workers", type=int)
    return options


def numbers(words: str) -> Sequence[int]:
    """Numbers such as "1-3,7"."""
    spans = (part.partition("-") for part in words.split(","))
    return [one for a, _, b in spans for one in range(int(a), int(b or a) + 1)]


def field_of(
    cage: Cage,
    number: int,
    water: Water,
    given: argparse.Namespace,
    *,
    name: str,
    profile: Literal["buoy", "cage"] | None = None,
    hidden: TruthParameters | None = None,
    again: int = 0,
) -> VirtualField:
    """A settled field of 50 days, kept in the output folder under a name.

    ``profile``: where an ADCP is; None for none. ``hidden``: None for those of the number.
    ``again``: 1 and more for other weather and noise of the same cage.
    """
    seed = number + 1000 * again
    own = hidden or TruthParameters.of_family(number, water=water, unseal=given.unseal)
    return virtual_field(
        cage,
        generated_current(seed, start=START, days=DAYS),
        hidden=own,
        seed=seed,
        method="settle",
        profile=profile,
        kept=given.out / name,
        workers=given.workers,
    )


def with_every_shackle(cage: Cage) -> Cage:
    """Return the cage with a shackle on every bridle."""
    seen = {one.bridle for one in cage.shackle}
    others = (k for k in range(1, cage.bridle_count + 1) if k not in seen)
    extra = (replace(cage.shackle[0], name=f"{_EXTRA}{k}", bridle=k) for k in others)
    return replace(cage, shackle=(*cage.shackle, *extra))


def without_extra(record: FieldRecord) -> FieldRecord:
    """What the twin may see of a field with a shackle on every bridle."""
    seen = {name: one for name, one in record.sensors.items() if not name.startswith(_EXTRA)}
    return replace(record, sensors=seen)


def scored_times(buoy: Record) -> np.ndarray:
    """Every half hour of the last 25 days."""
    since = buoy.time - buoy.time[0]
    late = since >= np.timedelta64(int(86400 * SCORED_FROM), "s")
    return buoy.time[late & (since % EVERY == np.timedelta64(0))]
