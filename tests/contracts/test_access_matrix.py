"""Every call, asked by everybody who may not: nothing is told and nothing is done.

The calls are taken from the application's own description, so that a new one cannot be forgotten.
"""

import json
import re

import httpx
import pytest
from fastapi import APIRouter
from websockets.exceptions import ConnectionClosedError
from websockets.sync.client import connect

from running_service import buoy, eventually, running
from seacage.service._auth._limits import Limits
from seacage.service._http import _api

MINE, OTHER = "quebec", "zulu"
PLENTY = Limits(requests_per_s=1e6, burst=1e6, refusals_per_s=1e6, refusal_burst=1e6)
FAR = {"X-Forwarded-For": "192.0.2.1"}
SIGNING = {"get /session", "post /session", "delete /session"}
"""The calls that make and end sessions: a wrong token or none is refused, and no scope is asked."""
OPEN = {"/", "/page", "/api/v1/cages/{cage}/live"}
"""Routes beside those calls: the page, which tells nothing, and the live connection, see below."""

APP = _api.create_app(object.__new__(_api.Service))  # to be described alone
DESCRIBED = APP.openapi()
CALLS = {
    f"{method} {path}": call
    for path, calls in DESCRIBED["paths"].items()
    for method, call in calls.items()
} | {"get /openapi.json": {}}
ACTIONS = (
    {"post /api/v1/cages/{cage}/samples": "ingest"}
    | {call: "ack" for call in CALLS if re.match("post .*/(alarms/|damage/|journal$)", call)}
    | {"post /api/v1/cages/{cage}/twin": "admin"}
)
"""What a call takes that does not only read."""
IDS = {
    "Things": MINE,
    "Locations": MINE,
    "Sensors": f"{MINE}:buoy-1",
    "Datastreams": f"{MINE}:buoy-1:current_speed_m_s",
    "ObservedProperties": "current_speed_m_s",
}
UNKNOWN, KNOWN = ("nobody", "wrong", "ended"), ("lesser", "elsewhere")
TRIED = [
    (call, asker)
    for call in sorted(CALLS)
    for asker in (UNKNOWN if call in SIGNING else UNKNOWN + KNOWN)
]


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    """A service of two cages that have heard something, behind a proxy."""
    folder = tmp_path_factory.mktemp("matrix")
    with running(folder, names=(MINE, OTHER), limits=PLENTY, proxies=("127.0.0.1",)) as one:
        assert one.post(buoy(-10), cage=MINE).status_code == 201
        state = f"/api/v1/cages/{MINE}/state"
        assert eventually(lambda: one.reader.get(state).json()["valid"], bool, seconds=60)
        yield one


@pytest.fixture(scope="module")
def askers(service):
    """The headers of each asker, by the scope that a call takes."""
    tokens = service.service.tokens
    ended = tokens.mint(["admin"], keep=True, name="ended")
    tokens.revoke("ended")
    every = ("read", "ingest", "ack")

    def headers(asker, action):
        token = {
            "nobody": None,
            "wrong": "guess",
            "ended": ended,
            "lesser": tokens.mint([scope for scope in every if scope != action], keep=False),
            "elsewhere": tokens.mint([f"{scope}:{OTHER}" for scope in every], keep=False),
        }[asker]
        return FAR | ({"Authorization": f"Bearer {token}"} if token else {})

    return headers


def request_of(call):
    """A call as its description shows it, about the cage that not everybody may ask about."""
    method, path = call.split()
    described = CALLS[call]
    parameters = described.get("parameters", ())
    for one in parameters:
        if one["in"] == "path":
            path = path.replace(f"{{{one['name']}}}", value_of(one, path))
    query = {one["name"]: value_of(one) for one in parameters if one["required"]}
    content = described.get("requestBody", {}).get("content", {}).get("application/json", {})
    name = content.get("schema", {}).get("$ref", "").rpartition("/")[2]
    shown = DESCRIBED["components"]["schemas"].get(name, {}).get("examples", [None])
    return method.upper(), path, query, shown[0]


def value_of(parameter, path=""):
    """What a parameter's description shows, or that of the other cage in its place."""
    things = [value for name, value in IDS.items() if f"/{name}('{{id}}')" in path]
    if parameter["name"] == "cage" or things:
        return [*things, MINE][0]
    schema = parameter["schema"]
    return (parameter.get("examples") or schema.get("examples") or schema["enum"])[0]


def done(service):
    """Everything that a call may change; what the alarms do by themselves has nobody's name."""
    store = service.service.store
    journal = [line for name in (MINE, OTHER) for line in store.journal(name, limit=1000)]
    return (
        [store.samples(name, limit=1000) for name in (MINE, OTHER)],
        [line for line in journal if line.who],
        len(service.service.gate.sessions._open),
        len(service.service.tokens.all()),
    )


@pytest.mark.parametrize(("call", "asker"), TRIED)
def test_whoever_may_not_learns_nothing_and_changes_nothing(service, askers, call, asker):
    method, path, query, body = request_of(call)
    if call == "post /session":
        body = {"token": "guess"}
    headers = askers(asker, ACTIONS.get(call, "read"))
    before = done(service)
    answer = httpx.request(
        method, f"{service.address}{path}", params=query, json=body, headers=headers, timeout=60
    )
    assert done(service) == before
    # A refusal may repeat what was asked for; an answer may not even name it.
    assert not answer.is_success or MINE not in answer.text
    whole = "{cage}" not in call  # a token for another cage may ask, and is told of its own alone
    if asker in UNKNOWN:
        assert answer.status_code == 401
    elif asker == "elsewhere" and whole:
        assert answer.status_code in {200, 404}
    else:
        assert answer.status_code == 403


@pytest.mark.parametrize("call", sorted(set(CALLS) - SIGNING))
def test_whoever_may_is_let_in(service, call):
    action = ACTIONS.get(call, "read")
    scope = action if action == "admin" else f"{action}:{MINE}"
    token = service.service.tokens.mint([scope], keep=False)
    method, path, query, body = request_of(call)
    headers = FAR | {"Authorization": f"Bearer {token}"}
    answer = httpx.request(
        method, f"{service.address}{path}", params=query, json=body, headers=headers, timeout=60
    )
    assert answer.status_code not in {401, 403}


def test_no_route_stands_beside_the_calls_that_are_tried():
    routers = [one for one in vars(_api).values() if isinstance(one, APIRouter)]
    routes = [one for router in routers for one in router.routes]
    routes += [one for one in APP.routes if hasattr(one, "path")]
    calls = {
        f"{method.lower()} {one.path}": one.path
        for one in routes
        for method in getattr(one, "methods", None) or ["any"]
    }
    assert len(calls) > 50
    assert {path for call, path in calls.items() if call not in CALLS} == OPEN


@pytest.mark.parametrize(
    ("asker", "code"),
    [("nobody", 4401), ("wrong", 4401), ("ended", 4401), ("lesser", 4403), ("elsewhere", 4403)],
)
def test_whoever_may_not_gets_no_live_connection(service, askers, asker, code):
    token = askers(asker, "read").get("Authorization", "").removeprefix("Bearer ") or None
    address = service.address.replace("http", "ws")
    with connect(f"{address}/api/v1/cages/{MINE}/live") as socket:
        socket.send(json.dumps({"token": token}))
        with pytest.raises(ConnectionClosedError) as closed:
            socket.recv(timeout=20)
    assert closed.value.rcvd.code == code
