"""Connections that are lent to readers and taken back."""

import threading
from collections.abc import Callable, Generator
from contextlib import contextmanager
from typing import Generic, Protocol, TypeVar, runtime_checkable


@runtime_checkable
class _Closable(Protocol):
    def close(self) -> None: ...


C = TypeVar("C", bound=_Closable)
_MOST = 8  # opening one costs more than a query, and a server has no end of them


@contextmanager
def close_on_error(connection: _Closable) -> Generator[None]:
    """Close a connection where the block fails."""
    try:
        yield
    except BaseException:
        connection.close()
        raise


class Pool(Generic[C]):
    """So many connections at most, each as ``opened`` opens it; who finds none free waits."""

    def __init__(self, opened: Callable[[], C]) -> None:
        self._opened = opened
        self._places = threading.BoundedSemaphore(_MOST)
        self._idle: list[C] = []
        self._round = 0

    @contextmanager
    def lend(self) -> Generator[C]:
        """Lend a connection; where its block fails all are closed, as all may be broken."""
        with self._places:
            begun, one = self._round, self._take() or self._opened()
            try:
                yield one
            except BaseException:
                one.close()
                self.close()
                raise
            if begun == self._round:
                self._idle.append(one)
            else:
                one.close()

    def close(self) -> None:
        """Close all that are idle, and the others when they come back."""
        self._round += 1
        while one := self._take():
            one.close()

    def _take(self) -> C | None:
        try:
            return self._idle.pop()
        except IndexError:
            return None
