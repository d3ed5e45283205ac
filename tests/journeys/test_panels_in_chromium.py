"""The panels beside the net, in a real browser on a real service; the net itself is drawn flat."""

from datetime import timedelta
from pathlib import Path

import pytest

from browser import opened_browser
from running_service import Running, at, buoy, depth, eventually, running
from wavy import twin_of_damage

pytestmark = pytest.mark.usefixtures("built_page")


@pytest.fixture
def live(tmp_path: Path):
    """A service of one's own, with two hours of a buoy and a sensor."""
    with running(tmp_path) as one:
        # At once: of the first alone the twin would find that its sensor fell silent since.
        one.post(
            *(buoy(float(minutes), speed=0.4) for minutes in range(-120, 1, 20)),
            # No reading is quite like the one before: one that stands still is not valid.
            *(depth(float(k), metres=14.2 + 0.01 * (k % 3)) for k in range(-120, 1, 20)),
        )
        yield one


def address(live: Running, *scopes: str) -> str:
    return f"{live.address}/#token={live.service.tokens.mint(list(scopes), keep=False)}"


def beyond_what_was_learned(live: Running) -> None:
    """Let the cage extrapolate until the alarm about it is raised."""
    live.post(buoy(0.5, speed=1.9))
    live.clock.at += timedelta(minutes=1)  # a reading ahead of the clock does not govern yet
    eventually(live.state, lambda state: state["valid"] and not state["in_domain"], seconds=30.0)
    live.clock.at += timedelta(minutes=11)
    eventually(live.state, lambda state: bool(state["alarms"]), seconds=30.0)


def opened(watched, where: str) -> None:
    watched.page.goto(where)
    watched.until("document.querySelectorAll('#panel-loads > .table-holder tbody tr').length == 12")
    watched.until("document.querySelector('.figure .value').textContent != ''")


def test_the_verdict_and_the_loads_are_those_of_the_service(chromium: Path, live: Running) -> None:
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(live, "read"))
        watched.until("document.querySelector('.verdict').dataset.kind == 'well'")
        first = live.state()["bridles"][0]
        shown = watched.page.locator(".loads tbody tr").first.inner_text()
        assert f"{first['tension_kn']['mean']:.1f}" in shown
        assert not watched.complaints


def test_a_bridle_chosen_in_the_table_is_marked_in_the_rose(chromium: Path, live: Running) -> None:
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(live, "read"))
        watched.page.get_by_role("button", name="Bridle 3", exact=True).click()
        chosen = watched.page.locator(".rose .bar[data-chosen]")
        assert chosen.locator(".which").text_content() == "3"


@pytest.fixture
def wavy(tmp_path: Path):
    """A service whose twin knows the loads of all lines in waves, and has heard of some."""
    with running(tmp_path, twin=twin_of_damage()) as one:
        sea = buoy(speed=0.4)
        waves = {"hs_m": 1.5, "tp_s": 7.0, "wave_from_deg": 200.0}
        one.post({**sea, "values": {**sea["values"], **waves}})
        yield one


def test_a_line_is_chosen_on_the_rose_by_keys_and_its_panel_says_what_the_service_says(
    chromium: Path, wavy: Running
) -> None:
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(wavy, "read"))
        page = watched.page
        page.get_by_role("button", name="Anchor lines").click()
        page.locator(".rose .bar").first.focus()
        page.keyboard.press("ArrowRight")  # clockwise from anchor 1, which lies in the north-east
        page.keyboard.press("Enter")
        panel = page.get_by_role("region", name="Anchor 8")
        panel.wait_for(state="visible")
        line = next(one for one in wavy.state()["lines"] if one["name"] == "anchor-8")
        for kn in (line["mean_kn"], line["std_kn"], line["maximum_3h_kn"]["mean"]):
            assert f"{kn:.1f} kN" in panel.inner_text()
        assert page.get_by_role("button", name="Anchor 8:").get_attribute("aria-pressed") == "true"
        panel.get_by_role("button", name="Close").click()
        panel.wait_for(state="hidden")
        assert "anchor-8" in page.evaluate("document.activeElement.dataset.line ?? ''")


def test_the_ranking_of_parted_lines_is_asked_for_when_opened_and_leads_to_the_worst(
    chromium: Path, wavy: Running
) -> None:
    path = "/api/v1/cages/ace/what-if-parted"
    worst = eventually(lambda: wavy.reader.get(path).json()["lines"], bool, seconds=20.0)[0]
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(wavy, "read"))
        page = watched.page
        assert not [one for one in watched.requests if "what-if-parted" in one]
        page.locator("summary", has_text="If this line parted now").click()
        first = page.locator(".parted tbody tr").first
        first.wait_for(state="visible")
        load = worst["largest_maximum_3h"]
        assert f"{load['kn']:.1f} kN" in first.inner_text()
        first.get_by_role("button").click()
        name = worst["parted"].replace("-", " ").capitalize()
        panel = page.get_by_role("region", name=name)
        panel.wait_for(state="visible")
        assert f"{load['kn']:.1f} kN, {load['line'].replace('-', ' ')}" in panel.inner_text()
        assert len([one for one in watched.requests if "what-if-parted" in one]) == 1
        assert not watched.complaints


def test_charts_are_drawn_and_lead_to_the_past(chromium: Path, live: Running) -> None:
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(live, "read"))
        watched.page.keyboard.press("2")
        chart = watched.page.locator(".chart").first
        chart.wait_for(state="visible")
        assert watched.colours(".chart canvas") > 5
        chart.locator(".chart-area").focus()
        for key in ("ArrowLeft", "ArrowLeft", "Enter"):
            watched.page.keyboard.press(key)
        watched.until("document.body.dataset.mode == 'past'")
        assert "The past" in watched.page.locator(".banner").inner_text()
        watched.page.get_by_role("button", name="Back to live").click()
        watched.until("document.body.dataset.mode == 'live'")
        assert not watched.complaints


