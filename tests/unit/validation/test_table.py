"""The table says what was compared, and what does not hold."""

import csv
import io
import json
import math

import pytest

from validation import Kind, Row, Section
from validation._sections import failures
from validation._table import as_csv, as_json, markdown, shown


def row(**changed):
    return Row(
        **{
            "what": "drag",
            "unit": "kN",
            "reference": 2.0,
            "ours": 2.04,
            "kind": Kind.MEASURED,
            "source": "a tank",
            "tolerance": 0.1,
            "reason": "5 %",
            **changed,
        }
    )


def table(*rows):
    section = Section(title="Loads", about="What pulls.", rows=lambda: rows)
    return {"Loads": (section, rows)}


def test_the_page_says_reference_source_ours_tolerance_and_verdict():
    page = markdown(table(row()))
    assert "## Loads\n\nWhat pulls.\n" in page
    assert "| drag | 2 kN | measured; a tank | 2.04 kN | ± 0.1 kN: 5 % | yes |" in page
    assert "| [Loads](#loads) | 1 | 1 | 0 | 0 |" in page
    assert "What we miss" not in page


def test_the_page_reports_a_miss_and_why():
    page = markdown(table(row(ours=3.0, must_hold=False, note="other gear")))
    assert "| **no** (may miss), note 1 |" in page
    assert "\n\n1. other gear\n" in page


def test_a_note_that_rows_share_is_reported_once():
    rows = [row(what=what, note="a pond") for what in ("drag", "lift")]
    assert markdown(table(*rows)).count("a pond") == 1


def test_the_page_begins_with_what_is_missed_and_why():
    rows = [row(what=what, ours=9.0, must_hold=False, note="a pond") for what in ("drag", "lift")]
    page = markdown(table(row(what="weight"), *rows))
    assert "- *drag, and 1 more.* a pond" in page
    assert page.index("What we miss") < page.index("## Loads")


def test_a_row_that_was_not_computed_shows_no_number():
    page = markdown(table(row(ours=None, note="no file")))
    assert "| – | ± 0.1 kN: 5 % | –, note 1 |" in page
    assert "| [Loads](#loads) | 1 | 0 | 0 | 1 |" in page


def test_only_rows_that_must_hold_fail():
    bad, excused = row(ours=9.0), row(ours=9.0, must_hold=False)
    assert failures(table(row(), bad, excused, row(ours=None))) == [bad]


@pytest.mark.parametrize(
    ("span", "text"),
    [
        (2.0, "2"),
        (-0.12345, "−0.1235"),
        (123456.0, "123456"),
        (1.2e-7, "1.2·10^−7"),
        ((1.0, 2.0), "1 to 2"),
        ((-math.inf, 2.0), "≤ 2"),
        ((0.5, math.inf), "≥ 0.5"),
    ],
)
def test_numbers_are_shown_to_four_digits(span, text):
    assert shown(span) == text


def test_json_and_csv_keep_all_digits_and_mark_open_ends():
    rows = table(row(reference=(-math.inf, 1.0 / 3.0)), row(what="lift", ours=None))
    (first, second) = json.loads(as_json(rows))["Loads"]
    assert first["reference"] == [None, 1.0 / 3.0]
    assert (first["holds"], second["ours"], second["holds"]) == ("no", None, "–")
    lines = list(csv.DictReader(io.StringIO(as_csv(rows))))
    assert float(lines[0]["reference_high"]) == 1.0 / 3.0
    assert (lines[0]["reference_low"], lines[1]["ours_low"]) == ("", "")
