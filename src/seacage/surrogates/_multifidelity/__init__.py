"""Levels of fidelity, each a Gaussian process of its inputs and of the level below."""

from seacage.surrogates._multifidelity._batch import BatchedLevels
from seacage.surrogates._multifidelity._nargp import AR1, NARGP, FittedNARGP

__all__ = ["AR1", "NARGP", "BatchedLevels", "FittedNARGP"]
