"""Draw the live page in its main states: docs/pictures/page-*.png.

A day of the demonstration's field is lived through in a minute, and Chromium looks at its end.
The other cages of the farm are the same twin in other hours' water. Needs `make page` and Chromium.

    .venv/bin/python tools/draw_page.py [--data var] [--only NAME]
"""

import argparse
import asyncio
import io
import socket
import sys
import tempfile
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from shutil import which

import uvicorn
from PIL import Image
from playwright.sync_api import Page, sync_playwright

from seacage.records import Sample
from seacage.service._auth._token_store import Tokens
from seacage.service._http._api import Service, create_app
from seacage.service._live._cage import LiveCage
from seacage.service._live._metrics import Metrics
from seacage.service._live._replay import Replay, replay_of
from seacage.service._store._store import open_store
from seacage.studies import Demonstration, prepare_demonstration
from seacage.studies._demonstration_field import read_demonstration_field
from seacage.twin import AlarmPolicy, Twin

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
CALM = datetime(2020, 1, 20, 15, 0, tzinfo=UTC)
PEAK = datetime(2020, 1, 21, 6, 20, tzinfo=UTC)
# Below the usual 0.8, so that the hours shown here reach it.
LIMITS = {"load": {"raise_at": 0.45, "clear_at": 0.4}}
DAY, STEP = timedelta(hours=24), timedelta(minutes=10)
WIDE, PHONE = (1440, 900), (390, 844)
PATIENCE_MS = 120_000  # WebGL by software is slow
FLAGS = ("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
FLAT_FLAGS = ("--no-sandbox", "--disable-gpu", "--disable-3d-apis")


class StandingClock:
    """Stands still between two steps, so that pictures come out alike."""

    speed = 1.0

    def __init__(self, at: datetime) -> None:
        self.at = self.start = at

    def now(self) -> datetime:
        """Where it stands."""
        return self.at

    def monotonic_s(self) -> float:
        """What has passed, which agrees with it: nobody set this clock."""
        return (self.at - self.start).total_seconds()


@dataclass(frozen=True, kw_only=True)
class Shown:
    """A service that has lived through its day."""

    address: str
    token: str


@dataclass(frozen=True, kw_only=True)
class Others:
    """A cage in earlier water, and silent for the last hours where it says so."""

    hours: float
    silent: timedelta = timedelta(0)


FARM = {
    "ace": Others(hours=0.0),
    "bay": Others(hours=9.0),
    "cove": Others(hours=27.5, silent=timedelta(hours=4)),
    "fjord": Others(hours=21.3),
    "holm": Others(hours=47.2),
    "skerry": Others(hours=35.9),
}


def samples_of(replay: Replay, other: Others, start: datetime, end: datetime) -> list[Sample]:
    """What a cage hears in a span, taken from another one."""
    shift = timedelta(hours=other.hours)
    spans = (record.between(start - shift, end - shift).samples() for record in replay.records)
    moved = (replace(one, t=one.t + shift) for span in spans for one in span)
    return sorted(moved, key=lambda one: one.t)


@contextmanager
def lived(made: Demonstration, end: datetime, names: tuple[str, ...]) -> Iterator[Shown]:
    """Serve cages that have heard all until a time, and have judged it step by step."""
    field = read_demonstration_field()
    twin, replay = Twin.read(made.twin_folder), replay_of(field.buoy, field)
    policy = AlarmPolicy.from_dict(LIMITS, twin.cage, buoy=twin.buoy, timeouts=twin.timeouts)
    clock, metrics = StandingClock(end - DAY), Metrics()
    with tempfile.TemporaryDirectory() as folder:
        store, tokens = open_store(Path(folder) / "samples.sqlite"), Tokens(Path(folder))
        parts = {"twin": twin, "store": store, "clock": clock, "metrics": metrics}
        cages = {
            one: LiveCage(name=one, policy=lambda _: policy, tick_s=0.5, **parts) for one in names
        }
        service = Service(cages=cages, store=store, tokens=tokens, metrics=metrics)
        listener = socket.create_server(("127.0.0.1", 0))
        config = uvicorn.Config(create_app(service), ws="websockets-sansio", log_config=None)
        server = uvicorn.Server(config)
        loop = asyncio.new_event_loop()
        work = threading.Thread(target=loop.run_until_complete, args=(server.serve([listener]),))
        work.start()
        try:
            while clock.at < end:
                start, clock.at = clock.at, min(clock.at + STEP, end)
                for name, cage in cages.items():
                    received_until = min(clock.at, end - FARM[name].silent)
                    received = samples_of(replay, FARM[name], start, received_until)
                    if received_until > start and received:
                        asyncio.run_coroutine_threadsafe(cage.take(received), loop).result()
                while any(cage.snapshot.state.t < clock.at for cage in cages.values()):
                    time.sleep(0.02)
            seen(cages.values(), loop)
            token = tokens.mint(["read", "ack"], keep=False, name="Night shift")
            yield Shown(address=f"http://127.0.0.1:{listener.getsockname()[1]}/", token=token)
        finally:
            server.should_exit = True
            work.join()
            listener.close()


def seen(cages: Iterable[LiveCage], loop: asyncio.AbstractEventLoop) -> None:
    """Acknowledge what came and went, as a shift does before it hands over."""
    for cage in cages:
        gone = [one for one in cage.desk.waiting() if not one.active]
        for alarm in gone:
            done = cage.handle(alarm.id, "acknowledge", who="Night shift", why="", seconds=None)
            asyncio.run_coroutine_threadsafe(done, loop).result()


@contextmanager
def opened(
    shown: Shown, *, size: tuple[int, int] = WIDE, scheme: str = "dark", flat: bool = False
) -> Iterator[Page]:
    """The page of cage ace, once it is drawn."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=which("chromium"), args=[*(FLAT_FLAGS if flat else FLAGS)]
        )
        width, height = size
        context = browser.new_context(
            viewport={"width": width, "height": height},
            color_scheme=scheme,
            reduced_motion="reduce",
        )
        page = context.new_page()
        page.set_default_timeout(PATIENCE_MS)
        page.goto(f"{shown.address}?cage=ace#token={shown.token}")
        page.wait_for_selector(".flat-bridle" if flat else "#net[data-frames]", state="attached")
        page.wait_for_timeout(4000)
        try:
            yield page
        finally:
            browser.close()


def kept(page: Page, name: str) -> None:
    """Write what the page shows as a picture."""
    page.wait_for_timeout(2500)
    picture = Image.open(io.BytesIO(page.screenshot(timeout=PATIENCE_MS))).convert("RGB")
    # 256 colours make it light; chosen by extent, so that a small amber dot keeps its own.
    few = picture.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=2)
    file = PICTURES / f"page-{name}.png"
    picture.quantize(palette=few).save(file, optimize=True)
    print(f"{file.name}: {file.stat().st_size / 1000:.0f} kB", file=sys.stderr)


def draw_calm(shown: Shown) -> None:
    """Draw what an operator sees where all is well."""
    with opened(shown) as page:
        kept(page, "live-dark")
        page.keyboard.press("2")
        kept(page, "charts")
        page.keyboard.press("4")
        slider = page.get_by_role("slider", name="Current", exact=True)
        slider.focus()
        for _ in range(3):
            page.keyboard.press("PageUp")
        kept(page, "what-if")
    with opened(shown, scheme="light") as page:
        kept(page, "live-light")
    with opened(shown, scheme="light", flat=True) as page:
        kept(page, "flat")
    with opened(shown, size=PHONE) as page:
        kept(page, "phone")


def draw_peak(shown: Shown) -> None:
    """Draw an alarm, what was before it, and the farm."""
    with opened(shown) as page:
        page.keyboard.press("3")
        kept(page, "alarm")
        page.keyboard.press("1")
        page.locator(".rose .bar").nth(8).click()
        kept(page, "line")
        page.keyboard.press("Escape")
        page.get_by_label("Time that is shown").focus()
        for _ in range(2):
            page.keyboard.press("PageDown")
        kept(page, "past")
        page.keyboard.press("l")
        page.keyboard.press("f")
        kept(page, "farm")


def main() -> None:
    """Draw all, or the calm or the peak alone."""
    ask = argparse.ArgumentParser(description=__doc__)
    ask.add_argument("--data", type=Path, default=Path("var"), help="where `make run` keeps things")
    ask.add_argument("--only", choices=("calm", "peak"))
    arguments = ask.parse_args()
    made = prepare_demonstration(arguments.data / "demonstration")
    if arguments.only != "peak":
        with lived(made, CALM, ("ace",)) as shown:
            draw_calm(shown)
    if arguments.only != "calm":
        with lived(made, PEAK, tuple(FARM)) as shown:
            draw_peak(shown)


if __name__ == "__main__":
    main()
