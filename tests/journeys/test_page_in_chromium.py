"""The page, opened in a real browser."""

from pathlib import Path

import pytest

from browser import blank_page
from serviced import Running, buoy, running


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


def test_a_page_without_a_token_asks_for_one(chromium: Path, live: Running, tmp_path: Path) -> None:
    with blank_page(chromium, tmp_path / "profile") as page:
        page.open(live.address)
        page.until("document.body.dataset.phase == 'asking'")
        assert not page.value("document.querySelector('#ask').hidden")
