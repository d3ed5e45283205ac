"""Loads of lines in waves: their mean, their scatter, their largest and their wear."""

from seacage.surrogates._loads._load_gp import FittedLoadGP, LoadGP
from seacage.surrogates._loads._loads import LoadCases, LoadPrediction, Loads

__all__ = ["FittedLoadGP", "LoadCases", "LoadGP", "LoadPrediction", "Loads"]
