"""What an operator does at the page, from a calm sea to an alarm and back, in a real browser."""

import json
from datetime import datetime, timedelta
from functools import partial
from operator import is_not
from pathlib import Path
from typing import Any

import pytest

from browser import Watched, opened_browser
from running_service import NOON, Running, buoy, depth, eventually, running
from seacage.testing import stand_in_twin
from seacage.twin import AlarmPolicy

pytestmark = pytest.mark.usefixtures("built_page")
FIRST_LOAD_BYTES = 260_000  # what a phone on a boat can wait for, in any language
UPDATE_BYTES = 10_000
# Bridles 9 and 10 of the stand-in carry 0.12 of their capacity in 0.5 m/s, 0.6 in 1.27 m/s.
STRICT = AlarmPolicy.from_dict({"load": {"raise_at": 0.55, "clear_at": 0.4, "on_delay_s": 60.0}})
LOADED = ["load.bridle-10", "load.bridle-9"]
waited = partial(eventually, seconds=30.0)  # beside a browser a tick may take long


@pytest.fixture
def live(tmp_path: Path):
    """A service with an hour of a calm sea behind it, and strict limits of the loads."""
    with running(tmp_path, policy=STRICT) as one:
        # At once: of the first alone the twin would find that its sensor fell silent since.
        one.post(*(each for minutes in range(-60, 1, 10) for each in readings(float(minutes), 0.5)))
        yield one


@pytest.fixture
def watched(chromium: Path, live: Running):
    """The page of somebody who may acknowledge, in a calm sea."""
    with opened_browser(chromium, webgl=False) as one:
        one.page.goto(address(live, "read", "ack"))
        well(one)
        yield one


def address(live: Running, *scopes: str) -> str:
    token = live.service.tokens.mint(list(scopes), keep=True, name="Night shift")
    return f"{live.address}/#token={token}"


def readings(minutes: float, speed: float) -> tuple[dict[str, Any], dict[str, Any]]:
    """What buoy and one depth sensor say; no reading is quite like the one before."""
    ripple = 0.01 * (minutes % 3.0)
    return buoy(minutes, speed=speed + ripple), depth(minutes, metres=14.2 + ripple)


def post_readings(live: Running, minutes: float, speed: float) -> None:
    """Tell of the sea and of one depth."""
    live.post(*readings(minutes, speed))


def later(live: Running, minutes: float, speed: float) -> None:
    """Let the cage's clock go on, have the sea as it now is told, and the alarms assessed."""
    live.clock.at += timedelta(minutes=minutes)
    post_readings(live, (live.clock.at - NOON) / timedelta(minutes=1), speed)
    now = live.clock.at
    received = waited(live.state, lambda state: (at(state), state["age_s"]) == (now, 0.0))
    assert at(received) == now
    for _ in range(2):  # the first may be of the step that took the readings in
        waited(lambda: live.cage.snapshot, partial(is_not, live.cage.snapshot))


def at(state: dict) -> datetime:
    return datetime.fromisoformat(state["t"])


def alarms_of(live: Running) -> dict[str, dict]:
    post_readings = live.reader.get("/api/v1/cages/ace/alarms").json()["alarms"]
    return {one["id"]: one for one in post_readings}


def raised(live: Running) -> list[str]:
    return sorted(name for name, one in alarms_of(live).items() if one["active"])


def excursion(live: Running) -> None:
    """A current that loads two bridles beyond their limit, for longer than the delay."""
    for minutes, speed in ((10, 0.8), (10, 1.26), (2, 1.26)):  # faster growth would be suspect
        later(live, minutes, speed)
    assert waited(lambda: raised(live), lambda names: names == LOADED) == LOADED


def well(watched: Watched) -> None:
    watched.until("document.querySelector('.verdict').dataset.kind == 'well'")


def test_a_load_beyond_its_limit_is_reported_acknowledged_journaled_and_looked_back_at(
    live: Running, watched: Watched
) -> None:
    page = watched.page
    excursion(live)
    watched.until("document.querySelector('.verdict').dataset.kind == 'warning'")
    assert "2 alarms" in page.locator(".verdict").inner_text()
    assert page.title().startswith("(2)")
    toast = page.locator(".toast", has_text="bridle 10")
    toast.get_by_role("button", name="Look").click()

    listed = page.locator("li.alarm", has_text="bridle 10")
    assert "active, not acknowledged" in listed.inner_text()
    listed.get_by_role("button", name="Acknowledge: ").click()
    page.get_by_label("Why").fill("Feed barge slackens the stern")
    page.get_by_role("dialog").get_by_role("button", name="Acknowledge").click()
    watched.until("document.body.innerText.includes('active, acknowledged')")
    assert alarms_of(live)["load.bridle-10"]["acknowledged"]

    page.get_by_role("tab", name="Journal").click()
    line = page.locator(".journal tr[data-action=acknowledged]")
    line.wait_for(state="visible")
    assert "Night shift: Feed barge slackens the stern" in line.inner_text()

    # The current falls: what was acknowledged clears by itself, the other still waits. At once:
    # a tick before the reading arrives still holds the one before, beyond the domain.
    for minutes, speed in ((5, 0.92), (5, 0.85), (6, 0.8)):
        later(live, minutes, speed)
    assert waited(lambda: raised(live), lambda names: not names) == []
    watched.until("document.querySelector('.verdict').innerText.includes('1 alarm')")

    # Where the reader looks back, the load that woke everybody is there again.
    page.keyboard.press("1")
    ago = live.clock.at - timedelta(minutes=12)
    then = live.state(at=ago.isoformat())["bridles"][9]["tension_kn"]["mean"]
    assert then > 80.0
    page.get_by_label("Look back over").select_option("1 h")
    page.get_by_label("Time that is shown").focus()
    for _ in range(2):  # a tenth of the hour each
        page.keyboard.press("PageDown")
    watched.until("document.body.dataset.mode == 'past'")
    row = "document.querySelectorAll('.loads tbody tr')[9].innerText"
    watched.until(f"{row}.includes('{then:.1f}')")
    page.keyboard.press("l")
    watched.until("document.body.dataset.mode == 'live'")
    assert not watched.complaints
    assert not watched.foreign_requests(live.address)


