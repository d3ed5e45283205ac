"""``seacage replay``: a record through a twin into files, or into a running service."""

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._cli._console import Json, guard, progress_bar, report

if TYPE_CHECKING:
    from seacage.conventions import Progress
    from seacage.records import Record
    from seacage.twin import Answer, Twin


@guard
def replay(
    record: Annotated[
        Path, typer.Argument(exists=True, help="A buoy's record, or a field record's folder.")
    ],
    *,
    twin: Annotated[
        Path | None, typer.Option(exists=True, file_okay=False, help="The twin that answers.")
    ] = None,
    out: Annotated[
        list[Path] | None,
        typer.Option(dir_okay=False, help="File of the answers: .csv, .jsonl or .nc; repeatable."),
    ] = None,
    batched: Annotated[
        bool,
        typer.Option("--batched", help="Answer in blocks, not step by step: the same, faster."),
    ] = False,
    to: Annotated[
        str | None, typer.Option(help="Send to a running service: http://127.0.0.1:8000.")
    ] = None,
    cage: Annotated[str, typer.Option(help="The cage's name there.")] = "ace",
    token: Annotated[
        str, typer.Option(envvar="SEACAGE_TOKEN", help="For the service, with the scope ingest.")
    ] = "",
    speed: Annotated[
        float | None, typer.Option(min=0.1, help="Against real time. [default: as fast as it goes]")
    ] = None,
    as_json: Json = False,
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
    """
    from seacage.conventions import InputError

    if to is not None and twin is None and not out:
        _send(record, to, cage, token, speed, as_json=as_json)
    elif to is None and twin is not None and out:
        _answer(record, twin, out, batched=batched, as_json=as_json)
    else:
        raise InputError(
            "replay: say where to. Give --twin and --out for files, or --to for a service."
        )


def _answer(record: Path, folder: Path, out: list[Path], *, batched: bool, as_json: bool) -> None:
    from seacage.service._export import Replayed, check_form
    from seacage.twin import Twin

    for path in out:
        check_form(path)
    buoy = _streams(record)[0]
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
        as_json=as_json,
        rows=[
            ("Rows", f"{len(buoy)}: {valid} answered, {len(buoy) - valid} without valid input"),
            ("Extrapolating", str(extrapolating)),
            ("Rate", f"{rate:.0f} ticks per second, {'in blocks' if batched else 'step by step'}"),
            *(("Written", str(path)) for path in out),
        ],
    )


def _step_through(twin: "Twin", buoy: "Record", progress: "Progress") -> "Answer":
    """Step through a record as a live service would; the same answers as in blocks."""
    from dataclasses import replace

    from seacage.service._export import join_answers
    from seacage.service._live._past import answer_in

    state, answers = twin.start(), list["Answer"]()
    for done, sample in enumerate(buoy.samples(), start=1):
        received = replace(sample, stream=twin.buoy)
        state, events = twin.step(state, received, sample.t)
        answered = answer_in(events)
        assert answered is not None  # each of a record's times is new, so each is answered
        answers.append(answered.answer)
        if done % 50 == 0 or done == len(buoy):
            progress("replay", done, len(buoy))
    return join_answers(answers)


def _send(
    record: Path, to: str, cage: str, token: str, speed: float | None, *, as_json: bool
) -> None:
    from seacage.service._publish._sender import Sender
    from seacage.service._publish._sources import pace

    streams = _streams(record)
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
        as_json=as_json,
        rows=[
            ("Accepted", f"{accepted} of {sent}, {duplicates} were there before"),
            ("Rejected", str(len(rejected)) + (f": {rejected[0]}" if rejected else "")),
            ("Rate", f"{rate:.0f} samples per second"),
        ],
    )


def _streams(path: Path) -> "list[Record]":
    """The buoy's record first, then those of its sensors where they are there."""
    from seacage.records import FieldRecord, read_record

    if path.is_dir():
        field = FieldRecord.read(path)
        return [field.buoy, *field.sensors.values()]
    return [read_record(path)]
