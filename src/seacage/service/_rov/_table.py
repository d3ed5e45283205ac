"""Points and ways as CSV, whose header names frame and unit."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from seacage.conventions import TABLE_BYTES, InputError, read_text
from seacage.service._schemas._clearance import (
    ClearanceAnswer,
    ClearanceQuery,
    FrameName,
    InspectionAnswer,
    Place,
)

HEADS: dict[FrameName, tuple[str, str, str]] = {
    "enu": ("east_m", "north_m", "up_m"),
    "ned": ("north_m", "east_m", "down_m"),
    "wgs84": ("latitude_deg", "longitude_deg", "depth_m"),
}
"""Columns of each frame; others beside them are left alone."""

Row = tuple[float, float, float]


def read_points(path: Path) -> tuple[FrameName, list[Row]]:
    """Read points from a CSV file, whose header says in which frame they are.

    Raises
    ------
    InputError
        No such header, or a cell that is no number, with its line.
    """
    try:
        text = read_text(path, most=TABLE_BYTES).removeprefix("\ufeff")
        table = csv.DictReader(io.StringIO(text, newline=""))
        head = set(table.fieldnames or ())
        frame = _frame_of(head, path)
        rows = [
            _row(row, HEADS[frame], f"{path}, line {number}")
            for number, row in enumerate(table, start=2)
        ]
    except csv.Error as error:
        raise InputError(f"{path} cannot be read as CSV ({error}).") from error
    if not rows:
        raise InputError(f"{path} has a header and no point. Give a line for each.")
    return frame, rows


def query_of(
    frame: FrameName,
    rows: Sequence[Row],
    *,
    as_path: bool,
    below_m: float,
    allow_stale: bool,
    max_age_s: float | None,
) -> ClearanceQuery:
    """Ask about points of a frame.

    Raises
    ------
    InputError
        More points than one request takes, or coordinates that are none.
    """
    from pydantic import ValidationError

    geographic = [
        {"latitude_deg": latitude, "longitude_deg": longitude, "depth_m": depth}
        for latitude, longitude, depth in rows
    ]
    points = {"places": geographic} if frame == "wgs84" else {"points_m": [[*row] for row in rows]}
    options = {"as_path": as_path, "below_m": below_m, "allow_stale": allow_stale}
    try:
        return ClearanceQuery.model_validate(
            {"frame": frame, "max_age_s": max_age_s, **options, **points}
        )
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"]))
        raise InputError(f"clearance: {where}: {first['msg']}.") from error


def write_clearances(path: Path, rows: Sequence[Row], answer: ClearanceAnswer) -> None:
    """Write points with their clearances, one line each."""
    keys = [
        key
        for key in type(answer.points[0]).model_fields
        if key not in {"nearest_m", "nearest_place", "normal"}
    ]
    lines = [
        [*row, *(getattr(one, key) for key in keys)]
        for row, one in zip(rows, answer.points, strict=True)
    ]
    _write(path, [*HEADS[answer.frame], *keys], lines)


def write_waypoints(path: Path, answer: InspectionAnswer) -> None:
    """Write a way along the net, one waypoint a line."""
    keys = [
        key for key in type(answer.waypoints[0]).model_fields if key not in {"position_m", "place"}
    ]
    lines = [
        [*_at(one.position_m, one.place), *(getattr(one, key) for key in keys)]
        for one in answer.waypoints
    ]
    _write(path, [*HEADS[answer.frame], *keys], lines)


def _frame_of(head: set[str], path: Path) -> FrameName:
    for frame, keys in HEADS.items():
        if head.issuperset(keys):
            return frame
    wanted = "; ".join(",".join(keys) for keys in HEADS.values())
    raise InputError(f"{path}: its header names no frame with units. Name the columns {wanted}.")


def _at(position_m: list[float], place: Place | None) -> list[float]:
    if place is None:
        return position_m
    return [place.latitude_deg, place.longitude_deg, place.depth_m]


def _write(path: Path, head: Sequence[str], lines: Sequence[Sequence[object]]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(head)
        table.writerows(lines)


def _row(row: dict[str, str | None], keys: Sequence[str], where: str) -> Row:
    cells = [row[key] for key in keys]
    try:
        first, second, third = (float(cell or "") for cell in cells)
    except ValueError as error:
        raise InputError(f"{where}: {cells} are not three numbers.") from error
    return first, second, third
