"""Loads of lines in waves: both levels, and waves that stand for what is not measured."""
