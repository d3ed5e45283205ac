"""Whole experiments, from campaign to report."""

__all__: list[str] = []
