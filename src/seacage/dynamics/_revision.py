"""Revision of the physics; a campaign is not continued under another revision."""

PHYSICS = 17
"""Revision of the physics: raised by every change to a number (``changes/*.physics.md``)."""
