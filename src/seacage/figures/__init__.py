"""Matplotlib figures of records, scores and states."""

__all__: list[str] = []
