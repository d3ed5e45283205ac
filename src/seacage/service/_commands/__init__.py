"""The commands of the shell, one group per file."""
