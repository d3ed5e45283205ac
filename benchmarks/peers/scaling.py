"""Inputs and outputs as the peers' guides ask for them, and back."""


def unit_inputs(levels):
    """A function to the box that level 1 spans, and the levels' inputs there."""
    lower, upper = levels[0][0].min(axis=0), levels[0][0].max(axis=0)
    return lambda x: (x - lower) / (upper - lower)


def standard_outputs(levels):
    """Each level's outputs with mean 0 and standard deviation 1, and the top level's own two."""
    scaled = [(y - y.mean()) / y.std() for _, y in levels]
    top = levels[-1][1]
    return scaled, top.mean(), top.std()
