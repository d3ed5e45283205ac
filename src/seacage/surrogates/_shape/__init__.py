"""Gaussian processes of a net's whole shape, by node or by PCA mode, and its symmetry."""
