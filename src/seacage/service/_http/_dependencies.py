"""What the calls share: their cage, their bounds, and the refusals that each documents."""

from functools import partial
from typing import Annotated, Any

from fastapi import Depends, HTTPException, Path, Query, Request

from seacage.service._auth._authorization import Permit, gate_of
from seacage.service._auth._token_store import Grant
from seacage.service._live._cage import LiveCage
from seacage.service._schemas._base import Problem, Reach

Responses = dict[int | str, dict[str, Any]]


def refusal(code: int, description: str, example: str) -> Responses:
    """Document one way in which a call may be refused."""
    content = {"application/json": {"example": {"detail": example}}}
    return {code: {"model": Problem, "description": description, "content": content}}


BINARY = {"type": "string", "format": "binary"}


def body_of(media_type: str, description: str, **content: Any) -> Responses:
    """Document the answer of a call that is no model, with a schema or an example."""
    return {200: {"content": {media_type: content}, "description": description}}


# What any call may answer that takes a token
REFUSED: Responses = {
    **refusal(401, "No token, or one that is not known.", "Send a token as 'Authorization: …'."),
    **refusal(403, "The token lacks the scope.", "This token does not have the scope ack."),
    **refusal(422, "A parameter is out of bounds.", "limit: should be at most 10000."),
    429: {
        **refusal(429, "Asked too often.", "This token asks too often. Ask again in 2 s.")[429],
        "headers": {"Retry-After": {"schema": {"type": "integer"}, "description": "Seconds."}},
    },
}

# What a call may answer that reads of a cage
READ: Responses = {
    **REFUSED,
    **refusal(404, "No cage of this name.", "No cage is called 'ice'. There are ace."),
    **refusal(503, "The store cannot be read.", "The store cannot be read (disk I/O error)."),
}

# What a call may answer that takes a body
BODY: Responses = {
    **refusal(400, "The body is not JSON.", "There was an error parsing the body"),
    **refusal(413, "The body is too long.", "A request may have 1000000 bytes. Send less at once."),
}

WRITE: Responses = {**READ, **BODY}  # what a call may answer that takes a body for a cage


def cages_of(request: Request) -> dict[str, LiveCage]:
    """The cages that whoever asks may ask about; all where no token was needed."""
    cages: dict[str, LiveCage] = request.app.state.service.cages
    grant: Grant | None = getattr(request.state, "grant", None)
    if grant is None:
        return cages
    action, site = request.state.action, gate_of(request).site
    return {name: one for name, one in cages.items() if grant.allows(action, name, site=site)}


def _cage(request: Request, cage: Annotated[str, Path(max_length=64)]) -> LiveCage:
    cages = cages_of(request)
    if cage not in cages:
        there = ", ".join(cages) or "none that this token opens"
        raise HTTPException(404, f"No cage is called {cage!r}. There are {there}.")
    return cages[cage]


_NAME = r"^[A-Za-z0-9][A-Za-z0-9_.\-]*$"
_WHEN = "2018-01-26T23:08:00Z"
Live = Annotated[LiveCage, Depends(_cage)]
_when = partial(Query, examples=[_WHEN])
At = Annotated[
    Reach | None, _when(description="A time in the past, with its zone; now if left out.")
]
From = Annotated[Reach | None, _when(alias="from", description="First time, included.")]
To = Annotated[Reach | None, _when(alias="to", description="Last time, left out.")]
MOST_ROWS = 10_000  # of an answer
Limit = Annotated[int, Query(ge=1, le=MOST_ROWS, description="At most so many.", examples=[1000])]
_name = partial(Query, max_length=64, pattern=_NAME)
Stream = Annotated[str | None, _name(description="All if left out.", examples=["buoy-1"])]
OneStream = Annotated[str, _name(examples=["buoy-1"])]
Key = Annotated[str, _name(examples=["current_speed_m_s"])]
Width = Annotated[
    int,
    Query(description="Of each span [s].", examples=[600], json_schema_extra={"enum": [60, 600]}),
]

may_read, may_ingest, may_acknowledge, may_administrate = (
    [Depends(Permit(scope))] for scope in ("read", "ingest", "ack", "admin")
)
PAGE = 2000  # samples that an answer without an end holds at a time


async def _costs(request: Request) -> None:
    reads, token = gate_of(request).reads, request.state.token
    limit = request.query_params.get("limit", "")[:6]
    rows = min(max(PAGE, int(limit) if limit.isdecimal() else 0), MOST_ROWS)
    await reads.take(token, rows)
    request.state.reading = token, rows  # given back by the shield


# For calls whose answers are long: they take their rows out of a budget while they are made
may_read_rows = [*may_read, Depends(_costs)]
