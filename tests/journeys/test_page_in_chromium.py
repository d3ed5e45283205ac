"""The page, opened in a real browser on a real service."""

from datetime import timedelta
from pathlib import Path

import pytest

from browser import Line, Watched, opened_browser
from running_service import Running, buoy, depth, eventually, running

pytestmark = pytest.mark.usefixtures("built_page")
MOUSE_STEPS = 4


@pytest.fixture
def live(tmp_path: Path):
    """A service of one's own, with a buoy that has spoken."""
    with running(tmp_path) as one:
        one.post(buoy(speed=0.5), depth(metres=14.2))
        yield one


def address(live: Running, scopes: tuple[str, ...] = ("read", "ack")) -> str:
    token = live.service.tokens.mint(list(scopes), keep=False)
    return f"{live.address}/#token={token}"


def silence(live: Running) -> dict:
    answer = live.reader.get("/api/v1/cages/ace/alarms").json()["alarms"]
    return next(alarm for alarm in answer if alarm["id"] == "silent.buoy-1")


def place_of(watched: Watched, selector: str) -> tuple[float, float]:
    box = watched.page.locator(selector).first.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def test_the_page_draws_what_a_buoy_reports_and_asks_nobody_else(
    chromium: Path, live: Running
) -> None:
    with opened_browser(chromium) as watched:
        watched.page.goto(address(live))
        watched.until_drawn()
        watched.until("document.body.innerText.includes('0.50 m/s')")
        assert watched.colours("#net") > 1000
        assert not watched.foreign_requests(live.address)
        assert not watched.complaints
        assert "token" not in watched.page.url


def test_the_net_moves_when_the_current_grows(chromium: Path, live: Running) -> None:
    with opened_browser(chromium, reduced_motion="reduce") as watched:
        watched.page.goto(address(live))
        watched.until_drawn()
        bottom = "Number(document.querySelector('#net').dataset.bottom)"
        before = watched.page.evaluate(bottom)
        live.post(buoy(0.5, speed=0.9))
        live.clock.at = live.cage.clock.now().replace(minute=1)
        watched.until(f"{bottom} > {before} + 1")  # a stronger current lifts it


def test_a_node_that_is_pointed_at_says_where_it_is(chromium: Path, live: Running) -> None:
    with opened_browser(chromium) as watched:
        watched.page.goto(address(live))
        watched.until_drawn()
        x, y = place_of(watched, "#net")
        tip = watched.page.locator(".scene-tip")
        # The net fills the middle; somewhere on a short way across it there is a node.
        for step in range(180):
            down, along = divmod(step, 45)
            watched.page.mouse.move(x - 90 + 4 * along, y + 30 * down, steps=MOUSE_STEPS)
            if tip.is_visible() and "Uncertainty" in tip.inner_text():
                break
        assert "Uncertainty, σ" in tip.inner_text()


def test_the_keyboard_turns_the_net_and_steps_through_its_lines(
    chromium: Path, live: Running
) -> None:
    with opened_browser(chromium, reduced_motion="reduce") as watched:
        watched.page.goto(address(live))
        watched.until_drawn()
        watched.page.locator("#net").focus()
        needle = "document.querySelector('.scene-compass g').getAttribute('transform')"
        before = watched.page.evaluate(needle)
        watched.page.keyboard.press("ArrowLeft")
        watched.until(f"{needle} != {before!r}")
        watched.page.keyboard.press("PageDown")
        panel = watched.page.get_by_role("region", name="Bridle 1")
        panel.wait_for(state="visible")
        assert "Tension now" in panel.inner_text()
        watched.page.keyboard.press("Escape")
        panel.wait_for(state="hidden")


def test_without_webgl_the_net_is_drawn_flat_with_a_table(chromium: Path, live: Running) -> None:
    with opened_browser(chromium, webgl=False) as watched:
        watched.page.goto(address(live))
        watched.until("document.querySelectorAll('.flat-bridle').length == 24")  # in two views
        assert "Sinker tube" in watched.page.locator(".flat-table").inner_text()
        watched.page.locator(".flat-bridle").nth(15).hover(force=True)  # seen from above
        assert "Of its capacity" in watched.page.locator(".scene-tip").inner_text()
        assert not [request for request in watched.requests if "/three" in request]
        assert not watched.complaints


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_the_page_follows_the_system_into_the_dark_and_the_light(
    scheme: str, chromium: Path, live: Running
) -> None:
    with opened_browser(chromium, color_scheme=scheme) as watched:
        watched.page.goto(address(live))
        watched.until_drawn()
        assert watched.page.evaluate("document.documentElement.dataset.theme") == scheme
        ground = watched.page.evaluate("getComputedStyle(document.body).backgroundColor")
        bright = sum(map(int, ground.removeprefix("rgb(").removesuffix(")").split(",")))
        assert (bright > 600) is (scheme == "light")


