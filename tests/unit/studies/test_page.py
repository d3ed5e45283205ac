"""The pages of reports."""

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from seacage.figures import shape_error_figure
from seacage.studies._page import render

FIGURE = shape_error_figure(np.array([0.5]), {"A": np.array([0.1])})
PARTS = "{% from 'parts.html' import bar, facts, picture, table %}"


@pytest.fixture
def filled(monkeypatch):
    """The text of a template that is given in words, filled."""
    from jinja2 import ChoiceLoader, DictLoader, PackageLoader

    def fill(template: str, /, **values: object) -> str:
        loader = ChoiceLoader(
            [DictLoader({"it": PARTS + template}), PackageLoader("seacage.studies")]
        )
        with monkeypatch.context() as patch:
            patch.setattr("jinja2.PackageLoader", lambda _: loader)
            return render("it", **values)

    return fill


def test_text_is_escaped_once_and_html_is_left_alone(filled):
    assert filled("<p>{{ text }}</p>", text="1 < 2") == "<p>1 &lt; 2</p>"
    made = filled("{{ facts(entries) }}", entries={"name": "a & b\nc"})
    assert "<dt>name</dt><dd>a &amp; b<br>c</dd>" in made


def test_the_caller_of_a_table_writes_its_rows(filled):
    made = filled(
        "{% call(one) table(['Sensor', 'MAE'], rows, 'All', last=last) %}<th>{{ one }}</th>"
        "{% endcall %}",
        rows=["depth-1"],
        last="",
    )
    assert "<tr><th>Sensor</th><th>MAE</th></tr>" in made
    assert "<tr><th>depth-1</th></tr>" in made
    assert made.count("<tr>") == 2


def test_a_bar_never_grows_beyond_its_room(filled):
    assert "width:25%" in filled("{{ bar(0.25) }}")
    assert "width:100%" in filled("{{ bar(3.0) }}")


def test_a_page_needs_nothing_beside_itself(filled):
    made = filled(
        "{% extends 'base.html' %}{% block content %}"
        "{% from 'parts.html' import picture %}"
        "{% call picture(figure, alternative) %}C{% endcall %}{% endblock %}",
        title="Title",
        figure=FIGURE,
        alternative='a "drawing"',
    )
    assert made.startswith("<!doctype html>")
    assert 'alt="a &#34;drawing&#34;"' in made
    assert 'src="data:image/svg+xml;base64,' in made
    assert "http" not in made
    assert "<script" not in made


def test_a_name_without_a_value_is_an_error(filled):
    from jinja2 import UndefinedError

    with pytest.raises(UndefinedError):
        filled("{{ missing }}")
