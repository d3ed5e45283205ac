"""The calls of the HTTP interface: the service itself, its cages, their samples and answers."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from fastapi import APIRouter, Depends, Request, Response
from fastapi.responses import JSONResponse, StreamingResponse

from seacage.records import Sample
from seacage.service._auth._authorization import Permit, Who
from seacage.service._http._dependencies import (
    BINARY,
    READ,
    REFUSED,
    WRITE,
    At,
    From,
    Key,
    Limit,
    Live,
    OneStream,
    Stream,
    To,
    Width,
    body_of,
    cages_of,
    may_administrate,
    may_ingest,
    may_read,
    may_read_rows,
)
from seacage.service._http._history import history_between
from seacage.service._live._answers import shape_of, summary_of
from seacage.service._live._frame import MEDIA_TYPE
from seacage.service._schemas import _samples as schemas
from seacage.service._schemas._base import Health
from seacage.service._schemas._cages import Cages, Topology, TwinReplacement
from seacage.service._schemas._state import History, Shape, State

_TOGETHER = 500  # samples that are written at once
_HEALTH = {**REFUSED, 503: {"model": Health, "description": "The service cannot do its work."}}
# How a call documents a frame
FRAME = body_of(MEDIA_TYPE, "The page's binary message.", schema=BINARY)
_METRICS = 'seacage_samples_total{cage="ace",outcome="accepted"} 42.0\n'
around = APIRouter(dependencies=[Depends(Permit("read", open_to_loopback=True))], tags=["service"])
cages = APIRouter(prefix="/api/v1/cages", tags=["cages"])


@around.get("/healthz", responses=REFUSED)
async def healthz() -> Health:
    """Say that the service lives."""
    return Health(status="alive")


@around.get("/readyz", response_model=Health, responses=_HEALTH)
async def readyz(request: Request) -> Response:
    """Say whether samples are taken and every cage is being stepped."""
    service = request.app.state.service
    trouble = service.trouble()
    if trouble and len(cages_of(request)) < len(service.cages):
        trouble = "not ready"  # why, may be another cage's affair
    health = Health(status=trouble or "ready")
    return JSONResponse(health.model_dump(), status_code=503 if trouble else 200)


@around.get(
    "/metrics",
    response_class=Response,
    responses=REFUSED | body_of("text/plain", "For Prometheus.", example=_METRICS),
)
async def metrics(request: Request) -> Response:
    """Tell Prometheus what happened."""
    service, cages = request.app.state.service, cages_of(request)
    text = service.metrics.text(None if len(cages) == len(service.cages) else cages)
    return Response(text, media_type="text/plain; version=0.0.4; charset=utf-8")


@around.get("/openapi.json", include_in_schema=False)
async def openapi(request: Request) -> JSONResponse:
    """Describe the interface."""
    return JSONResponse(request.app.openapi())


@cages.get("", dependencies=may_read, responses=REFUSED)
async def list_cages(request: Request) -> Cages:
    """List the cages: whether each answers, its worst load and its worst alarm."""
    live = cages_of(request)
    return Cages(cages=[summary_of(name, one.snapshot.state) for name, one in live.items()])


@cages.post("/{cage}/samples", status_code=201, dependencies=may_ingest, responses=WRITE)
async def post_samples(request: Request, body: schemas.SamplesIn, live: Live) -> schemas.Receipt:
    """Take samples in any order; 201 says that those accepted are on disk.

    A sample is known by (stream, t, seq): sent again it counts as a duplicate and changes
    nothing. Of those rejected, the ones with ``retry`` are ahead of the service's clock: send
    them again once their time has come.
    """
    samples, rejected = schemas.read_samples(body.samples, live.streams, until=live.latest_allowed)
    for ahead in (body.samples[one.index] for one in rejected if one.retry):
        live.refuse_ahead(ahead.stream, schemas.time_of(ahead))
    new = await live.take(samples)
    accepted, duplicates = sum(new), len(new) - sum(new)
    outcomes = {"accepted": accepted, "duplicate": duplicates, "rejected": len(rejected)}
    for outcome, count in outcomes.items():
        request.app.state.service.metrics.samples.labels(live.name, outcome).inc(count)
    return schemas.Receipt(accepted=accepted, duplicates=duplicates, rejected=rejected)


@cages.get(
    "/{cage}/samples", dependencies=may_read_rows, responses=READ, response_model=schemas.SamplesOut
)
def get_samples(
    live: Live, stream: Stream = None, start: From = None, end: To = None, limit: Limit = 1000
) -> StreamingResponse:
    """Give back stored samples in time order, the first ones of the span."""
    samples = live.store.samples(live.name, stream=stream, start=start, end=end, limit=limit)
    return StreamingResponse(_samples_text(samples), media_type="application/json")


@cages.get("/{cage}/latest", dependencies=may_read, responses=READ)
def get_latest(live: Live, at: At = None) -> schemas.SamplesOut:
    """Give back the newest sample of every stream, in one call."""
    latest = live.store.latest(live.name, at=at)
    samples = [latest[stream] for stream in sorted(latest)]
    return schemas.SamplesOut.model_validate({"samples": samples})


@cages.get("/{cage}/aggregates", dependencies=may_read, responses=READ)
def get_aggregates(
    live: Live,
    stream: OneStream,
    key: Key,
    width_s: Width = 600,
    start: From = None,
    end: To = None,
    limit: Limit = 1000,
) -> schemas.AggregatesOut:
    """Say what the usable readings of each minute, or of ten, were: count, mean, least and most.

    A direction has no mean; ask for ``current_east_m_s`` and ``current_north_m_s`` instead.
    """
    aggregates = live.store.aggregates(
        live.name, stream=stream, key=key, width_s=width_s, start=start, end=end, limit=limit
    )
    return schemas.AggregatesOut(stream=stream, key=key, width_s=width_s, aggregates=aggregates)


@cages.get("/{cage}/state", dependencies=may_read, responses=READ)
def get_state(live: Live, at: At = None) -> State:
    """Say what the cage does: loads, sensors, volume, each with its level and 95 % interval."""
    return live.snapshot_at(at).state


@cages.get("/{cage}/shape", dependencies=may_read, responses=READ)
def get_shape(live: Live, at: At = None) -> Shape:
    """Say where the net is, node by node, with its uncertainty."""
    return shape_of(live.snapshot_at(at).answered)


@cages.get("/{cage}/frame", dependencies=may_read, response_class=Response, responses=READ | FRAME)
def get_frame(live: Live, at: At = None) -> Response:
    """Give the page's binary message of now or of the past; ``docs/service.md`` has its layout."""
    return Response(live.snapshot_at(at).frame, media_type=MEDIA_TYPE)


