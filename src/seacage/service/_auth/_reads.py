"""Long answers: how many rows of them may be in the making at one time."""

import asyncio
from collections import Counter

from fastapi import HTTPException

_LOOKS, _PAUSE_S = 10, 0.1  # whoever asks for one answer after the other meets the one before
_LATER_S = 5  # a long answer takes about as long


class Reads:
    """A budget of rows for the answers that are being made: their memory and time go with these.

    ``rows`` and ``rows_per_token``: that may be in the making at one time, of all and of one token.
    """

    def __init__(self, *, rows: int, rows_per_token: int) -> None:
        self._most, self._most_per_token = rows, rows_per_token
        self._taken = Counter[str]()

    async def take(self, token: str, rows: int) -> None:
        """Take rows out of the budget for a while; wait a moment where it is used up.

        Raises HTTPException: 429, with the time to wait.
        """
        mine = False
        for _ in range(_LOOKS):
            mine = self._taken[token] + rows > self._most_per_token
            if not mine and self._taken.total() + rows <= self._most:
                self._taken[token] += rows
                return
            await asyncio.sleep(_PAUSE_S)
        raise HTTPException(
            429,
            f"Answers for {'this token' if mine else 'others'} are still being made, and {rows} "
            f"rows more are too many at a time. Ask again in {_LATER_S} s, or for fewer rows.",
            {"Retry-After": str(_LATER_S)},
        )

    def give_back(self, token: str, rows: int) -> None:
        """Give rows back, once their answer has gone or its reader has."""
        self._taken = self._taken - Counter({token: rows})  # which forgets a token at 0
