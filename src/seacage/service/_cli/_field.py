"""``seacage field``: records of buoys and sensors."""

from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from seacage.service._cli import _options
from seacage.service._cli._console import progress_bar, refusal, report

if TYPE_CHECKING:
    from seacage.campaigns import Event, TruthParameters
    from seacage.records import ColumnMap, FieldRecord, Limits, NetcdfMap, ProfilerMap, Record

_FLAG_WORDS = {1: "good", 2: "not evaluated", 3: "suspect", 4: "fail", 9: "missing"}


LimitsFile = Annotated[
    Path | None,
    typer.Option(exists=True, dir_okay=False, help="The site's limits (TOML); else defaults."),
]


def virtual(
    out: Annotated[Path, typer.Argument(file_okay=False)],
    *,
    method: Literal["simulate", "settle"] = "simulate",
    record: _options.InFile = None,
    days: Annotated[float | None, typer.Option(min=0.01, max=400.0)] = None,
    start: Annotated[datetime, typer.Option(formats=["%Y-%m-%d"])] = datetime(2020, 1, 18),  # noqa: DTZ001
    waves: _options.InFile = None,
    calm: Annotated[bool, typer.Option("--calm")] = False,
    one_in: Annotated[int, typer.Option(min=1)] = 1,
    profile: Literal["buoy", "cage"] | None = None,
    event: list[str] | None = None,
    events: _options.InFile = None,
    seed: _options.Seed = 0,
    hidden: _options.InFile = None,
    truth: int | None = None,
    water: Literal["tame", "coastal", "shallow"] = "tame",
    unseal: Annotated[bool, typer.Option("--unseal")] = False,
    cage: _options.CageName = "ace",
    workers: _options.Workers = None,
    share: Annotated[str | None, typer.Option(metavar="I/N")] = None,
) -> None:
    """Make a virtual field: sensors on a cage that differs from its drawing.

    What they say is marked "virtual field" wherever it goes. OUT gets the record, OUT/truth
    what was true. Finished hours are on disk at once: stopped at any moment, the same command
    goes on where it was, and the numbers do not depend on --workers or --share.

    Example:
        seacage field virtual field --days 1.5 --seed 1
        seacage field virtual field --record buoy.csv --waves nora10.csv --one-in 8
        seacage field virtual field --method settle --truth 7 --water coastal --profile cage
        seacage field virtual field --event "net-hole ring-3/spoke-24 2020-02-01T12:00Z"

    Options:
        out: Folder of the field record.
        method: In time, in waves: hours. Or equilibria in the current: minutes.
        record: A buoy's record; else one is generated.
        days: Its first days. [default: 48 generated, or the whole record]
        start: Of a generated current, UTC.
        waves: A record of waves, brought to the same days of the year and to a sheltered site; else
            the buoy's own, else they are generated.
        calm: No waves at all.
        one_in: Simulate one hour in so many, and those of the shackles.
        profile: Where an ADCP measures the current at six depths, which the buoy's stream carries.
        event: What goes wrong, as "bridle-cut bridle-8 2020-02-01T12:00Z".
        events: A TOML file of events.
        seed: Of weather, noise and outages.
        hidden: Hidden parameters; else those shipped.
        truth: Number of a hidden cage of the family: 1 to 60, for development; 101 to 110,
            sealed; 201 to 204, outside it; 301 to 400, fresh.
        water: Of that truth: as on the shelf, as two ADCPs measured it, or as the shallower did.
        unseal: Give a sealed truth, for a judgement that is the last.
        share: Only simulate the I-th of N shares of the hours, from 0; others do the rest.
    """
    from seacage.campaigns import Timetable, TruthParameters, virtual_field, virtual_field_share

    if truth is None:
        parameters = TruthParameters.read(hidden)
    elif hidden is not None:
        raise refusal("--hidden and --truth are two hidden cages. Give one of them.")
    else:
        parameters = TruthParameters.of_family(truth, water=water, unseal=unseal)
    buoy = _buoy(record, days=days, start=start, seed=seed, calm=calm)
    options: dict[str, Any] = {"hidden": parameters, "seed": seed, "workers": workers}
    if method == "simulate":
        options |= {
            "kept": out / "stretches",
            "waves": None if calm else _waves(waves, buoy, parameters, seed=seed),
            "timetable": Timetable.over(buoy, one_in=one_in, refined=parameters.netting.refined),
        }
    elif waves is not None or calm or one_in > 1 or share is not None:
        raise refusal(
            "--waves, --calm, --one-in and --share are for --method simulate. Leave them out."
        )
    else:
        options |= {"method": method, "kept": out / "responses"}
    options |= {"events": _events(event, events), "profile": profile}
    with progress_bar() as progress:
        subject, options["progress"] = _options.read_cage(cage), progress
        if share is not None:
            del options["profile"]  # adds to the record alone, when it is put together
            virtual_field_share(subject, buoy, share=_options.read_share(share), **options)
            report({"share": share}, rows=[("Simulated", f"share {share}")])
            return
        made = virtual_field(subject, buoy, **options)
    made.write(out)
    _report_field(made.record, out)


