"""A mailbox that holds the latest message only."""

import asyncio
from typing import Generic, TypeVar

T = TypeVar("T")


class Mailbox(Generic[T]):
    """Where a slow reader finds the newest message; what it missed is gone.

    A client that does not read can so never make the service hold more than one message
    for it.
    """

    def __init__(self) -> None:
        self._latest: T | None = None
        self._filled = asyncio.Event()

    def put(self, message: T) -> None:
        """Leave a message in place of the one that was there."""
        self._latest = message
        self._filled.set()

    async def take(self) -> T:
        """Wait for a message and take it."""
        await self._filled.wait()
        self._filled.clear()
        message, self._latest = self._latest, None
        assert message is not None
        return message
