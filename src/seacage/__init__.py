"""A multifidelity digital twin of aquaculture net cages."""
