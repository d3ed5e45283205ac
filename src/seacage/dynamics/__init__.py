"""Loads on the cage in the sea, and the shapes and tensions that answer them."""

from seacage.dynamics._catenary import catenary
from seacage.dynamics._screens import LAWS, Law, aarsnes, kristiansen_faltinsen, loland
from seacage.dynamics._settle import Response, net_load, rest_shape, settle

__all__ = [
    "LAWS",
    "Law",
    "Response",
    "aarsnes",
    "catenary",
    "kristiansen_faltinsen",
    "loland",
    "net_load",
    "rest_shape",
    "settle",
]
