"""A virtual field: a truth that the low fidelity misses, seen by imperfect sensors."""
