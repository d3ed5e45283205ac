"""What is wrong in a cage's file, what is odd in it, and its derived numbers."""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from seacage.cage._cage import Cage
from seacage.cage._mooring_lines import mooring_lines
from seacage.cage._toml import Place, find_errors, lines_of
from seacage.conventions import GRAVITY, WATER_DENSITY, parse_toml, read_packaged_table


@dataclass(frozen=True, slots=True, kw_only=True)
class Remark:
    """A sentence on a cage's file, and the line that it is about, from 1."""

    line: int
    sentence: str


def cage_errors(text: str, *, source: str) -> list[Remark]:
    """Everything for which ``Cage.from_toml`` refuses a text, as far as it can be seen at once.

    Raises InputError: text that is no TOML, or a structure's.
    """
    table = parse_toml(text, source)
    if "ring" in table:
        Cage.from_toml(text, source=source)
    return _by_line(text, find_errors(Cage, table))


def cage_remarks(cage: Cage, text: str) -> list[Remark]:
    """Everything that is odd in a cage which can be read, by line of its text."""
    return _by_line(text, _odd(cage))


def cage_numbers(cage: Cage) -> dict[str, float]:
    """Numbers in still water that a cage's file does not hold, with the unit in the key."""
    collar, mesh, tube = cage.collar, cage.mesh, cage.sinker_tube
    round_m, span = 2.0 * math.pi * collar.radius, _bridle_spans(cage)
    slant = math.hypot(collar.radius, mesh.tip_depth - mesh.cylinder_depth)
    area = round_m * (mesh.cylinder_depth + slant / 2.0)
    netting = GRAVITY * (cage.netting.mass - cage.netting.displaced) * area
    lift = GRAVITY * (WATER_DENSITY * collar.pipe_displaced - collar.pipe_mass)
    deepest = max(mesh.tip_depth, mesh.cylinder_depth + tube.hung_below, cage.frame.depth)
    return {
        "circumference_m": round_m,
        "volume_m3": float(cage.volume(cage.design_position)),
        "netting_area_m2": area,
        "solidity": cage.netting.solidity,
        "netting_weight_n": netting,
        "weight_in_water_n": netting + round_m * tube.weight + cage.tip.weight,
        "collar_buoyancy_n": round_m * collar.pipes * lift,
        "water_below_m": cage.site.water_depth - deepest,
        "shortest_bridle_m": float(span.min()),
        "longest_bridle_m": float(span.max()),
        "nodes": cage.node_count,
        "bridles": cage.bridle_count,
        "lines": len(mooring_lines(cage, anchored=True).names),
        "sensors": len(cage.sensor_names),
    }


def _by_line(text: str, found: Iterator[tuple[Place, str]]) -> list[Remark]:
    remarks = [Remark(line=_line(text, place, one), sentence=one) for place, one in found]
    return sorted(remarks, key=lambda remark: remark.line)


def _line(text: str, place: Place, sentence: str) -> int:
    """The line of a key; for what several say that of the first which the sentence names."""
    lines, words, rows = lines_of(text), re.findall(r"\w+", sentence), text.splitlines()

    def order(at: Place) -> tuple[int, bool]:
        """Of keys of one name, as of sensors, that whose value is named too comes first."""
        value = rows[lines[at] - 1].partition("=")[2].partition("#")[0].strip()
        return words.index(str(at[-1])), value not in words

    keys = [at for at in lines if len(at) > 1 and at[: len(place)] == place != at]
    if len(place) < 2 and (named := [at for at in keys if at[-1] in words]):
        return lines[min(named, key=order)]
    return next(lines[place[:size]] for size in range(len(place), -1, -1) if place[:size] in lines)


def _bridle_spans(cage: Cage) -> np.ndarray:
    """Distance from the corner to the collar's node, bridle by bridle [m]."""
    ends = cage.corner_position[cage.bridle_corner] - cage.design_position[cage.bridle_nodes]
    return np.linalg.norm(ends, axis=1)


def _odd(cage: Cage) -> Iterator[tuple[Place, str]]:
    """Every remark with the place of the key that it is about."""
    of, table = cage_numbers(cage), read_packaged_table("seacage.cage", "remarks.toml")
    for name, about in (*_odd_whole(cage, of), *_odd_parts(cage)):
        key = table[name]["key"].format(**about)
        place = tuple(int(part) if part.isdigit() else part for part in key.split("."))
        yield place, table[name]["sentence"].format(cage=cage, of=of, **about)
    yield from ((("bridles", "bearings_deg"), warning) for warning in cage.warnings)


def _odd_whole(cage: Cage, of: Mapping[str, float]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Names of the remarks that hold for the cage as a whole."""
    site, anchors, lift = cage.site, cage.anchor_lines, of["collar_buoyancy_n"]
    reach = anchors.rope_length + anchors.chain_length
    holds = {
        "bed": of["water_below_m"] < 2.0,
        "swapped": _is_farmed(site.longitude) and not _is_farmed(site.latitude),
        "sinking": lift <= 0.0,
        "heavy": 0.0 < 0.6 * lift < of["weight_in_water_n"],
        "weightless": of["weight_in_water_n"] <= 0.0,
        "chain": of["shortest_bridle_m"] <= cage.bridles.chain_length,
        "strained": cage.bridles.pretension > cage.bridle_capacity[0],
        "anchored": reach <= site.water_depth - cage.frame.depth,
    }
    yield from ((name, {}) for name, is_odd in holds.items() if is_odd)


def _odd_parts(cage: Cage) -> Iterator[tuple[str, dict[str, Any]]]:
    """Names of the remarks that hold for one of several parts, and what they are about."""
    # How much longer each bridle is than its pretension stretches it [m]
    line, span = cage.bridles, _bridle_spans(cage)
    give = (span - line.chain_length) / line.rope_axial_stiffness
    stretch = line.pretension * (give + line.chain_length / line.chain_axial_stiffness)
    excesses = (np.array(line.length_offset) - stretch).tolist()
    for part, excess in zip(cage.bridle_names, excesses, strict=True):
        if excess >= 0.0:
            yield "slack", {"part": part, "at": excess}
    for corner in sorted({*range(len(cage.corner_position))} - {*cage.bridle_corner.tolist()}):
        yield "idle", {"at": corner + 1}
    for solidity in sorted({cage.netting.solidity_at(one) for one in cage.mesh.ring_depths}):
        if not 0.1 <= solidity <= 0.5:
            yield "solidity", {"at": solidity}
    for number, part in enumerate(cage.depth_sensor):
        at = -cage.design_position[cage.depth_sensors[number].node, 2]
        if abs(at - part.depth) > 1.0:
            yield "sensor", {"number": number, "part": part, "at": at}


def _is_farmed(latitude: float | None) -> bool:
    """Whether there are net cages at a latitude [deg]."""
    return latitude is not None and (25.0 <= latitude <= 72.0 or -56.0 <= latitude <= -25.0)
