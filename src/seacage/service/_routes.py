"""The calls of the HTTP interface."""

from datetime import timedelta
from typing import Annotated, Any

from fastapi import APIRouter, Depends, HTTPException, Path, Query, Request, Response
from fastapi.responses import JSONResponse

from seacage.service._answers import sample_of, shape_of, state_of
from seacage.service._guard import Permit
from seacage.service._live import LiveCage
from seacage.service._past import history_between, state_at
from seacage.service._samples import read_samples
from seacage.service._schemas import (
    Cages,
    CageSummary,
    Health,
    History,
    Problem,
    Receipt,
    SamplesIn,
    SamplesOut,
    Shape,
    State,
    Time,
    Topology,
)

_REFUSED: dict[int | str, dict[str, Any]] = {
    401: {"model": Problem, "description": "No token, or one that is not known."},
    403: {"model": Problem, "description": "The token lacks the scope."},
}
_READ: dict[int | str, dict[str, Any]] = {
    **_REFUSED,
    404: {"model": Problem, "description": "No cage of this name."},
    503: {"model": Problem, "description": "The store cannot be read."},
}
_WRITE: dict[int | str, dict[str, Any]] = {
    **_REFUSED,
    400: {"model": Problem, "description": "The body is not JSON."},
    404: {"model": Problem, "description": "No cage of this name."},
    413: {"model": Problem, "description": "The body is too long."},
    503: {"model": Problem, "description": "The store takes no samples; send them again."},
}
_HEALTH: dict[int | str, dict[str, Any]] = {
    **_REFUSED,
    503: {"model": Health, "description": "The service cannot do its work."},
}


def _cage(request: Request, cage: Annotated[str, Path(max_length=64)]) -> LiveCage:
    cages: dict[str, LiveCage] = request.app.state.service.cages
    if cage not in cages:
        raise HTTPException(404, f"No cage is called {cage!r}. There are {', '.join(cages)}.")
    return cages[cage]


Live = Annotated[LiveCage, Depends(_cage)]
At = Annotated[
    Time | None, Query(description="A time in the past, with its zone; now if left out.")
]
From = Annotated[Time | None, Query(alias="from", description="First time, included.")]
To = Annotated[Time | None, Query(alias="to", description="Last time, left out.")]
Limit = Annotated[int, Query(ge=1, le=10_000, description="At most so many.")]
Stream = Annotated[str | None, Query(max_length=64, description="All streams if left out.")]

around = APIRouter(dependencies=[Depends(Permit("read", open_to_loopback=True))], tags=["service"])
cages = APIRouter(prefix="/api/v1/cages", tags=["cages"])
may_read, may_ingest = [Depends(Permit("read"))], [Depends(Permit("ingest"))]


@around.get("/healthz", responses=_REFUSED)
async def healthz() -> Health:
    """Say that the service lives."""
    return Health(status="alive")


@around.get("/readyz", response_model=Health, responses=_HEALTH)
async def readyz(request: Request) -> Response:
    """Say whether samples are taken and every cage is being stepped."""
    trouble = request.app.state.service.trouble()
    health = Health(status=trouble or "ready")
    return JSONResponse(health.model_dump(), status_code=503 if trouble else 200)


@around.get("/metrics", response_class=Response, responses=_REFUSED)
async def metrics(request: Request) -> Response:
    """Tell Prometheus what happened."""
    text = request.app.state.service.metrics.text()
    return Response(text, media_type="text/plain; version=0.0.4; charset=utf-8")


@cages.get("", dependencies=may_read, responses=_REFUSED)
async def list_cages(request: Request) -> Cages:
    """List the cages, and whether each answers."""
    live: dict[str, LiveCage] = request.app.state.service.cages
    return Cages(
        cages=[
            CageSummary(
                name=name,
                origin=one.snapshot.state.origin,
                valid=one.snapshot.state.valid,
                t=one.snapshot.state.t,
            )
            for name, one in live.items()
        ]
    )


@cages.post("/{cage}/samples", status_code=201, dependencies=may_ingest, responses=_WRITE)
async def post_samples(request: Request, body: SamplesIn, live: Live) -> Receipt:
    """Take samples in any order; 201 says that those accepted are on disk.

    A sample is known by (stream, t, seq): sent again it counts as a duplicate and changes
    nothing.
    """
    until = live.clock.now() + timedelta(seconds=live.twin.watch.future_s)
    samples, rejected = read_samples(body.samples, live.streams, until=until)
    new = await live.take(samples)
    receipt = Receipt(accepted=sum(new), duplicates=len(new) - sum(new), rejected=rejected)
    _counted(request, live.name, receipt)
    return receipt


@cages.get("/{cage}/samples", dependencies=may_read, responses=_READ)
def get_samples(
    live: Live, stream: Stream = None, start: From = None, end: To = None, limit: Limit = 1000
) -> SamplesOut:
    """Give back stored samples in time order, the first ones of the span."""
    samples = live.store.samples(live.name, stream=stream, start=start, end=end, limit=limit)
    return SamplesOut(samples=[sample_of(sample) for sample in samples])


@cages.get("/{cage}/state", dependencies=may_read, responses=_READ)
def get_state(live: Live, at: At = None) -> State:
    """Say what the cage does: loads, sensors, volume, each with its level and 95 % interval."""
    if at is None:
        return live.snapshot.state
    state, answered = state_at(live.twin, live.store, live.name, at)
    return state_of(live.name, live.twin, answered, state)


@cages.get("/{cage}/shape", dependencies=may_read, responses=_READ)
def get_shape(live: Live, at: At = None) -> Shape:
    """Say where the net is, node by node, and how surely."""
    if at is None:
        return shape_of(live.snapshot.answered)
    return shape_of(state_at(live.twin, live.store, live.name, at)[1])


@cages.get("/{cage}/topology", dependencies=may_read, responses=_READ)
def get_topology(live: Live) -> Topology:
    """Say what of the cage does not change."""
    return live.topology


@cages.get("/{cage}/history", dependencies=may_read, responses=_READ)
def get_history(live: Live, start: From = None, end: To = None, limit: Limit = 1000) -> History:
    """Answer to the last of the buoy's readings in a span, and show what the sensors read."""
    return history_between(live.twin, live.store, live.name, start=start, end=end, limit=limit)


def _counted(request: Request, cage: str, receipt: Receipt) -> None:
    samples = request.app.state.service.metrics.samples
    samples.labels(cage, "accepted").inc(receipt.accepted)
    samples.labels(cage, "duplicate").inc(receipt.duplicates)
    samples.labels(cage, "rejected").inc(len(receipt.rejected))
