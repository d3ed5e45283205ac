"""Quality control: its tests, their limits, and the one check by them."""

from seacage.records._quality._check import (
    AHEAD,
    Amendment,
    QualityState,
    Verdict,
    alike,
    amended,
    check_record,
    check_sample,
    is_evaluated,
    is_withdrawn,
    verdicts_on,
    withdrawn,
)
from seacage.records._quality._limits import (
    DEFAULT_LIMITS,
    GROUPS,
    Limits,
    Range,
    Season,
    Steadiness,
)
from seacage.records._quality._limits_file import read_limits

__all__ = [
    "AHEAD",
    "DEFAULT_LIMITS",
    "GROUPS",
    "Amendment",
    "Limits",
    "QualityState",
    "Range",
    "Season",
    "Steadiness",
    "Verdict",
    "alike",
    "amended",
    "check_record",
    "check_sample",
    "is_evaluated",
    "is_withdrawn",
    "read_limits",
    "verdicts_on",
    "withdrawn",
]
