"""Writes files as an RDI Workhorse does (PD0), in earth coordinates. Source of the layout:
Teledyne RD Instruments, WorkHorse Commands and Output Data Format."""

import struct
from datetime import datetime

import numpy as np


def ensemble(
    number: int,
    t: datetime,
    velocity: np.ndarray,  # (bin, 2) east, north [m/s], NaN where bad
    *,
    depth_m: float,
    first_bin_m: float,
    bin_m: float,
    up: bool,
) -> bytes:
    """One profile, with its checksum."""
    bins = len(velocity)
    fixed = struct.pack(
        "<HBBBBBBBBHHHBBBBHBBBBhhBBHHBBBBH8sHBBLB",
        *(0x0000, 50, 40, 0b0100_0001, 0x80 if up else 0x00, 0, 0, 4, bins, 45),
        *(round(100 * bin_m), 44, 1, 64, 9, 0, 2000, 0, 1, 0, 0b0001_1111, 0, 0, 0, 0),
        *(round(100 * first_bin_m), 100, 0, 5, 50, 0, 10, b"\0" * 8, 0, 255, 0, 1234, 20),
    )
    clock = (t.year % 100, t.month, t.day, t.hour, t.minute, t.second, 0)
    variable = struct.pack(
        "<HH7BBHHHHhhhh3BBBB8sLHLLB8B",
        *(0x0080, number, *clock, 0, 0, 1500, round(10 * depth_m), 0, 0, 0, 35, 800),
        *(0, 0, 0, 0, 0, 0, b"\0" * 8, 0, 0, round(1000 * depth_m * 1.0055), 0, 0, 20, *clock),
    )
    raw = np.full((bins, 4), -32768, dtype="<i2")
    good = np.isfinite(velocity).all(axis=1)
    raw[good] = 0
    raw[good, :2] = np.rint(1000 * velocity[good])
    parts = [fixed, variable, struct.pack("<H", 0x0100) + raw.tobytes()]
    begin = 6 + 2 * len(parts)
    offsets = begin + np.cumsum([0, *map(len, parts)])
    head = struct.pack("<BBHBB", 0x7F, 0x7F, offsets[-1] + 2, 0, len(parts))
    body = head + offsets[:-1].astype("<u2").tobytes() + b"".join(parts) + b"\0\0"
    return body + struct.pack("<H", sum(body) & 0xFFFF)
