"""Conformance suites and strategies for those who extend seacage."""

from seacage.testing._readers import check_reader
from seacage.testing._screen_laws import check_screen_law
from seacage.testing._stand_ins import (
    stand_in_campaign,
    stand_in_field,
    stand_in_seas,
    stand_in_twin,
)
from seacage.testing._surrogates import FittedSurrogate, check_surrogate

__all__ = [
    "FittedSurrogate",
    "check_reader",
    "check_screen_law",
    "check_surrogate",
    "stand_in_campaign",
    "stand_in_field",
    "stand_in_seas",
    "stand_in_twin",
]
