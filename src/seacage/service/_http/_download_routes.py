"""Downloads: samples and answers as files for other programs."""

import csv
import io
import tempfile
from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta
from functools import partial
from importlib.util import find_spec
from itertools import chain
from pathlib import Path
from typing import BinaryIO, TypeVar

from fastapi import APIRouter, HTTPException
from fastapi.responses import StreamingResponse

from seacage.records import Sample
from seacage.service._export import Replayed, csv_text, replay_in_blocks, write_netcdf
from seacage.service._http._dependencies import (
    PAGE,
    READ,
    From,
    Limit,
    Live,
    Stream,
    To,
    body_of,
    may_read_rows,
    refusal,
)
from seacage.service._live._cage import LiveCage
from seacage.service._schemas._base import EXAMPLE_T

_PIECE = 1 << 16  # of a file, sent at once [bytes]
_COLUMNS = ("t", "stream", "seq", "quantity", "value", "flag")
_CSV, NETCDF = "text/csv", "application/x-netcdf"

downloads = APIRouter(
    prefix="/api/v1/cages",
    tags=["downloads"],
    dependencies=may_read_rows,
    responses=READ,
    default_response_class=StreamingResponse,
)

_Part = TypeVar("_Part")
_NO_NETCDF = refusal(501, "NetCDF is not installed.", "NetCDF needs seacage[sim]. Ask for CSV.")


@downloads.get(
    "/{cage}/samples.csv",
    responses=body_of(
        _CSV,
        "A row per value, with its flag.",
        example=f"t,stream,seq,quantity,value,flag\n{EXAMPLE_T},depth-1,7,depth_m,14.2,1\n",
    ),
)
def download_samples(
    live: Live, stream: Stream = None, start: From = None, end: To = None
) -> StreamingResponse:
    """Give all stored samples of a span, in time order, however many there are."""
    text = _table(_begin(_pages(live, stream, start, end)))
    return StreamingResponse(text, media_type=_CSV, headers=_attachment(live, "samples.csv"))


@downloads.get(
    "/{cage}/history.csv",
    responses=body_of(
        _CSV,
        "A row per reading of the buoy.",
        example=f"time,valid,bridle-1_kn\n{EXAMPLE_T},True,41.2\n",
    ),
)
def download_history(
    live: Live, start: From = None, end: To = None, limit: Limit = 1000
) -> StreamingResponse:
    """Give the answers to the last of the buoy's readings in a span, with intervals, as a table."""
    text = csv_text(_history(live, start, end, limit))
    return StreamingResponse(text, media_type=_CSV, headers=_attachment(live, "history.csv"))


@downloads.get(
    "/{cage}/history.nc", responses=body_of(NETCDF, "CF-NetCDF, with the whole shape.") | _NO_NETCDF
)
def download_netcdf(
    live: Live, start: From = None, end: To = None, limit: Limit = 1000
) -> StreamingResponse:
    """Give the same as CF-NetCDF, with where every node of the net was."""
    if find_spec("xarray") is None:
        raise HTTPException(
            501, "NetCDF needs seacage[sim], which this service lacks. Ask for CSV."
        )
    file, size = _write_blocks(_history(live, start, end, limit))
    headers = _attachment(live, "history.nc") | {"Content-Length": str(size)}
    return StreamingResponse(_pieces(file), media_type=NETCDF, headers=headers)


def _history(
    live: LiveCage, start: datetime | None, end: datetime | None, limit: int
) -> Iterator[Replayed]:
    past = live.past
    samples = live.store.samples(
        live.name, stream=past.twin.buoy, start=start, end=end, limit=limit, newest=True
    )
    sent = past.buoy_samples_before(samples)
    rows, among = (past.buoy_record(some) for some in (samples, sent))
    return _begin(replay_in_blocks(past.twin, rows, among=among))


def _begin(parts: Iterator[_Part]) -> Iterator[_Part]:
    """Make the first part now, so that what cannot be made is said before the answer begins."""
    return chain([next(parts)], parts)


def _write_blocks(blocks: Iterator[Replayed]) -> tuple[BinaryIO, int]:
    """Write blocks into a file that has no name any more: it goes with whoever reads it."""
    with tempfile.TemporaryDirectory(prefix="seacage-") as folder:
        path = Path(folder, "history.nc")
        write_netcdf(blocks, path)
        return path.open("rb"), path.stat().st_size


def _pieces(file: BinaryIO) -> Iterator[bytes]:
    with file:
        yield from iter(partial(file.read, _PIECE), b"")


def _attachment(live: LiveCage, name: str) -> dict[str, str]:
    return {"Content-Disposition": f'attachment; filename="{live.name}-{name}"'}


def _pages(
    live: LiveCage, stream: str | None, start: datetime | None, end: datetime | None
) -> Iterator[list[Sample]]:
    """Read page by page, each whole up to its last time, which begins the next."""
    while True:
        page = live.store.samples(live.name, stream=stream, start=start, end=end, limit=PAGE)
        if len(page) < PAGE:
            yield page
            return
        last = page[-1].t
        whole = [sample for sample in page if sample.t < last]
        yield whole or page
        start = last if whole else last + timedelta(microseconds=1)


def _table(pages: Iterator[Sequence[Sample]]) -> Iterator[str]:
    text = io.StringIO()
    rows = csv.writer(text)
    rows.writerow(_COLUMNS)
    for page in pages:
        for sample in page:
            t = sample.t.isoformat().replace("+00:00", "Z")
            for key, value in sample.values.items():
                rows.writerow((t, sample.stream, sample.seq, key, value, int(sample.flags[key])))
        yield text.getvalue()
        text.seek(0)
        text.truncate()
