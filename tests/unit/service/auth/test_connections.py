import json
import logging
import resource
import socket
import time
from contextlib import ExitStack

import httpx
import pytest
import uvicorn
from starlette.requests import HTTPConnection
from websockets.sync.client import connect

from running_service import Running, buoy, eventually, running
from seacage.service._assembly import server
from seacage.service._auth import _connections
from seacage.service._auth._connections import Connections
from seacage.service._auth._limits import Limits
from seacage.service._auth._protocols import LimitedHttp
from seacage.service._live._metrics import Metrics
from seacage.service._settings import Settings

HEADS = b"POST /session HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
BODY = HEADS + b"Content-Length: 90\r\n\r\n{"


class Line:
    """As uvicorn's protocol, whose transport only says that it was ended."""

    def __init__(self, address="10.0.0.1"):
        self.client, self.transport, self.ended = (address, 1), self, False

    def abort(self):
        self.ended = True


def book(**limits):
    return Connections(Limits(**limits), Metrics())


def of_token(connections, line, token):
    scope = {"type": "http", "state": {"connection": line}}
    connections.knows(HTTPConnection(scope), token)


def came(connections, *addresses):
    lines = [Line(address) for address in addresses]
    for line in lines:
        connections.came(line, line.client[0])
    return lines


def test_the_oldest_strange_connection_of_an_address_gives_way_to_its_newest():
    connections = book(connections_per_address=2)
    lines = came(connections, "a", "b", "a", "a")
    assert [line.ended for line in lines] == [True, False, False, False]


def test_strangers_hold_half_of_all_connections_at_most():
    connections = book(connections=10)
    known = came(connections, *[f"known {n}" for n in range(5)])
    for line in known:
        of_token(connections, line, "ada")
    strangers = came(connections, *[f"{n}" for n in range(100)])
    assert not any(line.ended for line in known)
    assert [line.ended for line in strangers] == [True] * 95 + [False] * 5


def test_the_token_that_holds_most_loses_where_there_are_too_many():
    connections = book(connections=10)
    (ada,) = came(connections, "a")
    of_token(connections, ada, "ada")
    bobs = [came(connections, "b")[0] for _ in range(8)]
    for line in bobs[:4]:
        of_token(connections, line, "bob")
    more = [came(connections, f"{n}")[0] for n in range(4)]
    for line in more:
        of_token(connections, line, "bob")
    came(connections, "c", "d")
    assert not ada.ended


def test_one_token_holds_no_more_connections_than_it_may():
    connections = book(connections_per_token=2)
    lines = came(connections, "a", "b", "c")
    for line in lines:
        of_token(connections, line, "ada")
    assert [line.ended for line in lines] == [True, False, False]


def test_a_connection_that_has_left_counts_no_more():
    connections = book(connections_per_address=1)
    (first,) = came(connections, "a")
    connections.forget(first)
    (second,) = came(connections, "a")
    assert not first.ended
    assert not second.ended


def test_fewer_connections_are_held_than_the_system_lets_files_be_open(monkeypatch):
    monkeypatch.setattr(resource, "getrlimit", lambda _: (1024, 1024))
    assert _connections._descriptors() == 1024 - 256
    monkeypatch.setattr(resource, "getrlimit", lambda _: (resource.RLIM_INFINITY,) * 2)
    assert _connections._descriptors() > 100_000


@pytest.fixture(scope="module")
def brisk(tmp_path_factory):
    """A service that waits for nobody for long."""
    limits = Limits(headers_s=0.3, body_s=0.3)
    with running(tmp_path_factory.mktemp("brisk"), limits=limits) as one:
        yield one


def line_to(one: Running):
    host, port = one.address.removeprefix("http://").split(":")
    return socket.create_connection((host, int(port)), timeout=20)


def all_that_comes(line):
    """Until the service ends the connection; a test that waits in vain fails by its time."""
    parts = []
    try:
        while part := line.recv(4096):
            parts.append(part)
    except ConnectionResetError:
        pass
    return b"".join(parts)


