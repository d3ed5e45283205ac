"""Models that learn a simulator, and what a sensor adds to it."""

__all__: list[str] = []
