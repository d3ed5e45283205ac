"""Levels of fidelity, each a Gaussian process of its inputs and of the level below."""
