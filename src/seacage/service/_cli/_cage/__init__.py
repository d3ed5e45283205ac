"""The commands for a cage's file."""
