"""How figures are written."""

import xml.etree.ElementTree as ET

import numpy as np

from seacage.figures import shape_error_figure, svg_text, write_figure


def figure():
    return shape_error_figure(np.array([0.2, 0.6]), {"A": np.array([0.1, 0.2])})


def test_the_same_figure_gives_the_same_bytes():
    first = svg_text(figure())
    assert first == svg_text(figure())
    assert ET.fromstring(first).tag.endswith("svg")


def test_the_ending_of_the_path_chooses_the_format(tmp_path):
    assert write_figure(figure(), tmp_path / "a.svg").read_text().startswith("<?xml")
    assert write_figure(figure(), tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_drawing_leaves_the_callers_settings_and_pyplot_alone():
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    before = mpl.rcParams.copy()
    svg_text(figure())
    assert mpl.rcParams.copy() == before
    assert not plt.get_fignums()
