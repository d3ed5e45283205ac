"""Downloads: samples and answers as files for other programs."""

import csv
import io
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta
from importlib.util import find_spec
from itertools import chain
from pathlib import Path

from fastapi import APIRouter, HTTPException
from fastapi.responses import FileResponse, StreamingResponse
from starlette.background import BackgroundTask

from seacage.records import Sample
from seacage.service._calls._calls import (
    READ,
    From,
    Limit,
    Live,
    Responses,
    Stream,
    To,
    may_read,
    refusal,
)
from seacage.service._live._cage import LiveCage
from seacage.service._live._past import readings_between

_PAGE = 5000  # samples that are held at a time
_COLUMNS = ("t", "stream", "seq", "quantity", "value", "flag")
_CSV, _NETCDF = "text/csv", "application/x-netcdf"

downloads = APIRouter(prefix="/api/v1/cages", tags=["downloads"], dependencies=may_read)


def _file(kind: str, description: str) -> Responses:
    return {**READ, 200: {"content": {kind: {}}, "description": description}}


_NO_NETCDF = refusal(501, "NetCDF is not installed.", "NetCDF needs seacage[sim]. Ask for CSV.")


@downloads.get(
    "/{cage}/samples.csv",
    response_class=StreamingResponse,
    responses=_file(_CSV, "A row per value, with its flag."),
)
def download_samples(
    live: Live, stream: Stream = None, start: From = None, end: To = None
) -> StreamingResponse:
    """Give all stored samples of a span, in time order, however many there are."""
    pages = _pages(live, stream, start, end)
    first = next(pages)  # a store that cannot be read is said before the answer begins
    text = _table(chain([first], pages))
    return StreamingResponse(text, media_type=_CSV, headers=_named(live, "samples.csv"))


@downloads.get(
    "/{cage}/history.csv",
    response_class=FileResponse,
    responses=_file(_CSV, "A row per reading of the buoy."),
)
def download_history(
    live: Live, start: From = None, end: To = None, limit: Limit = 1000
) -> FileResponse:
    """Give the answers to the last of the buoy's readings in a span, with intervals, as a table."""
    return _history(live, "history.csv", _CSV, start, end, limit)


@downloads.get(
    "/{cage}/history.nc",
    response_class=FileResponse,
    responses=_file(_NETCDF, "CF-NetCDF, with the whole shape.") | _NO_NETCDF,
)
def download_netcdf(
    live: Live, start: From = None, end: To = None, limit: Limit = 1000
) -> FileResponse:
    """Give the same as CF-NetCDF, with where every node of the net was."""
    if find_spec("xarray") is None:
        raise HTTPException(
            501, "NetCDF needs seacage[sim], which this service lacks. Ask for CSV."
        )
    return _history(live, "history.nc", _NETCDF, start, end, limit)


def _history(
    live: LiveCage, name: str, kind: str, start: datetime | None, end: datetime | None, limit: int
) -> FileResponse:
    from seacage.service._calls._files import Replayed

    twin = live.twin
    buoy = readings_between(twin, live.store, live.name, start=start, end=end, limit=limit)
    answer = twin.predict_record(buoy)
    folder = Path(tempfile.mkdtemp(prefix="seacage-"))
    forget = BackgroundTask(shutil.rmtree, folder, ignore_errors=True)
    replayed = Replayed(buoy=buoy, answer=answer, cage=twin.cage, origin=str(twin.origin))
    try:
        replayed.write(folder / name)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    return FileResponse(
        folder / name, media_type=kind, headers=_named(live, name), background=forget
    )


def _named(live: LiveCage, name: str) -> dict[str, str]:
    return {"Content-Disposition": f'attachment; filename="{live.name}-{name}"'}


def _pages(
    live: LiveCage, stream: str | None, start: datetime | None, end: datetime | None
) -> Iterator[list[Sample]]:
    """Read page by page, each whole up to its last time, which begins the next."""
    while True:
        page = live.store.samples(live.name, stream=stream, start=start, end=end, limit=_PAGE)
        if len(page) < _PAGE:
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
