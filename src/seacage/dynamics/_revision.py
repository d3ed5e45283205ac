"""Which physics this is: what was computed with another revision is not gone on with."""

PHYSICS = 2
"""Revision of the physics: raised by every change to a number (``changes/*.physics.md``)."""
