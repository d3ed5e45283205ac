"""``seacage field``: records of buoys and sensors."""

from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from seacage.service._commands._settle import CageName, read_cage
from seacage.service._console import Json, guarded, progress_bar, tell

if TYPE_CHECKING:
    from seacage.records import ColumnMap, Limits, NetcdfMap, Record

group = typer.Typer(help="Records of buoys and sensors: make, read and check them.")

_FLAG_WORDS = {1: "good", 2: "not evaluated", 3: "suspect", 4: "fail", 9: "missing"}


LimitsFile = Annotated[
    Path | None,
    typer.Option(
        "--limits", exists=True, dir_okay=False, help="The site's limits (TOML); else defaults."
    ),
]


@group.command()
@guarded
def virtual(
    out: Annotated[Path, typer.Argument(file_okay=False, help="Folder of the field record.")],
    *,
    record: Annotated[
        Path | None,
        typer.Option(exists=True, dir_okay=False, help="A buoy's record; else one is generated."),
    ] = None,
    days: Annotated[float, typer.Option(min=1.0, max=400.0, help="Of a generated current.")] = 50.0,
    start: Annotated[
        datetime, typer.Option(formats=["%Y-%m-%d"], help="Of a generated current, UTC.")
    ] = datetime(2020, 1, 18),  # noqa: DTZ001
    seed: Annotated[int, typer.Option(min=0, help="Of current, noise and outages.")] = 0,
    hidden: Annotated[
        Path | None,
        typer.Option(exists=True, dir_okay=False, help="Hidden parameters; else those shipped."),
    ] = None,
    cage: CageName = "ace",
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes. [default: one per core]")
    ] = None,
    as_json: Json = False,
) -> None:
    """Make a virtual field: sensors on a cage that differs from its drawing.

    What they say is marked "virtual field" wherever it goes. OUT gets the record, OUT/truth
    the same sensors without error.

    Example:
        seacage field virtual field --seed 1
    """
    from datetime import UTC

    from seacage.campaigns import Hidden, generated_current, virtual_field
    from seacage.records import read_record

    begin = start.replace(tzinfo=UTC)
    buoy = read_record(record) if record else generated_current(seed, start=begin, days=days)
    with progress_bar() as progress:
        made = virtual_field(
            read_cage(cage),
            buoy,
            hidden=Hidden.read(hidden),
            seed=seed,
            responses=out / "responses",
            workers=workers,
            progress=progress,
        )
    made.record.write(out)
    made.truth.write(out / "truth")
    streams = [made.record.buoy, *made.record.sensors.values()]
    tell(
        {"written": str(out), "origin": str(made.record.origin)}
        | {"streams": {one.stream: len(one) for one in streams}},
        as_json=as_json,
        rows=[
            ("Written", f"{out} (virtual field)"),
            *((one.stream, f"{len(one)} readings") for one in streams),
        ],
    )


@group.command("import")
@guarded
def import_(
    path: Annotated[
        Path,
        typer.Argument(
            exists=True, dir_okay=False, help="A table (text, Parquet, CO-OPS, NDBC) or NetCDF."
        ),
    ],
    out: Annotated[
        Path, typer.Argument(dir_okay=False, help="To write: CF-NetCDF, or with --inspect a map.")
    ],
    *,
    inspect: Annotated[
        bool, typer.Option("--inspect", help="Say what the file seems to be; begin its map.")
    ] = False,
    columns: Annotated[
        str | None,
        typer.Option(help="Map of the file: a TOML file or a shipped name; else by the header."),
    ] = None,
    origin: Annotated[
        str | None, typer.Option(help="Of a foreign NetCDF file: measured or computed.")
    ] = None,
    zone: Annotated[
        str | None, typer.Option(help="Of a foreign NetCDF file's times, where it is in doubt.")
    ] = None,
    depth_m: Annotated[float | None, typer.Option(help="Which depth of a profile.")] = None,
    range_m: Annotated[
        float | None, typer.Option(help="Which bin of a profile, from the instrument.")
    ] = None,
    limits: LimitsFile = None,
    stream: Annotated[str, typer.Option(help="What to call the stream.")] = "buoy-1",
    as_json: Json = False,
) -> None:
    """Read a file in house units, check every value, and keep it as CF-NetCDF.

    Units and a direction's sense are what the file or its map says, never guessed. A bad value
    is flagged in its row and kept as it came. For a file that nobody knows yet, --inspect
    writes a map to fill in.

    Example:
        seacage field import logger.csv map.toml --inspect
        seacage field import logger.csv buoy-1.nc --columns map.toml
    """
    from seacage.records import read_record, write_record

    if inspect:
        _inspect(path, out, as_json=as_json)
        return
    choice = _choice(path, columns, origin=origin, zone=zone, depth_m=depth_m, range_m=range_m)
    record = read_record(path, columns=choice, stream=stream, limits=_limits(limits))
    write_record(record, out)
    _tell([record], as_json=as_json, written=out)


