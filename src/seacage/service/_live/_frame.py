"""What changes on the page, as one binary message: a header, the net, and the state as JSON."""

import struct
from enum import IntFlag

import numpy as np
from jaxtyping import Float

from seacage.service._schemas._state import State
from seacage.twin import Answered

MEDIA_TYPE = "application/vnd.seacage.frame"  # of a frame in an HTTP answer
_HEADER = struct.Struct("<4sHHdIIff")
_MAGIC, _VERSION, _ALIGNED = b"SCFR", 2, 8
_FINEST = 1e-6  # a unit of nothing would divide by nothing [m]


class Flags(IntFlag):
    """What a frame says of itself."""

    LIVE = 0
    VALID = 1
    IN_DOMAIN = 2
    PAST = 4
    WHAT_IF = 8
    NO_SPREAD = 16


def frame_of(
    # The same twice: for people, and in SI
    state: State,
    answered: Answered,
    rest_position: Float[np.ndarray, "node 3"],  # that the page adds the displacement to [m]
    *,
    about: Flags = Flags.LIVE,  # whether this is the past, or what would be
) -> bytes:
    """Say all that changes on the page, little-endian, each section aligned to 8 bytes.

    The header: ``SCFR``, version (u16), flags (u16), time in ms since 1970 UTC (f64), nodes
    (u32), bytes of the JSON (u32), metres per unit of displacement and of spread (f32 each).
    Then int16 displacement, x y z of each node in turn; uint8 spread, empty where the flag
    ``NO_SPREAD`` says that none is known; the state. Both units follow the largest number of the
    frame, so that none is cut off.
    """
    answer = answered.answer
    displacement, sigma = np.zeros((0, 3)), np.zeros(0)
    if state.valid:
        displacement, about = answer.node_position[0] - rest_position, about | Flags.VALID
    if state.shape.interval_reason:
        about |= Flags.NO_SPREAD
    elif state.valid:
        sigma = answer.node_std[0].max(axis=1)
    if state.in_domain:
        about |= Flags.IN_DOMAIN
    moved_by, moved = _in_units(displacement, np.dtype("<i2"))
    spread_by, spread = _in_units(sigma, np.dtype("u1"))
    words = state.model_dump_json().encode()
    t_ms, nodes = state.t.timestamp() * 1e3, len(displacement)
    header = _HEADER.pack(_MAGIC, _VERSION, about, t_ms, nodes, len(words), moved_by, spread_by)
    return b"".join((header, _pad(moved), _pad(spread), words))


def _in_units(metres: np.ndarray, kind: np.dtype[np.integer]) -> tuple[float, bytes]:
    """Give the unit [m] that lets the largest just fit, and the numbers in it."""
    largest = float(np.abs(metres).max(initial=0.0))
    unit = float(np.float32(max(largest / np.iinfo(kind).max, _FINEST)))
    return unit, np.rint(metres / unit).astype(kind).tobytes()


def _pad(section: bytes) -> bytes:
    return section + bytes(-len(section) % _ALIGNED)
