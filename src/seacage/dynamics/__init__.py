"""Loads on the cage in the sea, and the shapes and tensions that answer them."""

__all__: list[str] = []
