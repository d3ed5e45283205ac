"""The page on quality: what, when, why, and the reader's notes."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.conventions import Origin
from seacage.records import Record, check_record, instant

pytest.importorskip("matplotlib")

from seacage.studies import quality_page

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)


def record(depth):
    time = instant(NOON) + np.arange(len(depth)) * np.timedelta64(60, "s")
    return Record(
        stream="depth-1", time=time, values={"depth_m": np.array(depth)}, origin=Origin.MEASURED
    )


def test_it_says_what_was_flagged_when_and_why():
    raw = replace(record([7.0, 7.1, 30.0, 7.1, np.nan]), notes=("<2> rows repeat a time.",))
    page = quality_page([check_record(raw)])
    for said in (
        "depth_m = 30 stands out by 22.9 from its neighbours",
        "<th>spike</th><td>depth_m</td><td>fail</td><td>1</td><td>2018-01-26 12:02</td>",
        "<th>missing value</th>",
        "&lt;2&gt; rows repeat a time.",
        "data:image/svg+xml;base64,",
        "5, of which 2 carry no flag",
    ):
        assert said in page


def test_a_sound_record_and_an_empty_one_have_their_page():
    page = quality_page([check_record(record([7.0, 7.1])), record([])])
    assert page.count("No test found anything.") == 2
    assert "no reading" in page