def _buoy(
    path: Path | None, *, days: float | None, start: datetime, seed: int, calm: bool
) -> "Record":
    """The buoy's record: read or generated, its first days, and without waves for a calm sea."""
    from seacage.campaigns import generated_current
    from seacage.records import moment, read_record

    if path is None:
        return generated_current(seed, start=start.replace(tzinfo=UTC), days=days or 48.0)
    record = read_record(path)
    if days is not None and len(record):
        first = moment(record.time[0])
        record = record.between(first, first + timedelta(days=days))
    if not calm:
        return record
    current = {key: column for key, column in record.values.items() if key.startswith("current")}
    return replace(record, values=current)


def _waves(
    path: Path | None, buoy: "Record", hidden: "TruthParameters", *, seed: int
) -> "Record | None":
    """Waves from a file, brought to the site; None for the buoy's own; else generated."""
    from seacage.campaigns import generated_waves, waves_at_site
    from seacage.records import moment, read_record

    if path is not None:
        factor, most = hidden.waves.sheltered, hidden.waves.hs_most_m
        return waves_at_site(read_record(path), buoy.time, factor=factor, most=most)
    if "hs_m" in buoy.values or not len(buoy):
        return None
    first, last = moment(buoy.time[0]), moment(buoy.time[-1])
    days = (last - first) / timedelta(days=1) + 1.0  # to the last reading, and an hour on
    return generated_waves(seed, start=first, days=days)


def _events(words: list[str] | None, path: Path | None) -> "list[Event]":
    from seacage.campaigns import Event, read_events

    listed = read_events(path) if path else ()
    return sorted([*listed, *map(Event.parse, words or ())], key=lambda event: event.at)


