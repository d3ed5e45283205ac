"""``seacage replay``: a record through a twin into files, or into a running service."""

import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._cli._console import progress_bar, refusal, report
from seacage.service._cli._options import InFolder, ServedCage, read_streams

if TYPE_CHECKING:
    from seacage.conventions import Progress
    from seacage.records import Record
    from seacage.twin import Answer, Twin


def replay(
    record: Annotated[Path, typer.Argument(exists=True)],
    *,
    twin: InFolder = None,
    out: Annotated[list[Path] | None, typer.Option(dir_okay=False)] = None,
    batched: Annotated[bool, typer.Option("--batched")] = False,
    to: str | None = None,
    cage: ServedCage = "ace",
    token: Annotated[str, typer.Option(envvar="SEACAGE_TOKEN")] = "",
    speed: Annotated[float | None, typer.Option(min=0.1)] = None,
) -> None:
    """Play a record through a twin or into a service.

    With --twin and --out each row of the buoy's record gets its answer: low fidelity and
    multifidelity with 95 % intervals for every sensor and bridle, the shape, and the level of
    each. Rows that failed their checks have no number, and say why; rows beyond what was
    learned are marked. The NetCDF file holds every node. With --to the samples are sent to a
    running service and are on its disk when this ends.

    Example:
        seacage replay buoy.csv --twin twin --out answers.csv --out answers.nc
        seacage replay field --to http://127.0.0.1:8000 --token TOKEN --speed 100

    Options:
        record: A buoy's record, or a field record's folder.
        twin: The twin that answers.
        out: File of the answers: .csv, .jsonl or .nc; repeatable.
        batched: Answer in blocks, not step by step: the same, faster.
        to: Send to a running service: http://127.0.0.1:8000.
        token: For the service, with the scope ingest.
        speed: Against real time. [default: as fast as it goes]
    """
    if to is not None and twin is None and not out:
        _send(record, to, cage, token, speed)
    elif to is None and twin is not None and out:
        _answer(record, twin, out, batched=batched)
    else:
        raise refusal(
            "replay: say where to. Give --twin and --out for files, or --to for a service."
        )


def _answer(record: Path, folder: Path, out: list[Path], *, batched: bool) -> None:
    from seacage.service._export import Replayed, check_form
    from seacage.twin import Twin

    for path in out:
        check_form(path)
    buoy = read_streams(record)[0]
    twin = Twin.read(folder)
    with progress_bar() as progress:
        began = time.perf_counter()
        answer = twin.predict_record(buoy) if batched else _step_through(twin, buoy, progress)
        rate = len(buoy) / (time.perf_counter() - began)
    replayed = Replayed(buoy=buoy, answer=answer, cage=twin.cage, origin=str(twin.origin))
    for path in out:
        replayed.write(path)
    valid = int(answer.valid.sum())
    extrapolating = int((answer.valid & ~answer.in_domain).sum())
    report(
        {"rows": len(buoy), "valid": valid, "extrapolating": extrapolating}
        | {"ticks_per_second": round(rate, 1), "batched": batched, "origin": str(twin.origin)}
        | {"written": [str(path) for path in out]},
        rows=[
            ("Rows", f"{len(buoy)}: {valid} answered, {len(buoy) - valid} without valid input"),
            ("Extrapolating", str(extrapolating)),
            ("Rate", f"{rate:.0f} ticks per second, {'in blocks' if batched else 'step by step'}"),
            *(("Written", str(path)) for path in out),
        ],
    )


def _step_through(twin: "Twin", buoy: "Record", progress: "Progress") -> "Answer":
    """Step through a record as a live service would; the same answers as in blocks."""
    from seacage.service._live._past import answer_in
    from seacage.twin import Answer

    state, answers = twin.start(), list[Answer]()
    for done, sample in enumerate(buoy.samples(), start=1):
        received = replace(sample, stream=twin.buoy)
        state, events = twin.step(state, received, sample.t)
        answers.append(answer_in(events).answer)  # each of a record's times is new
        if done % 50 == 0 or done == len(buoy):
            progress("replay", done, len(buoy))
    return Answer.join(*answers)


def _send(record: Path, to: str, cage: str, token: str, speed: float | None) -> None:
    from seacage.service._publish._sender import Sender
    from seacage.service._publish._sources import pace

    streams = read_streams(record)
    total = sum(len(one) for one in streams)
    sender, sent = Sender(address=to, cage=cage, token=token), 0
    accepted, duplicates, rejected = 0, 0, list[str]()
    began = time.perf_counter()
    with progress_bar() as progress:
        for batch in pace(streams, speed=speed):
            receipt = sender.send(batch)
            sent += len(batch)
            accepted += receipt.accepted
            duplicates += receipt.duplicates
            rejected += [one.reason for one in receipt.rejected]
            progress("send", sent, total)
    rate = total / (time.perf_counter() - began)
    report(
        {"sent": sent, "accepted": accepted, "duplicates": duplicates}
        | {"rejected": rejected[:20], "rejected_count": len(rejected)}
        | {"samples_per_second": round(rate, 1)},
        rows=[
            ("Accepted", f"{accepted} of {sent}, {duplicates} were there before"),
            ("Rejected", str(len(rejected)) + (f": {rejected[0]}" if rejected else "")),
            ("Rate", f"{rate:.0f} samples per second"),
        ],
    )
