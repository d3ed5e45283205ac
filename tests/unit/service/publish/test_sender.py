import json
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from running_service import NOON, Running
from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._publish._sender import Sender, SendError
from seacage.service._publish._transport import HttpTransport


def sample(minute=0, metres=14.0, stream="depth-2"):
    from datetime import timedelta

    t = NOON - timedelta(minutes=minute)
    return Sample(stream=stream, t=t, values={"depth_m": metres})


class Busy(BaseHTTPRequestHandler):
    """Answers with the codes that a test lists, then with a receipt."""

    def do_POST(self):
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        code = self.server.codes.pop(0) if self.server.codes else 201
        receipt = {"accepted": len(body["samples"]), "duplicates": 0, "rejected": []}
        answer = json.dumps(receipt if code == 201 else {"detail": "later"}).encode()
        self.send_response(code)
        self.send_header("Content-Length", str(len(answer)))
        self.end_headers()
        self.wfile.write(answer)

    def log_message(self, *_):
        pass


@pytest.fixture
def busy() -> Iterator[HTTPServer]:
    server = HTTPServer(("127.0.0.1", 0), Busy)
    server.codes = []
    server.address = f"http://127.0.0.1:{server.server_port}"
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield server
    server.shutdown()
    thread.join()
    server.server_close()


def sender(server, *pauses):
    return Sender(address=server.address, cage="ace", token="t", patience_s=pauses)


@pytest.mark.parametrize("code", [429, 503])
def test_a_service_that_is_busy_is_called_again(busy, code):
    busy.codes = [code, code]
    assert sender(busy, 0.0, 0.0).send([sample()]).accepted == 1


def test_one_that_stays_away_is_given_up(busy):
    busy.codes = [503] * 9
    with pytest.raises(SendError, match="takes no samples"):
        sender(busy, 0.0).send([sample()])


def test_a_refusal_is_not_repeated(busy):
    busy.codes = [403]
    with pytest.raises(InputError, match="403"):
        sender(busy, 0.0).send([sample()])
    assert not busy.codes


def test_a_transport_says_which_samples_arrived_and_which_were_refused(live: Running):
    token = live.service.tokens.mint(["ingest"], keep=False)
    transport = HttpTransport(Sender(address=live.address, cage="ace", token=token))
    kept, refused = transport.send([sample(1), sample(2, stream="depth-99")])
    assert (kept.stream, kept.t, kept.rejected) == ("depth-2", sample(1).t, None)
    assert "No stream is called" in refused.rejected


def test_a_transport_settles_nothing_where_nobody_is(monkeypatch):
    monkeypatch.setattr("seacage.service._publish._transport._PAUSE_S", 0.0)
    nobody = Sender(address="http://127.0.0.1:9", cage="ace", token="t", patience_s=())
    assert HttpTransport(nobody).send([sample()]) == []
