"""Labelled measurements and simulations: their schemas, readers, checks and stores."""

__all__: list[str] = []
