import json
import logging
import time

import httpx
import pytest
from websockets.exceptions import ConnectionClosedError, InvalidStatus
from websockets.sync.client import connect

from page_frames import decode_frame
from running_service import Running, buoy, eventually, running
from seacage.service._auth._authorization import COOKIE
from seacage.service._auth._limits import Limits


def opened(live: Running, *, cage="ace", **how):
    return connect(f"{live.address.replace('http', 'ws')}/api/v1/cages/{cage}/live", **how)


def token(live: Running, *scopes):
    return json.dumps({"token": live.service.tokens.mint(scopes, keep=False)})


def received(socket):
    message = socket.recv(timeout=5)
    return json.loads(message) if isinstance(message, str) else decode_frame(message)


def closed_with(socket):
    with pytest.raises(ConnectionClosedError) as closed:
        socket.recv(timeout=5)
    return closed.value.rcvd.code


def closed_at_last(socket):
    """What it closes with, after whatever else it says."""
    while True:
        try:
            socket.recv(timeout=5)
        except ConnectionClosedError as closed:
            return closed.rcvd.code


def test_what_never_changes_comes_first_and_then_the_state(idle: Running):
    with opened(idle) as socket:
        socket.send(token(idle, "read"))
        topology, frame = received(socket), received(socket)
    assert topology["kind"] == "topology"
    assert not frame.state["valid"]
    assert frame.displacement.size == 0


def test_a_reading_reaches_the_page(live: Running):
    with opened(live) as socket:
        socket.send(token(live, "read"))
        topology = received(socket)
        live.post(buoy())
        end = time.monotonic() + 5
        while not (frame := received(socket)).state["valid"]:
            assert time.monotonic() < end
    assert frame.displacement.shape == (len(topology["rest_position_m"]), 3)
    assert len(frame.displacement) == len(topology["rest_position_m"])
    assert frame.sigma.shape == (81,)


def test_a_topology_that_changes_is_sent_again_before_the_next_frame(live: Running):
    with opened(live) as socket:
        socket.send(token(live, "read"))
        first = received(socket)
        live.cage.topology = live.cage.topology.model_copy(update={"topology_id": "another"})
        end = time.monotonic() + 5
        while not isinstance(again := received(socket), dict):
            assert time.monotonic() < end
    assert again == first | {"topology_id": "another"}


def test_a_reader_that_lags_gets_the_newest_state_and_not_all_that_it_missed(live: Running):
    with live.cage.subscribe() as mailbox:
        time.sleep(0.5)  # ten ticks
        held = mailbox.get_nowait()
    assert held is live.cage.snapshot or held.answered.t == live.clock.now()


@pytest.mark.parametrize("first", ['{"token": "guess"}', "{}", "no JSON", '"token"', "[1]"])
def test_without_a_token_in_the_first_message_it_closes(idle: Running, first):
    with opened(idle) as socket:
        socket.send(first)
        assert closed_with(socket) == 4401


@pytest.fixture
def errors(caplog):
    """What was logged as an error: a traceback of the service is one."""
    return lambda: [one.getMessage() for one in caplog.records if one.levelno >= logging.ERROR]


def counted(live: Running, code):
    return live.service.metrics.closed.labels(str(code))._value.get()


@pytest.mark.parametrize(
    ("first", "code"),
    [
        ('{"token": "\\ud800"}', 4401),
        ('{"token": 1}', 4401),
        ("[" * 999, 4401),
        (b'{"token": null}', 1003),
        (b"\xff", 1003),
    ],
)
def test_an_odd_first_message_is_closed_with_a_code_and_counted(idle: Running, errors, first, code):
    before = counted(idle, code)
    with opened(idle) as socket:
        socket.send(first)
        assert closed_with(socket) == code
    assert counted(idle, code) == before + 1
    assert errors() == []


def test_bytes_after_the_token_end_the_connection_with_a_code(idle: Running, errors):
    with opened(idle) as socket:
        socket.send(token(idle, "read"))
        socket.send(b"bytes")
        assert closed_at_last(socket) == 1003
    assert errors() == []


def test_a_client_that_closes_while_it_is_being_closed_is_no_error(idle: Running, errors):
    before = counted(idle, 4401)
    for _ in range(20):
        with opened(idle) as socket:
            socket.send('{"token": "guess"}')
            socket.close()
    eventually(lambda: counted(idle, 4401), lambda count: count == before + 20)
    assert errors() == []


def test_a_client_that_leaves_before_its_first_message_is_no_error(idle: Running, errors):
    with opened(idle):
        pass
    with opened(idle) as socket:  # answered after the other was dealt with
        socket.send("{}")
        assert closed_with(socket) == 4401
    assert errors() == []


