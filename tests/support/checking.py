"""How annotations are checked while the tests run."""

from typing import Self

from beartype import BeartypeConf, FrozenDict, beartype

annotated = beartype(
    conf=BeartypeConf(
        is_pep484_tower=True,  # an int may stand for a float
        hint_overrides=FrozenDict({Self: object}),  # unknown to a lone method
    )
)
"""Checks the arguments and the result of what it decorates."""
