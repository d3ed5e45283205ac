"""The live connection of the page."""

import asyncio
import json

from fastapi import APIRouter, WebSocket, WebSocketDisconnect

from seacage.service._guard import same_origin
from seacage.service._live import LiveCage
from seacage.service._tokens import Tokens

_FIRST_MESSAGE_S = 5.0
_FIRST_MESSAGE_BYTES = 1000
UNKNOWN_TOKEN, NO_SCOPE, NO_CAGE = 4401, 4403, 4404
"""Codes of a closing: the page tells its reader which it was."""

sockets = APIRouter()


@sockets.websocket("/api/v1/cages/{cage}/live")
async def live(socket: WebSocket, cage: str) -> None:
    """Send what does not change once, then the newest state whenever the reader is ready.

    The first message of the client is ``{"token": …}``: a URL would end up in logs.
    """
    if not same_origin(socket.headers.get("origin"), socket.headers.get("host")):
        await socket.close()  # before it is accepted: the browser gets a 403
        return
    await socket.accept()
    refusal = await _refusal(socket, cage)
    if refusal is not None:
        await socket.close(*refusal)
        return
    one: LiveCage = socket.app.state.service.cages[cage]
    sending = asyncio.create_task(_send(socket, one))
    try:
        while True:  # nothing more is asked; this only notices that the client has left
            await socket.receive_text()
    except WebSocketDisconnect:
        pass
    finally:
        sending.cancel()
        await asyncio.gather(sending, return_exceptions=True)


async def _send(socket: WebSocket, one: LiveCage) -> None:
    known = ""
    with one.watched() as mailbox:
        while True:
            snapshot = await mailbox.take()
            if one.topology.topology_id != known:
                known = one.topology.topology_id
                await socket.send_text(one.topology.model_dump_json())
            await socket.send_bytes(snapshot.frame)


async def _refusal(socket: WebSocket, cage: str) -> tuple[int, str] | None:
    tokens: Tokens = socket.app.state.service.tokens
    token = await _token(socket)
    grant = tokens.grant(token) if token else None
    if grant is None:
        return UNKNOWN_TOKEN, 'The first message is {"token": …} with a token that is known.'
    if not grant.allows("read", cage):
        return NO_SCOPE, "This token does not have the scope read."
    if cage not in socket.app.state.service.cages:
        return NO_CAGE, f"No cage is called {cage!r}."[:100]
    return None


async def _token(socket: WebSocket) -> str | None:
    try:
        text = await asyncio.wait_for(socket.receive_text(), _FIRST_MESSAGE_S)
        token = json.loads(text[:_FIRST_MESSAGE_BYTES])["token"]
    except (TimeoutError, WebSocketDisconnect, ValueError, KeyError, TypeError):
        return None
    return token if isinstance(token, str) else None
