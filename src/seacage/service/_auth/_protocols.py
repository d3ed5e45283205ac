"""uvicorn's two protocols, with a time for headers and bodies and a count of connections."""

import asyncio
from typing import Any

import h11
from uvicorn.middleware.proxy_headers import ProxyHeadersMiddleware
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.http11 import Request

from seacage.service._auth._authorization import Gate


def _came(one: Any) -> None:
    address, app = one.client[0] if one.client else "", one.app
    proxied = isinstance(app, ProxyHeadersMiddleware) and address in app.trusted_hosts
    _gate(one).connections.came(one, "" if proxied else address)


def _gate(one: Any) -> Gate:
    return one.config.app.state.service.gate


class LimitedHttp(H11Protocol):
    """HTTP/1.1, by h11 also where httptools is installed: one protocol, one behaviour.

    Headers have to be whole within a time from the connection or from their first byte, and a
    body within another from its headers.
    """

    _awaited = ""
    _deadline: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        super().connection_made(transport)
        _came(self)
        self._await("headers")

    def connection_lost(self, exc: Exception | None) -> None:
        _gate(self).connections.forget(self)
        self._await("")
        super().connection_lost(exc)

    def handle_events(self) -> None:
        before = self.scope
        super().handle_events()
        if self.scope is not before:
            self.scope.setdefault("state", {})["connection"] = self  # its task has not begun yet
        if self.timeout_keep_alive_task is not None:
            self._await("")
        else:
            their = self.conn.their_state
            self._await("headers" * (their is h11.IDLE) or "body" * (their is h11.SEND_BODY))

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        _gate(self).connections.forget(self)
        self._await("upgraded")
        super().handle_websocket_upgrade(event)

    def _await(self, what: str) -> None:
        if self._awaited not in {what, "upgraded"}:
            self._awaited = what
            if self._deadline is not None:
                self._deadline.cancel()
            limits = _gate(self).limits
            times = {"headers": limits.headers_s, "body": limits.body_s}
            if what in times:
                self._deadline = self.loop.call_later(times[what], self._too_slow)

    def _too_slow(self) -> None:
        if self._awaited == "body" and not self.cycle.response_started:
            self.send_400_response("The body did not come in time.")
            self.cycle.disconnected = True
            self.cycle.message_event.set()
        _gate(self).connections.drop(self, f"{self._awaited} too slow")


class LimitedSocket(WebSocketsSansIOProtocol):
    """A WebSocket that is counted from its upgrade on."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        super().connection_made(transport)
        _came(self)

    def connection_lost(self, exc: Exception | None) -> None:
        _gate(self).connections.forget(self)
        super().connection_lost(exc)

    def handle_connect(self, event: Request) -> None:
        super().handle_connect(event)
        if self.response.status_code == 101:
            self.scope.setdefault("state", {})["connection"] = self
