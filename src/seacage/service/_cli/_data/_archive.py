"""``seacage archive``: whole days of samples as Parquet files."""

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from seacage.service._cli import _console

Folder = Annotated[Path, typer.Argument(file_okay=False, help="Folder of the archive.")]
Day = Annotated[
    datetime | None, typer.Option(formats=["%Y-%m-%d"], help="UTC. [default: no bound]")
]


def write(
    folder: Folder,
    *,
    store: str = "var/samples.sqlite",
    cage: str | None = None,
    before: Annotated[datetime | None, typer.Option(formats=["%Y-%m-%d"])] = None,
) -> None:
    """Write every whole day of a store; the store keeps its samples.

    A service may be running. A day that is there already is completed, so doing it again adds
    what came late.

    Example: archive all that was measured until yesterday.
        seacage archive write archive --store var/samples.sqlite

    Options:
        store: postgresql://user@host/name, or a file of SQLite.
        cage: Only its samples.
        before: Only days before it, UTC. [default: today]
    """
    from seacage.service._store._archive import Archive
    from seacage.service._store._database._rows import microseconds, moment_of, readable
    from seacage.service._store._days import cages, days_before, rows_of_day
    from seacage.service._store._store import look_into

    until = microseconds((before or datetime.now(UTC)).replace(tzinfo=UTC))
    archive, count = Archive(folder), 0
    with look_into(store) as session, _console.progress_bar() as progress:
        days = [
            (name, stream, day)
            for name in ([cage] if cage else cages(session))
            for stream, day in days_before(session, name, until)
        ]
        for done, (name, stream, day) in enumerate(days, start=1):
            samples = [one for _, one in readable(rows_of_day(session, name, stream, day))]
            archive.write(name, stream, moment_of(day).date(), samples)
            count += len(samples)
            progress("archive", done, len(days))
    _console.report(
        {"folder": folder, "files": len(days), "samples": count},
        rows=[("Archive", folder), ("Files", len(days)), ("Samples", count)],
    )


def read(
    folder: Folder, *, cage: str, stream: str | None = None, start: Day = None, end: Day = None
) -> None:
    """Print archived samples in time order, one JSON object a line.

    Example: a day of a buoy.
        seacage archive read archive --cage ace --stream buoy-1 --start 2020-02-01 --end 2020-02-02

    Options:
        cage: Whose samples.
        stream: Only this stream's.
    """
    from seacage.service._store._archive import Archive
    from seacage.service._store._database._rows import Bounds

    archive = Archive(folder)
    if cage not in archive.cages():
        there = ", ".join(archive.cages()) or "none"
        raise _console.refusal(f"{folder} has no samples of cage {cage!r}. It has: {there}.")
    bounds = Bounds(start=start and start.replace(tzinfo=UTC), end=end and end.replace(tzinfo=UTC))
    rows = (
        {
            "stream": one.stream,
            "t": one.t.isoformat(),
            "seq": one.seq,
            "values": _console.without_nan(one.values),
            "flags": {key: int(flag) for key, flag in one.flags.items()},
            "remarks": list(one.remarks),
        }
        for one in archive.samples(cage, stream, bounds)
    )
    if _console.wants_json():
        _console.report({"samples": list(rows)})
        return
    for line in rows:
        typer.echo(json.dumps(line))


def check(folder: Folder) -> None:
    """Read every file and compare it with what was written; ends with 3 at any fault.

    Example:
        seacage archive check archive
    """
    from seacage.service._store._archive import Archive

    if not folder.is_dir():
        raise _console.refusal(f"{folder} is no folder. Name the folder of the archive.")
    looked = list(Archive(folder).faults())
    faults = [fault for _, fault in looked if fault]
    _console.report(
        {"folder": folder, "files": len(looked), "faults": faults},
        rows=[("Files", len(looked)), *(("Fault", fault) for fault in faults)],
    )
    if faults:
        raise _console.exit_with(
            f"{len(faults)} of {len(looked)} files are at fault.", _console.Exit.FAILED
        )
