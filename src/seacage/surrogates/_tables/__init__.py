"""Interpolation tables of fitted models, for answers in microseconds."""
