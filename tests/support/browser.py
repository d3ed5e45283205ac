"""A page in Debian's headless Chromium: what it shows, whom it asks and what it complains of."""

from __future__ import annotations

import io
import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:  # Playwright is loaded by the tests that open a browser, not by their collection
    from playwright.sync_api import Page, Request, WebSocketRoute

_PLAIN = ("--no-sandbox",)
# WebGL by software: slow, but the same picture on every machine.
_WITH_WEBGL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
_WITHOUT_WEBGL = ("--disable-gpu", "--disable-3d-apis")


class Watched:
    """A page under watch; `page` is Playwright's own."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self._came: list[Request] = []
        self.frame_bytes: list[int] = []
        page.on("console", self._hear)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("requestfinished", self._receive)
        page.on("websocket", lambda line: line.on("framereceived", self._weigh_frame))

    def until(self, script: str, *, seconds: float = 45.0) -> None:
        """Wait until an expression of the page is true."""
        end = time.monotonic() + seconds
        # Not `wait_for_function`: it evaluates in the page, which our security policy forbids.
        while not self.page.evaluate(script):
            assert time.monotonic() < end, f"{script} stays false; complaints: {self.complaints}"
            self.page.wait_for_timeout(100)

    def until_drawn(self) -> None:
        """Wait for the net in three dimensions."""
        self.until("document.body.dataset.connection == 'live'")
        self.until("Number(document.querySelector('#net')?.dataset.frames) > 2")

    def foreign_requests(self, address: str) -> list[str]:
        """Addresses beyond the service's own."""
        own = (address, address.replace("http", "ws", 1), "data:", "blob:")
        return [request for request in self.requests if not request.startswith(own)]

    def loaded_bytes(self) -> int:
        """Bytes of all that was asked for and came, as they went over the wire."""
        return sum(one.sizes()["responseBodySize"] for one in self._came)

    def colours(self, selector: str) -> int:
        """How many colours a part of the page shows; a blank one shows a handful."""
        from PIL import Image

        picture = Image.open(io.BytesIO(self.page.locator(selector).first.screenshot()))
        return len(np.unique(np.asarray(picture.convert("RGB")).reshape(-1, 3), axis=0))

    def faults(self, axe: Path) -> list[str]:
        """Faults of accessibility that axe-core finds, each with where it is."""
        if not self.page.evaluate("'axe' in window"):
            self.page.evaluate(axe.read_text())
        found = self.page.evaluate("axe.run(document, {resultTypes: ['violations']})")
        return [
            json.dumps({"rule": one["id"], "at": [node["target"] for node in one["nodes"]][:5]})
            for one in found["violations"]
        ]

    def _hear(self, message) -> None:
        if message.type in {"error", "warning"} and "GPU stall" not in message.text:
            self.complaints.append(message.text)

    def _receive(self, request: Request) -> None:
        self._came.append(request)  # Playwright takes no bound method of a list

    def _weigh_frame(self, frame: str | bytes) -> None:
        if isinstance(frame, bytes):
            self.frame_bytes.append(len(frame))


@contextmanager
def opened_browser(
    chromium: Path, *, webgl: bool = True, size: tuple[int, int] = (1440, 900), **context: object
) -> Iterator[Watched]:
    """An empty page in a browser of our own; `context` goes to Playwright, as color_scheme."""
    flags = [*_PLAIN, *(_WITH_WEBGL if webgl else _WITHOUT_WEBGL)]
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=flags)
        viewport = {"width": size[0], "height": size[1]}
        try:
            yield Watched(browser.new_context(viewport=viewport, **context).new_page())
        finally:
            browser.close()


class Line:
    """Stands between the page and its live connection, to cut it."""

    def __init__(self, watched: Watched) -> None:
        self._open: list[WebSocketRoute] = []
        self.cut = False
        watched.page.route_web_socket("**/live", self._pass)

    def _pass(self, line: WebSocketRoute) -> None:
        if self.cut:
            line.close(code=1001)
            return
        self._open.append(line)
        line.connect_to_server()

    def break_off(self) -> None:
        """Cut the connection, and every new one until it is mended."""
        self.cut = True
        while self._open:
            self._open.pop().close(code=1001)

    def mend(self) -> None:
        """Let connections through again."""
        self.cut = False