def _inspect(path: Path, out: Path, *, as_json: bool) -> None:
    from seacage.conventions import InputError
    from seacage.records import inspect_file

    if out.exists():
        raise InputError(f"{out}: the file is there already, and may hold your answers. Move it.")
    found = inspect_file(path)
    if found.map_text:
        out.write_text(found.map_text, encoding="utf-8")
    written = str(out) if found.map_text else None
    tell(
        {"findings": found.findings, "written": written, "to_fill_in": found.open_questions},
        as_json=as_json,
        rows=[
            *(("", finding) for finding in found.findings),
            ("", f'{out}: fill in {found.open_questions} "?"' if written else "No map is needed."),
        ],
    )


def _choice(
    path: Path,
    columns: str | None,
    *,
    origin: str | None,
    zone: str | None,
    depth_m: float | None,
    range_m: float | None,
) -> "ColumnMap | NetcdfMap | None":
    """The map that was named, with what the command line adds to it."""
    from dataclasses import replace

    from seacage.conventions import InputError, Origin
    from seacage.records import NetcdfMap, read_map

    said: dict[str, Any] = {"time_zone": zone, "depth_m": depth_m, "range_m": range_m}
    given = {name: value for name, value in said.items() if value is not None}
    if origin is not None:
        if origin not in {str(Origin.MEASURED), str(Origin.COMPUTED)}:
            raise InputError(f"--origin {origin!r} is unknown. Say measured or computed.")
        given |= {"origin": Origin(origin)}
    chosen = read_map(columns) if columns else None
    if isinstance(chosen, NetcdfMap) or (chosen is None and given):
        return replace(chosen or NetcdfMap(title=path.name), **given)
    if chosen is not None and depth_m is not None and len(given) == 1:
        return chosen.taken_at(depth_m)
    if given:
        raise InputError("--origin, --zone and --range-m are for NetCDF; a table's map says them.")
    return chosen


def _limits(path: Path | None) -> "Limits":
    from seacage.records import DEFAULT_LIMITS, read_limits

    return read_limits(path) if path else DEFAULT_LIMITS


@group.command()
@guarded
def check(
    path: Annotated[
        Path, typer.Argument(exists=True, help="A record's file, or a field record's folder.")
    ],
    *,
    report: Annotated[
        Path | None,
        typer.Option(dir_okay=False, help="An HTML page to write: what, when, why, with figures."),
    ] = None,
    limits: LimitsFile = None,
    as_json: Json = False,
) -> None:
    """Count what the quality checks say of a record, with the first of each kind.

    Flags are those of QARTOD. Bad values do not fail the command; a file that cannot be
    trusted at all does. With --limits a record is checked again by them.

    Example:
        seacage field check buoy.csv --report quality.html
    """
    from seacage.records import FieldRecord, check_record, read_record

    used = _limits(limits)
    if path.is_dir():
        field = FieldRecord.read(path)
        records = [field.buoy, *field.sensors.values()]
    else:
        records = [read_record(path, limits=used)]
    if limits is not None:
        records = [check_record(one, used) for one in records]
    if report is not None:
        from seacage.studies import quality_page

        report.write_text(quality_page(records, used), encoding="utf-8")
    _tell(records, as_json=as_json, written=report)


def _tell(records: "list[Record]", *, as_json: bool, written: Path | None = None) -> None:
    rows: list[tuple[str, str]] = [("Written", str(written))] if written else []
    for record in records:
        rows.append((record.stream, _span(record)))
        rows += [(f"  {key}", _counted(flags)) for key, flags in _flags(record).items()]
        rows += [("  note", note) for note in record.notes]
    tell(
        {
            "written": None if written is None else str(written),
            "streams": {
                one.stream: {
                    "origin": str(one.origin),
                    "rows": len(one),
                    "flags": _flags(one),
                    "notes": one.notes,
                }
                for one in records
            },
        },
        as_json=as_json,
        rows=rows,
    )


def _span(record: "Record") -> str:
    if not len(record):
        return f"no rows ({record.origin})"
    first, last = (str(t)[:16].replace("T", " ") for t in record.time[[0, -1]])
    return f"{len(record)} rows, {first} to {last} UTC ({record.origin})"


def _flags(record: "Record") -> dict[str, dict[str, int]]:
    return {
        key: {
            word: count
            for flag, word in _FLAG_WORDS.items()
            if (count := int((record.flags[key] == flag).sum()))
        }
        for key in record.values
    }


def _counted(flags: dict[str, int]) -> str:
    return ", ".join(f"{count} {word}" for word, count in flags.items())
