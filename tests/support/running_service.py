"""A running service with a small twin, and a clock that tests move."""

import asyncio
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import cache
from pathlib import Path

import httpx

from seacage.service._assembly import server
from seacage.service._auth._token_store import Tokens
from seacage.service._http._api import Service
from seacage.service._live._cage import LiveCage
from seacage.service._live._clock import AbstractClock
from seacage.service._live._metrics import Metrics
from seacage.service._live._twin_shelf import TwinShelf
from seacage.service._settings import Settings
from seacage.service._store._store import Store
from seacage.testing import stand_in_twin
from seacage.twin import AlarmPolicy, Twin

# Each client would read all authorities' certificates again, in 20 ms, to speak without TLS.
httpx._transports.default.create_ssl_context = cache(httpx.create_ssl_context)

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


class HandClock(AbstractClock):
    """Stands still until a test moves it: ``at`` goes on, and ``set`` sets it as a person would."""

    def __init__(self, at: datetime = NOON) -> None:
        self._at, self._elapsed_s = at, 0.0

    @property
    def at(self) -> datetime:
        return self._at

    @at.setter
    def at(self, t: datetime) -> None:
        self._elapsed_s += (t - self._at).total_seconds()
        self._at = t

    def set(self, t: datetime) -> None:
        self._at = t

    def now(self) -> datetime:
        return self._at

    def monotonic_s(self) -> float:
        return self._elapsed_s


@dataclass(frozen=True, kw_only=True)
class Running:
    """A service on a port of its own."""

    address: str
    clock: HandClock
    service: Service
    reader: httpx.Client
    logger: httpx.Client

    @property
    def cage(self) -> LiveCage:
        return self.service.cages["ace"]

    def post(self, *samples, cage="ace", **how):
        return self.logger.post(f"/api/v1/cages/{cage}/samples", json={"samples": samples}, **how)

    def state(self, **params):
        return self.reader.get("/api/v1/cages/ace/state", params=params).json()


def buoy(minutes=0.0, speed=0.5, to=90.0, **rest):
    values = {"current_speed_m_s": speed, "current_to_deg": to}
    return {"stream": "buoy-1", "t": at(minutes), "values": values, **rest}


def depth(minutes=0.0, metres=14.0, stream="depth-2"):
    return {"stream": stream, "t": at(minutes), "values": {"depth_m": metres}}


def at(minutes: float) -> str:
    return (NOON + timedelta(minutes=minutes)).isoformat()


def eventually(ask, accept, *, seconds=5.0):
    """The answer, once it is as it should be; the live loop takes a moment."""
    end = time.monotonic() + seconds
    while not accept(answer := ask()) and time.monotonic() < end:
        time.sleep(0.02)
    return answer


@contextmanager
def running(
    folder: Path,
    *,
    names: tuple[str, ...] = ("ace",),
    twin: Twin | None = None,
    policy: AlarmPolicy | None = None,
    shelf: TwinShelf | None = None,
    port: int = 0,
    proxies: tuple[str, ...] = (),
    **service,
) -> Iterator[Running]:
    """Serve cages until the block ends; other options of the service go through."""
    clock, metrics = HandClock(), Metrics()
    store, tokens = Store(folder / "samples.sqlite"), Tokens(folder)
    parts = {"store": store, "clock": clock, "metrics": metrics, "shelf": shelf}
    if policy is not None:
        parts["policy"] = lambda _: policy
    twin = twin or stand_in_twin()
    cages = {name: LiveCage(name=name, twin=twin, tick_s=0.3, **parts) for name in names}
    service = Service(cages=cages, store=store, tokens=tokens, metrics=metrics, **service)
    listener = socket.create_server(("127.0.0.1", port))
    served = server(service, Settings(trusted_proxies=proxies))
    thread = threading.Thread(target=asyncio.run, args=(served.serve([listener]),))
    thread.start()
    address = f"http://127.0.0.1:{listener.getsockname()[1]}"
    clients = [
        httpx.Client(base_url=address, headers={"Authorization": f"Bearer {token}"})
        for token in (tokens.mint(["read"], keep=False), tokens.mint(["ingest"], keep=False))
    ]
    try:
        yield Running(
            address=address, clock=clock, service=service, reader=clients[0], logger=clients[1]
        )
    finally:
        for client in clients:
            client.close()
        served.should_exit = True
        thread.join()
        listener.close()