def test_a_long_name_of_a_cage_fits_its_closing(idle: Running, errors):
    with opened(idle, cage="%C3%A9" * 100) as socket:
        socket.send(token(idle, "read"))
        assert closed_with(socket) == 4404
    assert errors() == []


def test_one_token_cannot_hold_all_live_connections(tmp_path):
    with running(tmp_path, limits=Limits(live_per_token=2, live_clients=3)) as one:
        mine, other, third = (token(one, "read") for _ in range(3))
        with opened(one) as first, opened(one) as second, opened(one) as more:
            for socket in (first, second):
                socket.send(mine)
                received(socket)
            more.send(mine)
            assert closed_with(more) == 4429
            with opened(one) as theirs, opened(one) as too_many:
                theirs.send(other)
                assert received(theirs)["kind"] == "topology"
                too_many.send(third)
                assert closed_with(too_many) == 4429
            first.close()
            eventually(one.service.gate.live.total, lambda count: count == 1)
            with opened(one) as again:
                again.send(mine)
                assert received(again)["kind"] == "topology"


def test_a_first_message_that_comes_too_late_costs_nobody_the_token(
    idle: Running, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("seacage.service._http._websocket._FIRST_MESSAGE_S", 0.05)
    with opened(idle) as socket:
        assert closed_with(socket) == 4408


def test_a_token_that_may_not_read_is_answered_so(idle: Running):
    with opened(idle) as socket:
        socket.send(token(idle, "ingest"))
        assert closed_with(socket) == 4403


def test_a_cage_that_is_not_there_is_answered_so(idle: Running):
    with opened(idle, cage="ice") as socket:
        socket.send(token(idle, "read"))
        assert closed_with(socket) == 4404


def test_a_page_from_elsewhere_is_turned_away_at_the_door(idle: Running):
    with pytest.raises(InvalidStatus, match="403"):
        opened(idle, origin="https://elsewhere.example")


def signed_in(live: Running):
    """The headers of a browser whose page has signed in, and how to sign out."""
    token = live.service.tokens.mint(["read"], keep=False)
    answer = httpx.post(f"{live.address}/session", json={"token": token})
    cookie = f"{COOKIE}={answer.cookies[COOKIE]}"
    return {"Cookie": cookie}, {"Cookie": cookie, "X-CSRF-Token": answer.json()["csrf"]}


def test_a_page_that_has_signed_in_says_no_token_and_is_let_in(idle: Running):
    headers, _ = signed_in(idle)
    with opened(idle, additional_headers=headers, origin=idle.address) as socket:
        socket.send('{"token": null}')
        assert received(socket)["kind"] == "topology"


def test_a_cookie_alone_opens_no_live_connection_for_a_page_from_elsewhere(idle: Running):
    headers, _ = signed_in(idle)
    with pytest.raises(InvalidStatus, match="403"):
        opened(idle, additional_headers=headers, origin="https://elsewhere.example")


def test_signing_out_ends_the_live_connection(live: Running):
    headers, out = signed_in(live)
    with opened(live, additional_headers=headers) as socket:
        socket.send('{"token": null}')
        received(socket)
        assert httpx.delete(f"{live.address}/session", headers=out).status_code == 204
        assert closed_at_last(socket) == 4401


def test_a_token_that_is_revoked_ends_its_live_connections(live: Running):
    token = live.service.tokens.mint(["read"], keep=True, name="ada")
    with opened(live) as socket:
        socket.send(json.dumps({"token": token}))
        received(socket)
        live.service.tokens.revoke("ada")
        assert closed_at_last(socket) == 4401


def test_a_client_that_leaves_is_no_longer_counted(live: Running):
    with opened(live) as socket:
        socket.send(token(live, "read"))
        received(socket)
        received(socket)
        assert len(live.cage._mailboxes) == 1
    end = time.monotonic() + 5
    while live.cage._mailboxes and time.monotonic() < end:
        time.sleep(0.02)
    assert not live.cage._mailboxes


def test_the_way_from_an_answer_to_the_page_is_timed_without_the_first(live: Running):
    with opened(live) as socket:
        socket.send(token(live, "read"))
        for _ in range(4):  # the topology, the present state and two new ones
            received(socket)
        count = live.service.metrics.shown.labels("ace")._sum
        end = time.monotonic() + 5
        while not count.get() and time.monotonic() < end:
            time.sleep(0.02)
        assert 0.0 < count.get() < 5.0


def test_a_client_that_closes_between_two_states_is_no_error(live: Running, errors):
    for _ in range(10):
        with opened(live) as socket:
            socket.send(token(live, "read"))
            received(socket)
    assert eventually(live.service.gate.live.total, lambda count: count == 0) == 0
    assert errors() == []
