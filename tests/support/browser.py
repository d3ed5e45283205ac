"""A page in headless Chromium, spoken to by the browser's own debugging protocol."""

import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
from websockets.sync.client import ClientConnection, connect

from outside import serving, wait_for

HEADLESS = ("--headless", "--no-sandbox", "--remote-debugging-port=0", "about:blank")
PROBLEMS = ("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded")


class Page:
    """One open page: what it shows, which addresses it asked and what it complained of."""

    def __init__(self, line: ClientConnection) -> None:
        self.asked: list[str] = []
        self.complaints: list[str] = []
        self._line = line
        self._calls = 0
        for domain in ("Page", "Runtime", "Log", "Network"):
            self._call(f"{domain}.enable")

    def open(self, address: str) -> None:
        """Go there."""
        self._call("Page.navigate", url=address)

    def value(self, script: str) -> object:
        """What a script's expression is in the page."""
        return self._call("Runtime.evaluate", expression=script)["result"].get("value")

    def until(self, script: str, *, seconds: float = 30.0) -> None:
        """Wait until an expression is true."""
        end = time.monotonic() + seconds
        while not self.value(script):
            body = self.value("document.body.outerHTML")
            assert time.monotonic() < end, f"{script} stays false; {self.complaints}\n{body}"
            time.sleep(0.1)

    def _call(self, method: str, **params: object) -> dict:
        self._calls += 1
        self._line.send(json.dumps({"id": self._calls, "method": method, "params": params}))
        while (told := json.loads(self._line.recv(timeout=30))).get("id") != self._calls:
            self._hear(told)
        return told["result"]

    def _hear(self, told: dict) -> None:
        if told["method"] == "Network.requestWillBeSent":
            self.asked.append(told["params"]["request"]["url"])
        if told["method"] in PROBLEMS:
            self.complaints.append(json.dumps(told["params"]))


@contextmanager
def blank_page(chromium: Path, profile: Path) -> Iterator[Page]:
    """An empty page of a browser of our own, whose profile is a folder that may go away."""
    where = profile / "DevToolsActivePort"
    with serving([chromium, f"--user-data-dir={profile}", *HEADLESS]):
        wait_for(where.read_text)
        port = where.read_text().split()[0]
        tabs = httpx.get(f"http://127.0.0.1:{port}/json").json()
        address = next(tab["webSocketDebuggerUrl"] for tab in tabs if tab["type"] == "page")
        with connect(address, max_size=None) as line:
            yield Page(line)