def test_on_a_phone_the_net_is_on_top_and_nothing_sticks_out(chromium: Path, live: Running) -> None:
    with opened_browser(chromium, size=(390, 844), has_touch=True) as watched:
        watched.page.goto(address(live))
        watched.until_drawn()
        wide = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
        assert watched.page.evaluate(wide) == 0
        scene, panels = (watched.page.locator(one).bounding_box() for one in ("#scene", "#panels"))
        assert scene["y"] + scene["height"] <= panels["y"] + 1
        assert scene["width"] == 390


def test_a_page_without_a_token_asks_for_one_and_opens_with_it(
    chromium: Path, live: Running
) -> None:
    with opened_browser(chromium) as watched:
        watched.page.goto(live.address)
        field = watched.page.get_by_label("Token")
        field.wait_for(state="visible")
        field.fill(live.service.tokens.mint(["read"], keep=False))
        field.press("Enter")
        watched.until_drawn()
        assert watched.page.locator("#ask").is_hidden()


def test_a_token_that_is_not_known_is_refused_in_words(chromium: Path, live: Running) -> None:
    with opened_browser(chromium) as watched:
        watched.page.goto(f"{live.address}/#token=guess")
        why = watched.page.locator("#ask .ask-why")
        why.wait_for(state="visible")
        assert "does not open the service" in why.inner_text()


def test_who_reloads_before_the_service_has_answered_to_a_link_is_let_in_by_it(
    chromium: Path, live: Running
) -> None:
    unanswered = []

    def left_alone(route: "Route") -> None:
        unanswered.append(route)

    with opened_browser(chromium, webgl=False) as watched:
        page = watched.page
        page.route("**/session", left_alone, times=1)
        page.goto(address(live))
        while not unanswered:
            page.wait_for_timeout(50)
        page.reload()
        watched.until("document.body.dataset.connection == 'live'")
        assert "token" not in page.url


def test_whoever_signs_in_stays_so_without_the_token_in_any_scripts_reach_until_they_sign_out(
    chromium: Path, live: Running
) -> None:
    token = live.service.tokens.mint(["read", "ack"], keep=False, name="Night shift")
    with opened_browser(chromium, webgl=False) as watched:
        page = watched.page
        page.goto(f"{live.address}/#token={token}")
        watched.until("document.body.dataset.connection == 'live'")
        for store in ("localStorage", "sessionStorage", "document.cookie", "location.href"):
            assert token not in page.evaluate(f"JSON.stringify({store})"), store
        page.reload()
        watched.until("document.body.dataset.connection == 'live'")
        assert not watched.complaints
        page.get_by_role("button", name="Signed in as Night shift").click()
        assert "May look and handle alarms." in page.get_by_role("dialog").inner_text()
        page.get_by_role("button", name="Sign out", exact=True).click()
        page.get_by_label("Token").wait_for(state="visible")
        assert page.context.cookies() == []
        assert "kN" not in page.locator("#panels").inner_text()


def test_a_session_that_somebody_ends_asks_for_a_token_again(chromium: Path, live: Running) -> None:
    token = live.service.tokens.mint(["read"], keep=True, name="ada")
    with opened_browser(chromium, webgl=False) as watched:
        watched.page.goto(f"{live.address}/#token={token}")
        watched.until("document.body.dataset.connection == 'live'")
        live.service.tokens.revoke("ada")
        why = watched.page.locator("#ask .ask-why")
        why.wait_for(state="visible")
        assert "no longer signed in" in why.inner_text()


def test_without_any_input_the_page_says_so_and_shows_no_load(
    chromium: Path, tmp_path: Path
) -> None:
    with running(tmp_path) as live, opened_browser(chromium) as watched:
        watched.page.goto(address(live))
        watched.until("document.body.dataset.valid == 'false'")
        notice = watched.page.locator(".scene-notice")
        notice.wait_for(state="visible")
        assert "Waiting for the first reading" in notice.inner_text()
        assert "kN" not in watched.page.locator("#scene").inner_text()
        assert not watched.complaints


def test_a_connection_that_breaks_is_reported_and_comes_back(chromium: Path, live: Running) -> None:
    with opened_browser(chromium) as watched:
        line = Line(watched)
        watched.page.goto(address(live))
        watched.until_drawn()
        line.break_off()
        watched.until("document.body.dataset.connection == 'lost'")
        assert "No connection" in watched.page.locator(".scene-notice").inner_text()
        line.mend()
        watched.until("document.body.dataset.connection == 'live'")
        watched.page.locator(".scene-notice").wait_for(state="hidden")


