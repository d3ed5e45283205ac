"""JSON posted over HTTP or HTTPS, once."""

import http.client
from abc import ABC
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import quote, urlsplit

from seacage.conventions import InputError

_KINDS = {"http": http.client.HTTPConnection, "https": http.client.HTTPSConnection}

POST_FAILED = (OSError, http.client.HTTPException)
"""What ``post`` raises where nobody answers, or not in HTTP."""


def post(
    address: str, body: str, *, headers: Mapping[str, str], timeout_s: float
) -> tuple[int, bytes]:
    """Post a body of JSON and return the status and body of the answer.

    Parameters
    ----------
    address
        Whole, with its path and query.
    body
        JSON.
    headers
        Besides the type of the content.
    timeout_s
        For the connection and for each part of the answer [s].

    Raises
    ------
    InputError
        The address is none.
    OSError, http.client.HTTPException
        Nobody answers, or not in HTTP.
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


@dataclass(frozen=True, slots=True, kw_only=True)
class AbstractCaller(ABC):
    """Calls about one cage of one service.

    Parameters
    ----------
    address
        Of the service: ``http://127.0.0.1:8000``.
    cage
        Its name there.
    token
        With the scope that the calls take.
    """

    address: str
    cage: str
    token: str

    def post(self, call: str, body: str, *, timeout_s: float = 60.0) -> tuple[int, bytes]:
        """Post JSON to one of the cage's calls, once; see ``post`` of this module."""
        headers = {"Authorization": f"Bearer {self.token}"}
        address = f"{self.address.rstrip('/')}/api/v1/cages/{quote(self.cage, safe='')}/{call}"
        return post(address, body, headers=headers, timeout_s=timeout_s)
