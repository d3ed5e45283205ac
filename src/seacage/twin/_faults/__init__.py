"""Fault detection: which sensor drifts, whether a bridle has parted or the net is torn."""

from seacage.twin._faults._detector import FaultDetector, faulty_streams

__all__ = ["FaultDetector", "faulty_streams"]