@cages.get("/{cage}/topology", dependencies=may_read, responses=READ)
def get_topology(live: Live) -> Topology:
    """Say what of the cage does not change."""
    return live.topology


@cages.post("/{cage}/twin", dependencies=may_administrate, responses=WRITE)
async def replace_twin(live: Live, body: TwinReplacement, who: Who) -> State:
    """Check a twin and put it in force between two ticks; the answer is its first.

    Alarms, counts of damage and history stay, and the old twin is kept. One that does not fit the
    cage is refused with 422, and nothing changes.
    """
    folder = None if body.folder is None else Path(body.folder)
    return await live.replace_twin(folder, who=who, why=body.why)


@cages.get("/{cage}/history", dependencies=may_read_rows, responses=READ, response_model=History)
def get_history(
    live: Live, start: From = None, end: To = None, limit: Limit = 1000
) -> StreamingResponse:
    """Answer to the buoy's readings in a span, and show what the sensors read.

    Where the buoy read more often than ``limit``, ``thinned`` is true, and the answers are spread
    over the span: its first and last, and the calmest and fastest water of equal parts between.
    A sensor that read more often is told by means of one or ten minutes. Intervals are as
    trained.
    """
    history = history_between(live.past, start=start, end=end, limit=limit)
    return StreamingResponse(_history_text(history), media_type="application/json")


def _samples_text(samples: Sequence[Sample]) -> Iterator[str]:
    """Write samples as JSON, some hundred at a time."""
    yield '{"samples":['
    for first in range(0, len(samples), _TOGETHER):
        some = map(schemas.SampleOut.model_validate, samples[first : first + _TOGETHER])
        yield "," * (first > 0) + ",".join(one.model_dump_json() for one in some)
    yield "]}"


def _history_text(history: History) -> Iterator[str]:
    """Write a history as JSON, one of its parts at a time."""
    for count, name in enumerate(History.model_fields):
        yield "{,"[count > 0] + history.model_dump_json(include={name})[1:-1]
    yield "}"
