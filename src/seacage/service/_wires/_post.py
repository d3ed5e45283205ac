"""JSON posted over HTTP or HTTPS, once."""

import http.client
from collections.abc import Mapping
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


def post_to_cage(
    service: str, cage: str, call: str, body: str, *, token: str, timeout_s: float = 60.0
) -> tuple[int, bytes]:
    """Post to one of a cage's calls; see ``post``.

    Parameters
    ----------
    service, cage, call
        Address of the service, name of the cage there, and of the call.
    body, token, timeout_s
        What is sent, who sends it, and for how long one waits [s].
    """
    headers = {"Authorization": f"Bearer {token}"}
    address = f"{service.rstrip('/')}/api/v1/cages/{quote(cage, safe='')}/{call}"
    return post(address, body, headers=headers, timeout_s=timeout_s)
