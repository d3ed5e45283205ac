"""Sentences with values, which other languages can write anew from the same values."""

from collections.abc import Mapping, Sequence

from seacage.conventions._durations import duration_text

SentenceValue = str | float | Sequence[str]
"""A name, a number or several names; the unit of a number is in its key."""


def fill_sentence(template: str, values: Mapping[str, SentenceValue]) -> str:
    """Write a sentence with values in place of their keys in braces.

    ``template``: e.g. "{Source} has sent no sample for {value_s}."; a key with a capital letter
    stands for its value with one.
    ``values``: by key, whose end says how a number is written: ``load_share`` as a percentage,
    ``value_s`` as a duration, any other with one decimal.
    """
    texts = {key: _text_of(key, value) for key, value in values.items()}
    return template.format(**texts, **{_begin(key): _begin(one) for key, one in texts.items()})


def _text_of(key: str, value: SentenceValue) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, Sequence):
        return ", ".join(value)
    if key.endswith("_share"):
        return f"{100.0 * value:.0f} %"
    return duration_text(value) if key.endswith("_s") else f"{value:.1f}"


def _begin(text: str) -> str:
    return text[:1].upper() + text[1:]