def test_the_reader_asks_what_would_be_and_comes_back_to_what_is(
    chromium: Path, live: Running
) -> None:
    with opened_browser(chromium, reduced_motion="reduce") as watched:
        watched.page.goto(address(live))
        watched.until_drawn()
        watched.page.get_by_role("tab", name="What if").click()
        chosen = watched.page.locator("#panels .whatif-kind")  # of a twin that knows no waves
        assert "learned up to" in chosen.inner_text()
        assert "Waves are not among what this twin has learned" in (
            watched.page.locator("#panels").inner_text()
        )
        bottom = "Number(document.querySelector('#net').dataset.bottom)"
        before = watched.page.evaluate(bottom)
        speed = watched.page.get_by_role("slider", name="Current", exact=True)
        speed.focus()
        for _ in range(3):
            watched.page.keyboard.press("PageUp")
        watched.until("document.body.dataset.mode == 'whatif'")
        watched.until(f"{bottom} > {before} + 0.5")
        watched.page.get_by_role("button", name="Back to the sea now").click()
        watched.until("document.body.dataset.mode == 'live'")
        assert not watched.complaints


def test_the_reader_travels_to_the_past_and_back(chromium: Path, live: Running) -> None:
    live.post(buoy(-120.0, speed=0.9))
    with opened_browser(chromium) as watched:
        watched.page.goto(address(live))
        watched.until_drawn()
        slider = watched.page.get_by_label("Time that is shown")
        slider.focus()
        watched.page.keyboard.press("PageDown")
        watched.until("document.body.dataset.mode == 'past'")
        watched.page.keyboard.press("End")
        watched.until("document.body.dataset.mode == 'live'")
        assert not watched.complaints


def test_a_silent_buoy_is_reported_and_acknowledged_on_the_page(
    chromium: Path, live: Running
) -> None:
    with opened_browser(chromium) as watched:
        watched.page.goto(address(live))
        watched.until_drawn()
        for _ in range(25):  # in small steps: a clock that jumps has nobody woken
            live.clock.at += timedelta(seconds=60)
            watched.page.wait_for_timeout(400)
        watched.page.get_by_role("tab", name="Alarms").click()
        found = watched.page.get_by_role("button", name="Acknowledge: ").first
        found.wait_for(state="visible")
        found.click()
        watched.page.get_by_role("dialog").get_by_role("button", name="Acknowledge").click()
        assert eventually(lambda: silence(live), lambda report: report["acknowledged"])[
            "acknowledged"
        ]


def test_the_reader_chooses_a_language_which_the_browser_remembers(
    chromium: Path, live: Running
) -> None:
    with opened_browser(chromium, webgl=False, locale="nb-NO") as watched:
        page = watched.page
        page.goto(address(live))
        watched.until("document.body.dataset.connection == 'live'")
        assert page.evaluate("document.documentElement.lang") == "nb"
        assert page.get_by_role("tab", name="Laster").is_visible()
        assert "0,50" in page.locator(".figure").first.inner_text()
        english = page.get_by_role("button", name="Help and keys")
        assert not english.count()

        page.get_by_role("combobox", name="Språk (language)").select_option(label="English")
        english.wait_for(state="visible")
        page.reload()
        english.wait_for(state="visible")
        watched.until("document.querySelector('.figure')?.innerText.includes('0.50')")
        assert page.evaluate("document.documentElement.lang") == "en"
        assert not watched.complaints


def test_an_alarm_is_read_in_norwegian_and_one_of_a_newer_service_in_its_own_words(
    chromium: Path, live: Running
) -> None:
    strange = {"key": "tilt.active", "title": "The collar tilts", "message": "By 9 degrees."}
    with opened_browser(chromium, webgl=False, locale="nb-NO") as watched:

        def with_a_strange_one(route: "Route") -> None:
            answer = route.fetch()
            alarms = answer.json()["alarms"]
            known = next(one for one in alarms if one["id"] == "silent.buoy-1")
            known |= {"active": True, "acknowledged": False, "key": "silent.active"}
            known["values"] = {"source": "buoy-1", "value_s": 5400.0, "raise_at_s": 3600.0}
            new = known | strange | {"id": "tilt.collar"}
            route.fulfill(json={"alarms": [known, new]})

        page = watched.page
        page.route("**/alarms", with_a_strange_one)
        page.goto(address(live))
        watched.until("document.body.dataset.connection == 'live'")
        page.keyboard.press("3")
        known = page.locator("li.alarm", has_text="Bøye 1 er taus")
        known.wait_for(state="visible")
        words = known.inner_text().replace("\u00a0", " ")
        assert "måling på 1,5 t; grensen er 60 min." in words
        assert "aktiv, ikke kvittert" in words
        assert "Sjekk strømforsyningen" in known.locator(".alarm-more").first.text_content()
        new = page.locator("li.alarm", has_text=strange["title"])
        assert strange["message"] in new.inner_text()