def test_work_on_the_cage_is_written_down_and_stands_in_the_journal(watched: Watched) -> None:
    page = watched.page
    page.get_by_role("tab", name="Alarms").click()
    page.get_by_role("tab", name="Journal").click()
    page.get_by_role("button", name="Write down work").click()
    page.get_by_label("Which sensor").wait_for(state="hidden")
    page.get_by_label("What was done").select_option("sensor-moved")
    page.get_by_label("Which sensor").select_option("depth-2")
    page.get_by_label("Why").fill("Hung on spoke 5")
    page.get_by_label("When").fill("2010-01-01T12:00")
    record = page.get_by_role("dialog").get_by_role("button", name="Write down")
    record.click()
    watched.until("document.body.innerText.includes('is not within the 30 days until now')")
    watched.complaints.clear()  # the browser's own line about the refusal
    page.get_by_label("When").fill("")
    record.click()
    line = page.locator(".journal tr[data-action='sensor moved']")
    line.wait_for(state="visible")
    assert "Night shift: Hung on spoke 5" in line.inner_text()
    assert "depth" in line.inner_text().lower()
    assert not watched.complaints


def test_alarms_of_one_cause_are_acknowledged_together(live: Running, watched: Watched) -> None:
    page = watched.page
    excursion(live)
    page.get_by_role("tab", name="Alarms").click()
    page.get_by_role("button", name="Acknowledge all: High load on 2 lines").click()
    page.get_by_label("Why").fill("Spring tide")
    page.get_by_role("dialog").get_by_role("button", name="Acknowledge").click()
    page.get_by_role("dialog").wait_for(state="hidden")
    assert all(alarms_of(live)[name]["acknowledged"] for name in LOADED)
    assert not watched.complaints


def test_a_service_that_is_started_again_is_found_without_a_hand(
    chromium: Path, tmp_path: Path
) -> None:
    with opened_browser(chromium, webgl=False) as watched:
        with running(tmp_path) as before:
            post_readings(before, 0.0, 0.5)
            port = int(before.address.rpartition(":")[2])
            watched.page.goto(address(before, "read"))
            well(watched)
        watched.until("document.querySelector('.verdict').dataset.kind == 'lost'")
        assert "Connection lost" in watched.page.locator(".verdict").inner_text()
        with running(tmp_path, port=port) as after:
            well(watched)
            later(after, 10, 0.61)
            watched.until("document.querySelector('.figure').innerText.includes('0.62')")


@pytest.mark.parametrize("locale", ["en-GB", "nb-NO"])
def test_a_full_cage_is_light_and_the_page_keeps_a_strict_policy(
    locale: str, chromium: Path, tmp_path: Path
) -> None:
    twin, seen = stand_in_twin(spokes=32), opened_browser(chromium, locale=locale)
    with running(tmp_path, twin=twin) as live, seen as watched:
        live.post(buoy(speed=0.5), depth(metres=14.2))
        answer = watched.page.goto(address(live, "read"))
        watched.until_drawn()
        assert len(live.cage.topology.rest_position_m) == 321
        assert 100_000 < watched.loaded_bytes() <= FIRST_LOAD_BYTES
        assert watched.frame_bytes
        assert 2_000 < max(watched.frame_bytes) <= UPDATE_BYTES

        policy = answer.headers["content-security-policy"]
        rules = dict(rule.split(maxsplit=1) for rule in policy.split(";"))
        assert rules["default-src"] == "'none'"
        assert set(rules.values()) == {"'none'", "'self'"}
        inline = "script:not([src]), style, [style], [onclick], [onload]"
        served = f"new DOMParser().parseFromString({json.dumps(answer.text())}, 'text/html')"
        assert watched.page.evaluate(f"{served}.querySelectorAll('{inline}').length") == 0
        assert not watched.complaints  # a browser complains of whatever its policy forbids


def test_a_farm_shows_its_cages_the_worst_first_and_leads_to_each(
    chromium: Path, tmp_path: Path
) -> None:
    with running(tmp_path, names=("ace", "bay", "cove"), policy=STRICT) as live:
        post_readings(live, 0.0, 0.5)
        live.post(buoy(speed=0.4), cage="cove")
        excursion(live)
        live.post(depth(22.0, metres=14.2), cage="cove")  # within its timeout by the clock as it is
        with opened_browser(chromium, webgl=False) as watched:
            page = watched.page
            page.goto(address(live, "read"))
            watched.until("document.querySelectorAll('.tile').length == 3")
            kinds = "[...document.querySelectorAll('.tile')].map((one) => one.dataset.kind)"
            assert page.evaluate(kinds) == ["warning", "none", "well"]
            page.locator(".tile", has_text="cove").click()
            watched.until("document.querySelector('.cage-name').textContent == 'cove'")
            well(watched)
            page.keyboard.press("f")
            page.locator(".tile[aria-current=true]", has_text="cove").wait_for(state="visible")
            assert not watched.complaints