@pytest.mark.parametrize("sent", [b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: x\r\n"])
def test_headers_that_do_not_come_end_the_connection(brisk: Running, sent):
    with line_to(brisk) as line:
        line.sendall(sent)
        assert all_that_comes(line) == b""


def test_headers_that_drip_end_the_connection(brisk: Running):
    with line_to(brisk) as line:
        line.settimeout(0.05)
        line.sendall(b"GET / HTTP/1.1\r\n")
        end = time.monotonic() + 20
        ended = False
        while not ended and time.monotonic() < end:
            try:
                line.sendall(b"X")
                ended = line.recv(1) == b""
            except TimeoutError:
                pass
            except OSError:
                ended = True
        assert ended


def test_headers_that_drip_after_an_answer_end_the_connection_too(brisk: Running):
    with line_to(brisk) as line:
        line.sendall(b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n")
        line.sendall(b"GET /hea")
        answers = all_that_comes(line)
    assert answers.count(b"HTTP/1.1") == 1
    assert answers.startswith(b"HTTP/1.1 200")


def test_a_body_that_does_not_come_is_refused(brisk: Running, caplog):
    with line_to(brisk) as line:
        line.sendall(BODY)
        assert all_that_comes(line).startswith(b"HTTP/1.1 400")
    assert [one for one in caplog.records if one.levelno >= logging.ERROR] == []
    assert brisk.service.metrics.dropped.labels("body too slow")._value.get() >= 1


def test_a_whole_request_takes_as_long_as_it_needs(brisk: Running):
    token = brisk.service.tokens.mint(["read"], keep=False)
    address = brisk.address.replace("http", "ws")
    with connect(f"{address}/api/v1/cages/ace/live") as live:
        live.send(json.dumps({"token": token}))
        with line_to(brisk) as line:
            line.sendall(b"GET /he")
            assert all_that_comes(line) == b"", "longer than headers may take"
        frames = [live.recv(timeout=20) for _ in range(3)]
    assert len(frames) == 3, "a live connection is not waited for"


@pytest.mark.parametrize("sent", [b"", b"GET / HTTP/1.1\r\n", BODY])
def test_half_requests_of_many_leave_room_for_whole_ones(tmp_path, monkeypatch, sent):
    monkeypatch.setattr(_connections, "_descriptors", lambda: 40)
    limits = Limits(headers_s=600, body_s=600)
    with ExitStack() as held, running(tmp_path, limits=limits) as one:
        for _ in range(100):
            line = held.enter_context(line_to(one))
            line.sendall(sent)
        for _ in range(5):
            with httpx.Client() as fresh:
                token = one.service.tokens.mint(["read"], keep=False)
                headers = {"Authorization": f"Bearer {token}"}
                assert fresh.get(f"{one.address}/api/v1/cages", headers=headers).is_success
        assert one.post(buoy()).status_code == 201
        dropped = one.service.metrics.dropped.labels("too many strangers")._value.get
        assert eventually(dropped, lambda count: count >= 80) >= 80


def test_connections_of_a_proxy_count_for_the_addresses_that_it_names(tmp_path):
    limits = Limits(connections_per_address=2)
    with running(tmp_path, limits=limits, proxies=("127.0.0.1",)) as one, ExitStack() as held:
        lines = [held.enter_context(line_to(one)) for _ in range(6)]
        for number, line in enumerate(lines):
            address = "10.0.0.1" if number < 3 else f"10.0.0.{number}"
            line.sendall(
                f"GET /page/none HTTP/1.1\r\nHost: x\r\nX-Forwarded-For: {address}\r\n\r\n".encode()
            )
            assert line.recv(4096).startswith(b"HTTP/1.1 404")
        all_that_comes(lines[0])
        assert one.service.metrics.dropped.labels("too many of one asker")._value.get() == 1


def test_one_protocol_speaks_whatever_else_is_installed(idle: Running):
    config = server(idle.service, Settings(trusted_proxies=("10.0.0.0/8", "::1"))).config
    config.load()
    assert config.http_protocol_class is LimitedHttp
    assert config.forwarded_allow_ips == ["10.0.0.0/8", "::1/128"]
    assert isinstance(config, uvicorn.Config)
