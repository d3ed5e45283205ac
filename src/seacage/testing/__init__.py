"""Conformance suites and strategies for those who extend seacage."""

from seacage.testing._stand_ins import (
    stand_in_campaign,
    stand_in_field,
    stand_in_seas,
    stand_in_twin,
)

__all__ = ["stand_in_campaign", "stand_in_field", "stand_in_seas", "stand_in_twin"]
