"""Points and ways as CSV, whose header names frame and unit."""

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path

from pydantic import BaseModel, ValidationError

from seacage.conventions import TABLE_BYTES, InputError, read_text
from seacage.service._schemas import _clearance as schemas

# Columns of each frame; others beside them are left alone
HEADS: dict[schemas.FrameName, tuple[str, str, str]] = {
    "enu": ("east_m", "north_m", "up_m"),
    "ned": ("north_m", "east_m", "down_m"),
    "wgs84": ("latitude_deg", "longitude_deg", "depth_m"),
}

Row = tuple[float, float, float]


def read_points(path: Path) -> tuple[schemas.FrameName, list[Row]]:
    """Read points from a CSV file, whose header says in which frame they are.

    Raises InputError: no such header, or a cell that is no number, with its line.
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
    frame: schemas.FrameName, rows: Sequence[Row], **options: object
) -> schemas.ClearanceQuery:
    """Ask about points of a frame, with the other fields of the query as options.

    Raises InputError: more points than one request takes, or coordinates that are none.
    """
    geographic = [
        {"latitude_deg": latitude, "longitude_deg": longitude, "depth_m": depth}
        for latitude, longitude, depth in rows
    ]
    points = {"places": geographic} if frame == "wgs84" else {"points_m": [[*row] for row in rows]}
    try:
        return schemas.ClearanceQuery.model_validate({"frame": frame, **options, **points})
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"]))
        raise InputError(f"clearance: {where}: {first['msg']}.") from error


def write_clearances(path: Path, rows: Sequence[Row], answer: schemas.ClearanceAnswer) -> None:
    """Write points with their clearances, one line each."""
    _write(
        path, answer.frame, rows, answer.points, left_out={"nearest_m", "nearest_place", "normal"}
    )


def write_waypoints(path: Path, answer: schemas.InspectionAnswer) -> None:
    """Write a way along the net, one waypoint a line."""
    ways = answer.waypoints
    places = [dict(one.place).values() if one.place else one.position_m for one in ways]
    _write(path, answer.frame, places, ways, left_out={"position_m", "place"})


def _frame_of(head: set[str], path: Path) -> schemas.FrameName:
    for frame, keys in HEADS.items():
        if head.issuperset(keys):
            return frame
    wanted = "; ".join(",".join(keys) for keys in HEADS.values())
    raise InputError(f"{path}: its header names no frame with units. Name the columns {wanted}.")


def _write(
    path: Path,
    frame: schemas.FrameName,
    places: Sequence[Iterable[float]],
    entries: Sequence[BaseModel],
    *,
    left_out: set[str],
) -> None:
    keys = [key for key in type(entries[0]).model_fields if key not in left_out]
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow([*HEADS[frame], *keys])
        for place, one in zip(places, entries, strict=True):
            table.writerow([*place, *(getattr(one, key) for key in keys)])


def _row(row: dict[str, str | None], keys: Sequence[str], where: str) -> Row:
    cells = [row[key] for key in keys]
    try:
        first, second, third = (float(cell or "") for cell in cells)
    except ValueError as error:
        raise InputError(f"{where}: {cells} are not three numbers.") from error
    return first, second, third
