"""JSON posted over HTTP or HTTPS, once, and where alarms are posted to."""

import http.client
from abc import ABC
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated
from urllib.parse import quote, urlsplit

from pydantic import AfterValidator, Field

from seacage.conventions import InputError
from seacage.service._mqtt._topics import Name
from seacage.service._schemas._base import AbstractSection

_KINDS = {"http": http.client.HTTPConnection, "https": http.client.HTTPSConnection}
# What ``post`` raises where nobody answers, or not in HTTP
POST_FAILED = (OSError, http.client.HTTPException)


def post(
    address: str,  # whole, with its path and query
    body: str,  # JSON
    *,
    headers: Mapping[str, str],  # besides the type of the content
    timeout_s: float,  # for the connection and for each part of the answer [s]
) -> tuple[int, bytes]:
    """Post a body of JSON and return the status and body of the answer.

    Raises InputError: the address is none.
    Raises OSError, http.client.HTTPException: nobody answers, or not in HTTP.
    """
    place = urlsplit(address)
    if place.scheme not in _KINDS or place.hostname is None:
        raise InputError(f"{address} is no address. Give one as http://127.0.0.1:8000.")
    connection = _KINDS[place.scheme](place.hostname, place.port, timeout=timeout_s)
    path = f"{place.path or '/'}{'?' + place.query if place.query else ''}"
    try:
        connection.request("POST", path, body, {"Content-Type": "application/json", **headers})
        answer = connection.getresponse()
        return answer.status, answer.read()
    finally:
        connection.close()


def _check_address(url: str) -> str:
    place = urlsplit(url)
    if place.scheme not in _KINDS or place.hostname is None:
        raise ValueError("it is no address. Give one as https://…")
    return url


class Webhook(AbstractSection):
    """One ``[[webhooks]]``: an address that alarms are posted to as JSON."""

    url: Annotated[str, AfterValidator(_check_address)]  # http or https
    severity: int = Field(default=500, ge=1, le=1000)  # the least that is posted, 1 to 1000
    # 0 tells at once whatever is raised, repeated, cleared or acknowledged. More tells only of an
    # alarm that is still active and not acknowledged so long after it was raised [s], which is how
    # one escalates to the next on duty.
    after_s: float = Field(default=0.0, ge=0.0, le=86_400.0)
    # Signs each body: ``X-Seacage-Signature`` is its HMAC-SHA256, in hexadecimal
    secret: str = Field(default="", repr=False)
    cages: tuple[Name, ...] = ()  # whose alarms; all where empty

    def wants(self, cage: str, severity: int) -> bool:
        """Whether an alarm of this severity is posted here."""
        return severity >= self.severity and (not self.cages or cage in self.cages)


@dataclass(frozen=True, slots=True, kw_only=True)
class AbstractCaller(ABC):
    """Calls about one cage of one service."""

    address: str  # of the service: ``http://127.0.0.1:8000``
    cage: str
    token: str  # with the scope that the calls take

    def post(self, call: str, body: str, *, timeout_s: float = 60.0) -> tuple[int, bytes]:
        """Post JSON to one of the cage's calls, once; see ``post`` of this module."""
        headers = {"Authorization": f"Bearer {self.token}"}
        address = f"{self.address.rstrip('/')}/api/v1/cages/{quote(self.cage, safe='')}/{call}"
        return post(address, body, headers=headers, timeout_s=timeout_s)
