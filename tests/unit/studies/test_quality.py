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
    for outcome in (
        "3 of 5 readings are flagged (60 %): 1 fail, 1 missing, 1 suspect.",
        '<b>Spike</b><span class="flag fail">fail</span> 1 × depth_m</p>',
        "<p>2018-01-26 12:02 UTC</p>",
        "The first: depth_m = 30 stands out by 22.9 from its neighbours",
        '<b>Missing value</b><span class="flag missing">missing</span>',
        "&lt;2&gt; rows repeat a time.",
        "data:image/svg+xml;base64,",
        "5, of which 2 carry no flag",
    ):
        assert outcome in page


def test_the_gravest_comes_first_and_runs_are_reported_with_their_length():
    depth = 7.0 + 0.01 * np.arange(400.0) % 0.5
    depth[100:120] = np.nan
    depth[300:303] = np.nan
    depth[350] = -99.0
    page = quality_page([check_record(record(depth))])
    assert page.index("Gross range") < page.index("Missing value")
    assert "13:40 to 2018-01-26 17:02 UTC, in 2 runs; the longest, 19 min, from 2018-01" in page


def test_quantities_with_the_same_trouble_share_a_line():
    time = instant(NOON) + np.array([0, 720, 720 * 100]) * np.timedelta64(1, "s")
    values = {"current_speed_m_s": np.array([0.1, 0.2, 0.3]), "current_to_deg": np.full(3, 9.0)}
    buoy = Record(stream="buoy-1", time=time, values=values, origin=Origin.MEASURED)
    page = quality_page([check_record(buoy)])
    assert page.count("<b>Gap</b>") == 1
    assert "1 × current_speed_m_s, current_to_deg" in page


def test_many_streams_are_summed_up_in_a_table():
    streams = [
        replace(check_record(record([7.0, 7.1, depth])), stream=f"depth-{k}")
        for k, depth in enumerate([7.2, -99.0, 7.2, 7.2], start=1)
    ]
    page = quality_page(streams).replace("\n", "")
    assert "<h1>Quality of 4 streams</h1>" in page
    assert "1 of 12 readings are flagged (8.3 %): 1 fail." in page
    assert (
        "<th>depth-2</th><td>3</td><td>1</td><td>0</td><td>0</td><td>33 %</td>"
        "<td>2018-01-26 12:02</td>"
    ) in page
    assert "<td>0 %</td><td>–</td>" in page


def test_a_sound_record_and_an_empty_one_have_their_page():
    page = quality_page([check_record(record([7.0, 7.1])), record([])])
    assert "None of 2 readings is flagged." in page
    assert page.count("No test found anything.") == 2
    assert "no reading" in page
