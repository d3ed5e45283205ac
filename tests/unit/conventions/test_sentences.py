import pytest

from seacage.conventions import fill_sentence


@pytest.mark.parametrize(
    ("template", "values", "sentence"),
    [
        ("{Source} is silent", {"source": "buoy-1"}, "Buoy-1 is silent"),
        ("{load_share} of {source}", {"source": "a", "load_share": 0.846}, "85 % of a"),
        ("for {value_s}", {"value_s": 7200.0}, "for 2 h"),
        ("{factor} times", {"factor": 2.34}, "2.3 times"),
        ("Missing: {sensors}.", {"sensors": ["depth-1", "depth-2"]}, "Missing: depth-1, depth-2."),
        ("", {"source": "store"}, ""),
    ],
)
def test_a_value_is_written_as_the_unit_in_its_key_says(template, values, sentence):
    assert fill_sentence(template, values) == sentence
