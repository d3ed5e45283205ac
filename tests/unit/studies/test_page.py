"""The pieces of a report's page."""

import numpy as np

from seacage.figures import shape_error_figure
from seacage.studies._page import bar, facts, page, picture, table, tag


def test_text_is_escaped_once_and_html_is_left_alone():
    assert tag("p", "1 < 2") == "<p>1 &lt; 2</p>"
    assert tag("p", tag("b", "a & b")) == "<p><b>a &amp; b</b></p>"
    assert "a &amp; b" in facts({"name": "a & b"})


def test_the_first_cell_of_a_row_names_it():
    made = table(("Sensor", "MAE"), [("depth-1", "0.1")], caption="All")
    assert "<tr><th>depth-1</th><td>0.1</td></tr>" in made


def test_a_bar_never_grows_beyond_its_room():
    assert "width:25%" in bar(0.25)
    assert "width:100%" in bar(3.0)


def test_a_page_needs_nothing_beside_itself():
    figure = shape_error_figure(np.array([0.5]), {"A": np.array([0.1])})
    made = page("Title", picture(figure, caption="C", alternative='a "drawing"'))
    assert made.startswith("<!doctype html>")
    assert 'alt="a &quot;drawing&quot;"' in made
    assert 'src="data:image/svg+xml;base64,' in made
    assert "http" not in made
    assert "<script" not in made
