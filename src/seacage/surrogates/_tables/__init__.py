"""Interpolation tables of fitted models, for answers in microseconds."""

from seacage.surrogates._tables._region import Box, Disc
from seacage.surrogates._tables._table import Table, Tabulable

__all__ = ["Box", "Disc", "Table", "Tabulable"]
