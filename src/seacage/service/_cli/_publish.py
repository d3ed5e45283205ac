"""``seacage publish``: samples from the edge to a service, through a spool."""

import sys
from collections.abc import Iterator
from contextlib import closing
from dataclasses import asdict, dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._cli._console import Exit, exit_with, progress_bar, refusal, report
from seacage.service._cli._options import Columns, InFile, ServedCage, read_streams

if TYPE_CHECKING:
    from seacage.service._publish._publisher import Batch, Published
    from seacage.service._publish._spool import Spool
    from seacage.service._publish._transport import Transport


def publish(
    source: Annotated[str, typer.Argument()],
    *,
    to: str,
    cage: ServedCage = "ace",
    site: str = "site",
    stream: str = "buoy-1",
    columns: Columns = None,
    follow: Annotated[bool, typer.Option("--follow")] = False,
    speed: Annotated[float | None, typer.Option(min=0.1)] = None,
    spool: Annotated[Path, typer.Option(dir_okay=False)] = Path("publish.spool"),
    spool_most: Annotated[int, typer.Option(min=1)] = 1_000_000,
    when_full: Literal["wait", "drop-oldest"] = "wait",
    keep_ahead_days: Annotated[float, typer.Option(min=0.0)] = 7.0,
    patience_s: Annotated[float | None, typer.Option(min=1.0)] = None,
    token: Annotated[str, typer.Option(envvar="SEACAGE_TOKEN")] = "",
    ca: InFile = None,
) -> None:
    """Send samples to a service, and again until it has them on disk.

    What is read lies in the spool, on disk, until the service itself acknowledges it; neither
    a kill of this command nor one of the broker or of the service loses a sample. Run again
    with the same spool it goes on where it was. While the service is away the spool fills;
    afterwards new samples go first, and the others follow. To send a record a second time,
    name a new spool.

    Samples that the service refuses as ahead of its clock stay in the spool and are tried again
    every minute (with --speed: of the record's time), also by the next run; after
    --keep-ahead-days they are set aside, with the reason, in a file beside the spool.

    Example: a logger's file, for ever.
        seacage publish logger.csv --follow --columns map.toml --to mqtt://127.0.0.1:1883
    Example: lines like {"stream": "depth-2", "t": "2026-01-02T03:04:05Z", "values": {…}}.
        read-sensors | seacage publish - --to http://127.0.0.1:8000 --token TOKEN

    Options:
        source: A buoy's record, a field record's folder, or - for lines of JSON on stdin.
        to: mqtt://host:1883, mqtts://user:password@host:8883, or http://host:8000.
        site: By MQTT: the site's name in the topics.
        stream: What to call the stream of a file.
        follow: Go on with the rows that a logger appends.
        speed: Of a record, against real time. [default: as fast as it goes]
        spool: File of what is not yet acknowledged.
        spool_most: Samples that it holds.
        when_full: Then the source waits, or the oldest samples are given up.
        keep_ahead_days: Try samples ahead of the service's clock for so long [d].
        patience_s: Give up when nothing is acknowledged for so long [s].
        token: By HTTP: with the scope ingest.
        ca: By MQTT: whom the certificate is from.
    """
    from seacage.service._logs import begin_logs
    from seacage.service._publish._publisher import Publisher
    from seacage.service._publish._spool import Spool

    if follow and (source == "-" or Path(source).is_dir() or speed is not None):
        raise refusal("publish: --follow is for a growing file, at the speed at which it grows.")
    begin_logs("lines")
    refused, pace, drop_oldest = _Refused(), speed or 1.0, when_full == "drop-oldest"
    place = to.rpartition("://")[2].rpartition("@")[2]  # a password may change
    destination = f"{place}, site {site}, cage {cage}"
    with (
        closing(_transport(to, cage, site, token, ca)) as transport,  # refuses a wrong address
        closing(Spool(spool, to=destination, most=spool_most, drop_oldest=drop_oldest)) as kept,
        progress_bar() as progress,
    ):
        batches = _batches(source, kept, refused, stream, columns, follow=follow, speed=speed)
        done = Publisher(
            kept,
            transport,
            retry_s=max(1.0, 60.0 / pace),
            keep_ahead=timedelta(days=keep_ahead_days / pace),
            patience_s=patience_s,
            progress=progress,
        ).run(batches)
    _report_outcome(done, refused)
    if count := refused.count + done.rejected + done.quarantined:
        raise exit_with(f"{count} samples were refused; see the summary.", Exit.REFUSED)
    if done.ahead:
        raise exit_with(
            f"{done.ahead} samples are ahead of the service's clock and wait in {spool}. Check "
            "the clocks of source and service, and run this again with the same spool.",
            Exit.FAILED,
        )


@dataclass
class _Refused:
    """What of the source could not be read."""

    count: int = 0
    reasons: list[str] = field(default_factory=list[str])

    def __call__(self, where: str, _: bytes, reason: str) -> None:
        self.count += 1
        if len(self.reasons) < 20:
            self.reasons.append(f"{where}: {reason}")


def _batches(
    source: str,
    spool: "Spool",
    refused: _Refused,
    stream: str,
    columns: str | None,
    *,
    follow: bool,
    speed: float | None,
) -> "Iterator[Batch]":
    from seacage.records import ColumnMap, read_map
    from seacage.service._publish import _sources
    from seacage.service._tail import Tail, TailPosition

    if source == "-":
        return _sources.line_batches(_sources.arriving(sys.stdin.fileno()), refuse=refused)
    path = Path(source)
    if not path.exists() and not follow:
        raise refusal(f"{path}: there is no such record. Name a file, a folder, or - for stdin.")
    choice = read_map(columns) if columns else None
    name = f"{path.resolve()} {stream}"
    place = spool.place(name)
    if follow:
        if choice is not None and not isinstance(choice, ColumnMap):
            raise refusal("publish: only tables can be followed, and this map is of NetCDF.")
        at = TailPosition() if place is None else TailPosition.parse(place)
        tail = Tail(path=path, columns=choice, stream=stream, refuse=refused, place=at)
        return _sources.tail_batches(tail, source=name)
    records = read_streams(path, columns=choice, stream=stream)
    return _sources.record_batches(records, source=name, place=place, speed=speed)


def _transport(to: str, cage: str, site: str, token: str, ca: Path | None) -> "Transport":
    from seacage.service._mqtt._broker import Broker
    from seacage.service._publish._sender import Sender
    from seacage.service._publish._transport import HttpTransport, MqttTransport

    if to.startswith(("http://", "https://")):
        return HttpTransport(Sender(address=to, cage=cage, token=token, patience_s=()))
    return MqttTransport(Broker.parse(to, ca=ca), site=site, cage=cage)


def _report_outcome(done: "Published", refused: _Refused) -> None:
    reasons = [*refused.reasons, *done.reasons]
    report(
        asdict(done) | {"refused": refused.count, "reasons": reasons},
        rows=[
            ("Read", f"{done.read} samples"),
            ("Acknowledged", str(done.acknowledged)),
            ("Refused", f"{done.rejected} by the service, {refused.count} before"),
            *(("", reason) for reason in reasons[:5]),
            ("Spooled", f"{done.spooled} wait, {done.dropped} were given up"),
            ("Ahead", f"{done.ahead} of these wait for the service's clock"),
            ("Set aside", str(done.quarantined)),
        ],
    )
