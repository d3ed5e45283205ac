import asyncio
import hashlib
import hmac
import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import SimpleNamespace
from unittest.mock import Mock

import pytest

from seacage.conventions import InputError
from seacage.service._live._alarm_desk import Announcement
from seacage.service._live._cage import LiveCage
from seacage.service._publish import _webhooks
from seacage.service._publish._post import Webhook
from seacage.service._publish._webhooks import WebhookNotifier
from seacage.service._settings import read_settings
from seacage.twin import Action, Alarm, AlarmEvent, AlarmText

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


class Desk:
    """A cage's alarms, as far as a herald asks for them."""

    def __init__(self):
        self.listeners, self.open = [], []

    def subscribe(self, listener):
        self.listeners.append(listener)

    def standing(self):
        return self.open


def announcement(action=Action.RAISED, severity=700, **how):
    alarm = Alarm(name="load.bridle-3", active=True, acknowledged=False, since=NOON)
    return Announcement(
        cage="ace",
        happened=AlarmEvent(alarm=alarm.name, action=action, t=NOON, **how),
        alarm=alarm,
        text=AlarmText(
            title="Bridle 3 is loaded",
            message="…",
            advice="…",
            unit="1",
            key="load.active",
            values={"source": "bridle-3", "value_share": 0.9},
        ),
        severity=severity,
    )


@contextmanager
def listening(*answers: int) -> Iterator[tuple[str, list]]:
    """A receiver that answers with these codes in turn, the last one for ever."""
    received, codes = [], list(answers or (204,))

    class Receiver(BaseHTTPRequestHandler):
        def do_POST(self):
            body = self.rfile.read(int(self.headers["Content-Length"]))
            received.append((json.loads(body), self.headers, body))
            self.send_response(codes.pop(0) if len(codes) > 1 else codes[0])
            self.end_headers()

        def log_message(self, *_):
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Receiver)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/hook?to=night", received
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def received_by(
    hook: Webhook, heard: list, *announced: Announcement, now=NOON, standing=(), count=1
):
    """What a hook hears, once it has heard so much or a second has passed."""
    desk = Desk()
    desk.open = list(standing)
    cage = Mock(LiveCage, desk=desk, clock=SimpleNamespace(now=lambda: now))

    async def work():
        herald = WebhookNotifier([hook], {"ace": cage})
        running = asyncio.create_task(herald.run())
        for one in announced:
            desk.listeners[0](one)
        for _ in range(300):
            if len(heard) >= count:
                break
            await asyncio.sleep(0.01)
        await asyncio.sleep(0.1)
        running.cancel()

    asyncio.run(work())
    return [body for body, _, _ in heard]


@pytest.fixture(autouse=True)
def no_patience(monkeypatch):
    monkeypatch.setattr(_webhooks, "_LOOK_S", 0.01)
    monkeypatch.setattr(_webhooks, "_PATIENCE_S", (0.01, 0.01))


def test_a_hook_hears_what_is_raised_in_words_and_can_check_who_speaks():
    with listening() as (url, received):
        (body,) = received_by(Webhook(url=url, secret="s3"), received, announcement())
    assert (body["cage"], body["alarm"], body["action"]) == ("ace", "load.bridle-3", "raised")
    assert body["title"] == "Bridle 3 is loaded"
    assert (body["key"], body["values"]["value_share"]) == ("load.active", 0.9)
    _, headers, raw = received[0]
    signature = hmac.new(b"s3", raw, hashlib.sha256).hexdigest()
    assert headers["X-Seacage-Signature"] == signature


def test_what_is_quiet_or_mild_or_a_remark_is_not_announced():
    with listening() as (url, received):
        bodies = received_by(
            Webhook(url=url, severity=500),
            received,
            announcement(severity=499),
            announcement(quiet=True),
            announcement(Action.COMMENTED),
            announcement(Action.CLEARED),
        )
    assert [body["action"] for body in bodies] == ["cleared"]


def test_a_hook_that_fails_is_tried_again_and_in_order():
    with listening(503, 503, 204) as (url, received):
        bodies = received_by(
            Webhook(url=url), received, announcement(), announcement(Action.CLEARED), count=4
        )
    assert [body["action"] for body in bodies] == ["raised", "raised", "raised", "cleared"]


def test_the_next_on_duty_is_notified_once_when_nobody_acknowledges():
    with listening() as (url, received):
        hook = Webhook(url=url, after_s=600.0)
        assert not received_by(
            hook,
            received,
            announcement(),
            standing=[announcement()],
            now=NOON + timedelta(minutes=9),
        )
        bodies = received_by(
            hook, received, standing=[announcement()], now=NOON + timedelta(minutes=10)
        )
    assert [body["action"] for body in bodies] == ["escalated"]


def test_an_alarm_that_comes_again_and_again_is_announced_each_time_and_remembered_once():
    hook, desk = Webhook(url="http://x", after_s=600.0), Desk()
    now = [NOON]
    cage = Mock(LiveCage, desk=desk, clock=SimpleNamespace(now=lambda: now[0]))
    herald = WebhookNotifier([hook], {"ace": cage})
    for times in range(1, 51):
        raised = announcement()
        desk.open = [replace(raised, alarm=replace(raised.alarm, since=now[0]))]
        now[0] += timedelta(minutes=11)
        herald._overdue(hook)
        herald._overdue(hook)
        assert len(herald._queues[hook]) == times
    assert len(herald._escalated) == 1


@pytest.mark.parametrize(
    ("wrong", "why"),
    [
        ({"url": "ftp://x"}, "webhooks.0.url does not do: it is no address"),
        ({"url": "http://"}, "webhooks.0.url does not do: it is no address"),
        ({"url": "http://x", "severity": 0}, "severity = 0"),
        ({"url": "http://x", "after_s": -1.0}, "after_s = -1"),
    ],
)
def test_a_hook_that_cannot_be_is_refused(wrong, why):
    with pytest.raises(InputError, match=why):
        read_settings(webhooks=[wrong])
