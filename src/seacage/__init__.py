"""A multifidelity digital twin of aquaculture net cages."""

from importlib.metadata import version

__version__ = version("seacage")
