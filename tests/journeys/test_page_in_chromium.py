"""The page, opened in a real browser."""

import json
from pathlib import Path

import pytest

from browser import blank_page
from serviced import Running, at, buoy, depth, running


@pytest.fixture
def live(tmp_path: Path):
    """A service of one's own."""
    with running(tmp_path) as one:
        yield one


def test_the_page_shows_what_a_buoy_reports_and_asks_nobody_else(
    chromium: Path, live: Running, tmp_path: Path
) -> None:
    live.post(buoy(speed=0.5))
    token = live.reader.headers["Authorization"].removeprefix("Bearer ")
    with blank_page(chromium, tmp_path / "profile") as page:
        page.open(f"{live.address}/#token={token}")
        page.until("document.body.dataset.phase == 'live'")
        page.until("document.querySelectorAll('#bridle-table [scope=row]').length == 12")
        page.until("document.querySelector('#verdict').innerText.includes('0.50 m/s')")
        drawn = "(c => new Set(c.getContext('2d').getImageData(0, 0, c.width, c.height).data).size)"
        assert page.value(f"{drawn}(document.querySelector('#side'))") > 10
        outside = [asked for asked in page.asked if not asked.startswith((live.address, "data:"))]
        assert not outside
        assert not page.complaints
        assert token not in page.value("location.href")


def test_a_spike_leaves_the_pages_curves_when_it_is_known_for_one(
    chromium: Path, live: Running, tmp_path: Path
) -> None:
    measured = [(-4, 7.0), (-3, 7.1), (-2, 30.0), (-1, 7.2)]
    live.post(buoy(-4), *(depth(minute, metres) for minute, metres in measured))
    # each state is a tick half a minute after its reading
    state = json.dumps([live.state(at=at(minute + 0.5)) for minute, _ in measured])
    topology = live.reader.get("/api/v1/cages/ace/topology").text
    with blank_page(chromium, tmp_path / "profile") as page:
        page.open(live.address)
        page.until("document.body.dataset.phase == 'asking'")
        page.value(f"""import("{live.address}/page/sensors.js").then(({{ Sensors }}) => {{
            const [grid, legend] = [0, 1].map(() => document.createElement("div"));
            const sensors = new Sensors({{ grid, legend }});
            sensors.topology({topology});
            window.shown = {state}.map((state) => {{
                sensors.show(state);
                return sensors.cards.get("depth-2").measured.map(({{ value }}) => value);
            }});
        }})""")
        page.until("Boolean(window.shown)")
        assert page.value("JSON.stringify(window.shown.slice(-2))") == "[[7,7.1,30],[7,7.1,7.2]]"


def test_a_page_without_a_token_asks_for_one(chromium: Path, live: Running, tmp_path: Path) -> None:
    with blank_page(chromium, tmp_path / "profile") as page:
        page.open(live.address)
        page.until("document.body.dataset.phase == 'asking'")
        assert not page.value("document.querySelector('#ask').hidden")
