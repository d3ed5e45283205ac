"""What the calls share: their cage, their bounds, and the refusals that each documents."""

from typing import Annotated, Any

from fastapi import Depends, HTTPException, Path, Query, Request

from seacage.service._access._guard import Permit
from seacage.service._forms._schemas import Problem, Reach
from seacage.service._live._cage import LiveCage

Responses = dict[int | str, dict[str, Any]]


def refusal(code: int, description: str, example: str) -> Responses:
    """Document one way in which a call may be refused."""
    content = {"application/json": {"example": {"detail": example}}}
    return {code: {"model": Problem, "description": description, "content": content}}


REFUSED: Responses = {
    **refusal(401, "No token, or one that is not known.", "Send a token as 'Authorization: …'."),
    **refusal(403, "The token lacks the scope.", "This token does not have the scope ack."),
    **refusal(422, "A parameter is out of bounds.", "limit: should be at most 10000."),
    429: {
        **refusal(429, "Asked too often.", "This token asks too often. Ask again in 2 s.")[429],
        "headers": {"Retry-After": {"schema": {"type": "integer"}, "description": "Seconds."}},
    },
}
"""What any call may answer that takes a token."""

READ: Responses = {
    **REFUSED,
    **refusal(404, "No cage of this name.", "No cage is called 'ice'. There are ace."),
    **refusal(503, "The store cannot be read.", "The store cannot be read (disk I/O error)."),
}
"""What a call may answer that reads of a cage."""

BODY: Responses = {
    **refusal(400, "The body is not JSON.", "There was an error parsing the body"),
    **refusal(413, "The body is too long.", "A request may have 1000000 bytes. Send less at once."),
}
"""What a call may answer that takes a body."""

WRITE: Responses = {**READ, **BODY}
"""What a call may answer that takes a body for a cage."""


def _cage(request: Request, cage: Annotated[str, Path(max_length=64)]) -> LiveCage:
    cages: dict[str, LiveCage] = request.app.state.service.cages
    if cage not in cages:
        raise HTTPException(404, f"No cage is called {cage!r}. There are {', '.join(cages)}.")
    return cages[cage]


_NAME = r"^[A-Za-z0-9][A-Za-z0-9_.\-]*$"
_WHEN = "2018-01-26T23:08:00Z"

Live = Annotated[LiveCage, Depends(_cage)]
At = Annotated[
    Reach | None,
    Query(description="A time in the past, with its zone; now if left out.", examples=[_WHEN]),
]
From = Annotated[
    Reach | None, Query(alias="from", description="First time, included.", examples=[_WHEN])
]
To = Annotated[
    Reach | None, Query(alias="to", description="Last time, left out.", examples=[_WHEN])
]
Limit = Annotated[int, Query(ge=1, le=10_000, description="At most so many.", examples=[1000])]
Stream = Annotated[
    str | None,
    Query(max_length=64, pattern=_NAME, description="All if left out.", examples=["buoy-1"]),
]
OneStream = Annotated[str, Query(max_length=64, pattern=_NAME, examples=["buoy-1"])]
Key = Annotated[str, Query(max_length=64, pattern=_NAME, examples=["current_speed_m_s"])]
Width = Annotated[
    int,
    Query(description="Of each span [s].", examples=[600], json_schema_extra={"enum": [60, 600]}),
]

may_read, may_ingest = [Depends(Permit("read"))], [Depends(Permit("ingest"))]
may_acknowledge = [Depends(Permit("ack"))]
