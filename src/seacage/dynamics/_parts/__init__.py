"""A cage or a structure as the solvers see it: nodes and the parts between them."""