def test_a_chart_is_enlarged_and_saved_in_the_units_that_are_chosen(
    chromium: Path, live: Running
) -> None:
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(live, "read"))
        page = watched.page
        page.keyboard.press("u")
        page.get_by_role("radio", name="ft", exact=True).check()
        page.keyboard.press("Escape")
        watched.until("!document.querySelector('dialog[open]')")
        page.keyboard.press("2")
        chart = page.locator(".chart", has_text="Depth 2")
        chart.get_by_role("button", name="over the whole width").click()
        watched.until("document.querySelector('dialog .chart canvas').clientWidth > 1200")
        with page.expect_download() as table:
            chart.get_by_role("button", name="as a table").click()
        head, first = Path(table.value.path()).read_text().splitlines()[:2]
        assert table.value.suggested_filename.startswith("ace_depth-2_2")
        assert head.startswith("time [UTC],twin [ft],")
        assert first.endswith(",virtual field")
        metres = live.state()["sensors"]
        depth_m = next(one["mean"] for one in metres if one["name"] == "depth-2")
        last = Path(table.value.path()).read_text().splitlines()[-1]
        assert float(last.split(",")[1]) == pytest.approx(depth_m / 0.3048, abs=0.01)
        with page.expect_download() as picture:
            chart.get_by_role("button", name="as a picture").click()
        assert Path(picture.value.path()).read_bytes().startswith(b"\x89PNG")
        page.keyboard.press("Escape")
        watched.until("document.querySelector('.chart-grid .chart canvas').clientWidth < 700")
        assert not watched.complaints


def test_who_may_only_read_reads_at_once_why_nothing_can_be_acknowledged(
    chromium: Path, live: Running
) -> None:
    beyond_what_was_learned(live)
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(live, "read"))
        watched.page.keyboard.press("3")
        button = watched.page.get_by_role("button", name="Acknowledge: ").first
        button.wait_for(state="visible")
        assert "scope ack" in watched.page.locator(".denied").inner_text()
        assert button.get_attribute("aria-disabled") == "true"
        button.click(force=True)
        assert watched.page.get_by_role("dialog").count() == 0


def test_a_right_that_holds_elsewhere_alone_is_missed_in_words(
    chromium: Path, live: Running
) -> None:
    beyond_what_was_learned(live)
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(live, "read", "ack:another"))  # the page cannot tell where that is
        watched.page.keyboard.press("3")
        watched.page.get_by_role("button", name="Acknowledge: ").first.click()
        dialog = watched.page.get_by_role("dialog")
        dialog.get_by_role("button", name="Acknowledge").click()
        dialog.get_by_role("alert").wait_for(state="visible")
        assert "scope ack" in dialog.get_by_role("alert").inner_text()
        watched.page.keyboard.press("Escape")
        assert "scope ack" in watched.page.locator(".denied").inner_text()


def test_a_dial_turns_to_where_it_is_pointed_at_though_the_page_moves_under_the_hand(
    chromium: Path, live: Running
) -> None:
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(live, "read"))
        watched.page.keyboard.press("4")
        dial = watched.page.get_by_role("slider", name="Current towards")
        dial.wait_for(state="visible")
        before = dial.locator("circle").bounding_box()
        x, y = before["x"] + before["width"] / 2, before["y"] + before["height"] / 2
        watched.page.mouse.move(x + 20, y - 20)
        watched.page.mouse.down()
        watched.until("document.querySelector('.dial').ariaValueNow == 45")
        watched.until("document.body.dataset.mode == 'whatif'")  # its band has come above
        assert dial.locator("circle").bounding_box()["y"] > before["y"] + 10
        watched.page.mouse.move(x - 20, y)
        watched.until("document.querySelector('.dial').ariaValueNow == 270")
        watched.page.mouse.up()


def test_a_comment_goes_into_the_journal(chromium: Path, live: Running) -> None:
    beyond_what_was_learned(live)
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(live, "read", "ack"))
        watched.page.keyboard.press("3")
        watched.page.get_by_role("button", name="Comment: ").first.click()
        watched.page.get_by_label("Why").fill("A <b>buoy</b> adrift")
        watched.page.get_by_role("dialog").get_by_role("button", name="Comment").click()
        watched.page.get_by_role("dialog").wait_for(state="hidden")
        watched.page.get_by_role("tab", name="Journal").click()
        watched.until("document.body.innerText.includes('A <b>buoy</b> adrift')")
        assert not watched.complaints


def test_the_largest_load_is_the_measured_one_where_that_is_larger_and_its_shackle_is_named(
    chromium: Path, live: Running
) -> None:
    live.post({"stream": "shackle-2", "t": at(0.0), "values": {"tension_kn": 61.5}})
    with opened_browser(chromium, webgl=False) as watched:
        opened(watched, address(live, "read"))
        load = "document.querySelectorAll('.figure')[2].innerText"
        watched.until(f"{load}.includes('measured by shackle 2')")
        assert "61.5" in watched.page.evaluate(load)
        assert not watched.complaints


def test_the_flat_view_turns_with_the_current_and_is_left_by_any_side(
    chromium: Path, live: Running
) -> None:
    with opened_browser(chromium) as watched:
        watched.page.goto(address(live, "read"))
        watched.until_drawn()
        watched.page.keyboard.press("v")
        caption = watched.page.locator(".flat-side figcaption")
        caption.wait_for(state="visible")
        assert "goes to the right: 090° E" in caption.inner_text()
        watched.page.get_by_role("button", name="Top", exact=True).click()
        watched.until_drawn()
        assert watched.page.locator(".flat").count() == 0
        assert not watched.complaints
