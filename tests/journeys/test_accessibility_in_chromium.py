"""axe-core on the page in all its states, in both themes, both languages and at three widths."""

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import timedelta
from functools import partial
from operator import is_not
from pathlib import Path

import pytest

from browser import Line, Watched, opened_browser
from running_service import NOON, Running, buoy, depth, eventually, running
from seacage.twin import AlarmPolicy
from wavy import twin_of_damage

pytestmark = pytest.mark.usefixtures("built_page")
WIDTHS = ((360, 780), (768, 1024), (1440, 900))
# Bridles of the stand-in reach this within the sea that its loads were learned in.
STRICT = AlarmPolicy.from_dict({"load": {"raise_at": 0.2, "clear_at": 0.1, "on_delay_s": 60.0}})
WAVES = {"hs_m": 1.5, "tp_s": 7.0, "wave_from_deg": 200.0}


@pytest.fixture
def axe(pytestconfig: pytest.Config) -> Path:
    """axe-core, which finds faults of accessibility."""
    script = pytestconfig.rootpath / "web" / "node_modules" / "axe-core" / "axe.min.js"
    if not script.is_file():
        pytest.skip("needs axe-core, which the page's build fetches")
    return script


@pytest.fixture
def live(tmp_path: Path) -> Iterator[Running]:
    """Two cages whose twins know the loads of lines in waves, and an hour of readings."""
    with running(tmp_path, names=("ace", "cove"), twin=twin_of_damage(), policy=STRICT) as one:
        one.post(*(each for minutes in range(-60, 1, 10) for each in readings(float(minutes))))
        yield one


def readings(minutes: float) -> tuple[dict, dict]:
    """What buoy and one depth sensor say; no reading is quite like the one before."""
    ripple = 0.01 * (minutes % 3.0)
    sea = buoy(minutes, speed=0.4 + ripple)
    return {**sea, "values": {**sea["values"], **WAVES}}, depth(minutes, metres=14.2 + ripple)


def address(live: Running, *scopes: str) -> str:
    token = live.service.tokens.mint(list(scopes), keep=True, name="Night shift")
    return f"{live.address}/?cage=ace#token={token}"


def raise_alarms(live: Running) -> None:
    """Let the clock go on until loads are beyond their limit and a sensor is silent."""
    for _ in range(2):
        live.clock.at += timedelta(minutes=10)
        live.post(readings((live.clock.at - NOON) / timedelta(minutes=1))[0])
        eventually(live.state, lambda state: state["age_s"] == 0.0, seconds=30.0)
        for _ in range(2):  # the first may be of the step that took the readings in
            eventually(
                lambda: live.cage.snapshot, partial(is_not, live.cage.snapshot), seconds=30.0
            )
    assert len(eventually(live.state, lambda state: len(state["alarms"]) > 1)["alarms"]) > 1


class Looker:
    """Looks at each state at every width, and keeps what axe-core finds."""

    def __init__(self, watched: Watched, axe: Path) -> None:
        self._watched, self._axe = watched, axe
        self.faults: dict[str, list[str]] = {}

    def look(self, state: str) -> None:
        """Look at the page as it is now."""
        page = self._watched.page
        for width, height in WIDTHS:
            page.set_viewport_size({"width": width, "height": height})
            page.wait_for_timeout(150)
            for fault in self._watched.faults(self._axe):
                self.faults.setdefault(state, []).append(f"{width} px: {fault}")
            wide = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
            if beyond := page.evaluate(wide):
                self.faults.setdefault(state, []).append(f"{width} px: {beyond} px stick out")


@contextmanager
def lookers(
    chromium: Path, axe: Path, theme: str, locale: str, *, webgl: bool = False
) -> Iterator[tuple[Watched, Looker]]:
    """A page in a theme and a language; at its end nothing may have been found.

    Drawn flat unless ``webgl``: axe cannot see what is drawn in three dimensions.
    """
    how = {"color_scheme": theme, "locale": locale, "reduced_motion": "reduce"}
    with opened_browser(chromium, webgl=webgl, **how) as watched:
        looker = Looker(watched, axe)
        yield watched, looker
        assert looker.faults == {}
        assert watched.page.evaluate("document.documentElement.lang") == locale[:2]