def _report_field(record: "FieldRecord", out: Path) -> None:
    counts = {one.stream: len(one) for one in (record.buoy, *record.sensors.values())}
    report(
        {"written": out, "origin": record.origin, "streams": counts, "notes": record.notes},
        rows=[
            ("Written", f"{out} ({record.origin})"),
            *((stream, f"{count} readings") for stream, count in counts.items()),
            *(("note", note) for note in record.notes),
        ],
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class MapOptions:
    """The meaning of a file's columns, as far as neither the file nor its map says it.

    Options:
        origin: Of a foreign NetCDF file: measured or computed.
        zone: Of times that name none: UTC, an offset, or of a table Europe/Oslo.
        depth_m: Which depth of a profile.
        profile: Its other depths too, as those of an ADCP.
        range_m: Which bin of a profile, from the instrument.
        declination_deg: Of a table's magnetic directions, positive to the east.
    """

    columns: _options.Columns = None
    origin: str | None = None
    zone: str | None = None
    depth_m: float | None = None
    profile: Annotated[bool, typer.Option("--profile")] = False
    range_m: float | None = None
    declination_deg: Annotated[float | None, typer.Option(min=-180.0, max=180.0)] = None

    def of(self, path: Path) -> "ColumnMap | NetcdfMap | ProfilerMap | None":
        """The map that was named, with what the other options add to it."""
        from seacage.conventions import Origin
        from seacage.records import ColumnMap, NetcdfMap, ProfilerMap, known_map, read_map

        options = {"time_zone": self.zone, "depth_m": self.depth_m, "range_m": self.range_m}
        options |= {"profile": self.profile or None}
        given: dict[str, Any] = {name: one for name, one in options.items() if one is not None}
        if self.origin is not None:
            if self.origin not in {str(Origin.MEASURED), str(Origin.COMPUTED)}:
                raise refusal(f"--origin {self.origin!r} is unknown. Say measured or computed.")
            given |= {"origin": Origin(self.origin)}
        chosen = read_map(self.columns) if self.columns else None
        added = given or self.declination_deg is not None
        if chosen is None and added:
            chosen = known_map(path) or NetcdfMap(title=path.name)
        if isinstance(chosen, ProfilerMap) and added:
            raise refusal("The map of a profiler declares all that it needs. Write it there.")
        if chosen is None or isinstance(chosen, ProfilerMap):
            return chosen
        if isinstance(chosen, ColumnMap):
            if self.origin is not None:
                raise refusal("--origin is for NetCDF; the map of a table says it. Leave it out.")
            chosen = chosen.answered(zone=self.zone, declination_deg=self.declination_deg)
            chosen = replace(chosen, profile=chosen.profile or self.profile)
            return chosen.taken_at(self.depth_m, self.range_m)
        if self.declination_deg is not None:
            raise refusal("--declination-deg is for tables; of NetCDF [columns] in a map say it.")
        return replace(chosen, **given)


def import_(
    path: Annotated[Path, typer.Argument(exists=True, dir_okay=False)],
    out: Annotated[Path, typer.Argument(dir_okay=False)],
    *,
    inspect: Annotated[bool, typer.Option("--inspect")] = False,
    meaning: MapOptions,
    limits: LimitsFile = None,
    stream: str = "buoy-1",
) -> None:
    """Read a file in house units, check every value, and keep it as CF-NetCDF.

    Units and a direction's sense are what the file or its map says, never guessed. A bad value
    is flagged in its row and kept as it came. For a file that nobody knows yet, --inspect
    writes a map to fill in.

    Example:
        seacage field import logger.csv map.toml --inspect
        seacage field import logger.csv buoy-1.nc --columns map.toml

    Options:
        path: A table (text, Parquet, CO-OPS, NDBC) or NetCDF.
        out: To write: CF-NetCDF, or with --inspect a map.
        inspect: Say what the file seems to be; begin its map.
        stream: What to call the stream.
    """
    from seacage.records import read_record, write_record

    if inspect:
        _inspect(path, out)
        return
    record = read_record(path, columns=meaning.of(path), stream=stream, limits=_limits(limits))
    write_record(record, out)
    _report_flags([record], written=out)


def _inspect(path: Path, out: Path) -> None:
    from seacage.records import inspect_file

    if out.exists():
        raise refusal(f"{out}: the file is there already, and may hold your answers. Move it.")
    found = inspect_file(path)
    if found.map_text:
        out.write_text(found.map_text, encoding="utf-8")
    written = out if found.map_text else None
    report(
        {"findings": found.findings, "written": written, "to_fill_in": found.open_questions},
        rows=[
            *(("", finding) for finding in found.findings),
            ("", f'{out}: fill in {found.open_questions} "?"' if written else "No map is needed."),
        ],
    )


def _limits(path: Path | None) -> "Limits":
    from seacage.records import DEFAULT_LIMITS, read_limits

    return read_limits(path) if path else DEFAULT_LIMITS


def check(
    path: Annotated[Path, typer.Argument(exists=True)],
    *,
    report: _options.OutFile = None,
    limits: LimitsFile = None,
) -> None:
    """Count what the quality checks say of a record, with the first of each kind.

    Flags are those of QARTOD. Bad values do not fail the command; a file that cannot be
    trusted at all does. With --limits a record is checked again by them.

    Example:
        seacage field check buoy.csv --report quality.html

    Options:
        path: A record's file, or a field record's folder.
        report: An HTML page to write: what, when, why, with figures.
    """
    from seacage.records import check_record

    used = _limits(limits)
    records = _options.read_streams(path, limits=used)
    if limits is not None:
        records = [check_record(one, used) for one in records]
    if report is not None:
        from seacage.studies import quality_page

        report.write_text(quality_page(records, used), encoding="utf-8")
    _report_flags(records, written=report)


def _report_flags(records: "list[Record]", written: Path | None = None) -> None:
    rows: list[tuple[str, object]] = [("Written", written)] if written else []
    streams: dict[str, object] = {}
    for record in records:
        flags = _flags(record)
        rows.append((record.stream, _span(record)))
        for key, counts in flags.items():
            counted = ", ".join(f"{count} {word}" for word, count in counts.items())
            rows.append((f"  {key}", counted))
        rows += [("  note", note) for note in record.notes]
        about = {"origin": record.origin, "rows": len(record)}
        streams[record.stream] = about | {"flags": flags, "notes": record.notes}
    report({"written": written, "streams": streams}, rows=rows)


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
