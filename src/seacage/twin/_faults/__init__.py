"""Fault detection: which sensor drifts, whether a bridle has parted or the net is torn."""

from seacage.twin._faults._detector import FaultDetector
from seacage.twin._faults._fault_watch import FaultWatch, block_residuals, residual_blocks

__all__ = ["FaultDetector", "FaultWatch", "block_residuals", "residual_blocks"]
