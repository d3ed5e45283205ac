"""How much one asker may ask."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Origin = Annotated[str, Field(pattern=r"^https?://[A-Za-z0-9.\-\[\]:]+$", max_length=300)]


class Limits(BaseModel):
    """The section ``[limits]``; what comes beyond a limit is answered 413 or 429.

    Parameters
    ----------
    requests_per_s, burst
        Of one token, in the long run and at once.
    refusals_per_s, refusal_burst
        Of one address whose token is not known, so that nobody guesses for long.
    body_bytes
        Of one request [bytes].
    live_clients
        Open live connections.
    session_s
        How long a page stays signed in after it was last open [s].
    origins
        Pages from elsewhere that may open a live connection, as ``https://farm.example``.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    requests_per_s: float = Field(default=200.0, gt=0.0, le=1e6)
    burst: float = Field(default=1000.0, ge=1.0, le=1e6)
    refusals_per_s: float = Field(default=2.0, gt=0.0, le=1e6)
    refusal_burst: float = Field(default=50.0, ge=1.0, le=1e6)
    body_bytes: int = Field(default=1_000_000, ge=1000, le=100_000_000)
    live_clients: int = Field(default=1000, ge=1, le=100_000)
    session_s: float = Field(default=43_200.0, ge=60.0, le=2_592_000.0)
    origins: tuple[Origin, ...] = Field(default=(), max_length=100)
