"""Cages whose twins step on a clock: what they answer, their alarms and their past."""