@pytest.mark.parametrize("locale", ["en-GB", "nb-NO"])
@pytest.mark.parametrize("theme", ["dark", "light"])
def test_axe_finds_no_fault_in_any_state(
    theme: str, locale: str, chromium: Path, live: Running, axe: Path
) -> None:
    with lookers(chromium, axe, theme, locale) as (watched, looker):
        page, look = watched.page, looker.look
        page.goto(f"{live.address}/#token=guess")
        page.locator("#ask .ask-why").wait_for(state="visible")
        look("refused")
        page.goto(address(live, "read"))
        page.reload()
        watched.until("document.querySelector('.verdict')?.dataset.kind == 'well'")
        look("calm")
        for part in page.locator("#panel-loads summary").all():
            part.click()
        page.locator(".parted tbody tr").first.wait_for(state="visible")
        look("tables of lines")
        page.locator(".rose .bar").nth(3).click()
        page.locator(".line-card dd").first.wait_for(state="visible")
        look("line")
        page.keyboard.press("Escape")
        for key, state in (("u", "units"), ("?", "help"), ("f", "farm")):
            page.keyboard.press(key)
            page.locator("dialog[open]").wait_for(state="visible")
            look(state)
            page.keyboard.press("Escape")
        page.locator(".bar-tools > button").last.click()
        look("who")
        page.keyboard.press("Escape")
        raise_alarms(live)
        watched.until("document.querySelectorAll('.toast').length > 0")
        look("toasts")
        page.keyboard.press("2")
        page.locator(".chart").first.wait_for(state="visible")
        look("charts")
        page.keyboard.press("3")
        page.locator("li.alarm").first.wait_for(state="visible")
        look("alarms without the right")
        for tab, state in ((1, "journal"), (2, "key figures")):
            page.locator(".tabs.minor [role=tab]").nth(tab).click()
            page.locator("#panel-alarms table.journal:visible tbody tr").first.wait_for(
                state="visible"
            )
            look(state)
        page.keyboard.press("4")
        page.locator(".whatif-sea input").first.focus()
        page.keyboard.press("PageUp")
        watched.until("document.body.dataset.mode == 'whatif'")
        look("what if")
        page.keyboard.press("l")
        page.locator(".time-slider").focus()
        page.keyboard.press("PageDown")
        watched.until("document.body.dataset.mode == 'past'")
        look("past")


@pytest.mark.parametrize("locale", ["en-GB", "nb-NO"])
@pytest.mark.parametrize("theme", ["dark", "light"])
def test_axe_finds_no_fault_while_alarms_are_handled_and_connections_break(
    theme: str, locale: str, chromium: Path, live: Running, axe: Path
) -> None:
    raise_alarms(live)
    with lookers(chromium, axe, theme, locale) as (watched, looker):
        page, look, line = watched.page, looker.look, Line(watched)
        page.goto(address(live, "read", "ack"))
        watched.until("document.querySelector('.verdict')?.dataset.kind == 'warning'")
        look("alarms raised")
        page.keyboard.press("3")
        for action in ("acknowledge", "shelve"):
            page.locator(f"li.alarm [data-act$=' {action}']").first.click()
            page.locator("dialog[open] textarea").fill("Spring tide")
            look(action)
            page.locator("dialog[open] [type=submit]").click()
            page.locator("dialog[open]").wait_for(state="detached")
        look("acknowledged and shelved")
        page.locator(".tabs.minor [role=tab]").nth(1).click()
        page.locator(".journal-write button").click()
        page.locator("#change-what").select_option("sensor-moved")
        look("work on the cage")
        page.locator("#change-when").fill("2010-01-01T12:00")
        page.locator("dialog[open] [type=submit]").click()
        page.locator("dialog[open] .dialog-fault").wait_for(state="visible")
        look("work refused")
        page.keyboard.press("Escape")
        page.keyboard.press("1")
        page.locator(".rose .bar").nth(3).click()
        page.locator(".line-card button", has_text="…").first.click()
        page.locator("dialog[open] textarea").wait_for(state="visible")
        look("damage begun anew")
        page.keyboard.press("Escape")
        line.break_off()
        watched.until("document.body.dataset.connection == 'lost'")
        look("lost")


@pytest.mark.parametrize("locale", ["en-GB", "nb-NO"])
def test_axe_finds_no_fault_without_any_input(
    locale: str, chromium: Path, tmp_path: Path, axe: Path
) -> None:
    with running(tmp_path) as live, lookers(chromium, axe, "dark", locale) as (watched, looker):
        watched.page.goto(address(live, "read"))
        watched.until("document.body.dataset.valid == 'false'")
        for key in "1234":
            watched.page.keyboard.press(key)
            looker.look(f"panel {key}")


@pytest.mark.parametrize(("theme", "locale"), [("dark", "nb-NO"), ("light", "en-GB")])
def test_axe_finds_no_fault_around_the_net_in_three_dimensions(
    theme: str, locale: str, chromium: Path, live: Running, axe: Path
) -> None:
    with lookers(chromium, axe, theme, locale, webgl=True) as (watched, looker):
        watched.page.goto(address(live, "read"))
        watched.until_drawn()
        looker.look("drawn")
