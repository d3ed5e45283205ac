"""The paper's study, before anything is simulated."""

from datetime import UTC, datetime

import pytest

from seacage.campaigns import generated_current
from seacage.conventions import Origin
from seacage.records import FieldRecord
from seacage.studies._paper._study import _first_half


@pytest.mark.parametrize(
    ("hour", "days", "teaching"),
    [(0, 48.0, 24), (23, 1.5, 2), (1, 1.5, 1)],
)
def test_the_first_half_ends_at_the_midnight_nearest_to_the_middle(tmp_path, hour, days, teaching):
    start = datetime(2020, 1, 18, hour, tzinfo=UTC)
    FieldRecord(
        cage="ace",
        buoy=generated_current(0, start=start, days=days),
        sensors={},
        origin=Origin.VIRTUAL_FIELD,
    ).write(tmp_path)
    assert _first_half(tmp_path) == teaching
