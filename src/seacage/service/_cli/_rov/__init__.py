"""The commands for ROV pilots."""
