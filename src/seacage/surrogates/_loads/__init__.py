"""Loads of lines in waves: their mean, their scatter, their largest and their wear."""
