"""The page's binary message read back, as the page reads it."""

import json
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Frame:
    """Contents of a frame, in metres."""

    version: int
    flags: int
    t_ms: float
    displacement: np.ndarray
    sigma: np.ndarray
    unit: float
    sigma_unit: float
    state: dict[str, Any]


def decode_frame(message: bytes) -> Frame:
    magic, version, flags, t, nodes, words, unit, sigma_unit = struct.unpack_from(
        "<4sHHdIIff", message
    )
    assert magic == b"SCFR"
    moved = 32
    spread = moved + aligned(6 * nodes)
    spreads = 0 if flags & 16 else nodes
    start = spread + aligned(spreads)
    assert len(message) == start + words
    displacement = np.frombuffer(message, "<i2", 3 * nodes, moved).reshape(-1, 3)
    return Frame(
        version=version,
        flags=flags,
        t_ms=t,
        displacement=displacement * unit,
        sigma=np.frombuffer(message, "u1", spreads, spread) * sigma_unit,
        unit=unit,
        sigma_unit=sigma_unit,
        state=json.loads(message[start:]),
    )


def aligned(size: int) -> int:
    return size + -size % 8
