"""A graph convolutional network over a cage's nodes."""

from seacage.surrogates._gcn._gcn import GCN, FittedGCN

__all__ = ["GCN", "FittedGCN"]
