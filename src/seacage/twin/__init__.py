"""The live loop as pure functions: sample in, events out."""

__all__: list[str] = []
