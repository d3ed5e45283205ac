"""Virtual fields of the family's cages, with the truth at the times that are scored."""

import argparse
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, VirtualField, generated_current, virtual_field
from seacage.records import Record
from seacage.studies._bench._cases import values_at
from seacage.studies._bench._scores import share_by_third
from seacage.studies._bench._study import Water

__all__ = ["Water", "field_of", "options_for", "scored_times", "share_by_third", "values_at"]

START, DAYS, SCORED_FROM = datetime(2020, 1, 18, tzinfo=UTC), 50.0, 25.0
EVERY = np.timedelta64(1800, "s")


def options_for(doc: str | None, *, truths: str) -> argparse.ArgumentParser:
    """Options that the scores of such fields share.

    ``doc``: of the script. ``truths``: numbers where none are given.
    """
    options = argparse.ArgumentParser(description=(doc or "").split("\n")[0])
    options.add_argument("campaign", type=Path)
    options.add_argument("out", type=Path)
    options.add_argument("--truths", type=_numbers, default=_numbers(truths))
    options.add_argument("--unseal", action="store_true")
    options.add_argument("--workers", type=int)
    return options


def _numbers(words: str) -> Sequence[int]:
    first, _, last = words.partition("-")
    return range(int(first), int(last or first) + 1)


def field_of(
    cage: Cage,
    number: int,
    water: Water,
    given: argparse.Namespace,
    *,
    name: str,
    profile: Literal["buoy", "cage"] | None = None,
) -> VirtualField:
    """A settled field of 50 days, kept in the output folder under a name.

    ``profile``: where an ADCP is; None for none.
    """
    return virtual_field(
        cage,
        generated_current(number, start=START, days=DAYS),
        hidden=TruthParameters.of_family(number, water=water, unseal=given.unseal),
        seed=number,
        method="settle",
        profile=profile,
        kept=given.out / name,
        workers=given.workers,
    )


def scored_times(buoy: Record) -> np.ndarray:
    """Every half hour of the last 25 days."""
    since = buoy.time - buoy.time[0]
    late = since >= np.timedelta64(int(86400 * SCORED_FROM), "s")
    return buoy.time[late & (since % EVERY == np.timedelta64(0))]
