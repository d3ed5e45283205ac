"""Intervals made as wide as observations ask, and residuals modelled in time."""
