"""Conformance suites and strategies for those who extend seacage."""

__all__: list[str] = []
