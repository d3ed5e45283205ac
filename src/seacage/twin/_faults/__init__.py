"""Fault detection: which sensor drifts, whether a bridle has parted or the net is torn."""

from seacage.twin._faults._detector import FaultDetector

__all__ = ["FaultDetector"]
