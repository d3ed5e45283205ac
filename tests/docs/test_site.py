"""The documentation site: built without a warning, its links hold, every public name is on it."""

import importlib
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

ROOT = Path(__file__).parents[2]
ROOMS = sorted(path.parent.name for path in ROOT.glob("src/seacage/*/__init__.py"))
pytestmark = [pytest.mark.slow, pytest.mark.timeout(1200)]


class Page(HTMLParser):
    """Anchors, links and what a browser loads by itself of one page."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.anchors, self.links, self.loaded = set[str](), set[str](), set[str]()
        self.feed(path.read_text("utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        named = dict(attrs)
        self.anchors |= {str(named[key]) for key in ("id", "name") if named.get(key)}
        if tag == "a" and named.get("href"):
            self.links.add(str(named["href"]))
        elif place := named.get("src") or (named.get("href") if tag == "link" else None):
            self.loaded.add(place)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built as `make site` builds it."""
    folder = tmp_path_factory.mktemp("site")
    options = ["-W", "--keep-going", "-q", "-j", "auto", "-d", str(folder / "trees")]
    build = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, str(ROOT / "docs"), str(folder / "site")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert build.returncode == 0, build.stderr
    return folder / "site"


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, Page]:
    return {path: Page(path) for path in site.rglob("*.html")}


def test_every_link_and_every_file_of_a_page_is_there(pages: dict[Path, Page]) -> None:
    broken = list[str]()
    for path, page in pages.items():
        for link in page.links | page.loaded:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            anchor = unquote(parts.fragment)
            if not target.is_file() or (
                anchor and target in pages and anchor not in pages[target].anchors
            ):
                broken.append(f"{path.name}: {link}")
    assert broken == []


def test_nothing_is_fetched_from_elsewhere(site: Path, pages: dict[Path, Page]) -> None:
    fetched = {one for page in pages.values() for one in page.loaded if urlsplit(one).netloc}
    assert fetched == set()
    styles = {path.name: path.read_text() for path in site.rglob("*.css")}
    assert [name for name, text in styles.items() if "url(http" in text or "@import" in text] == []


def test_every_page_of_docs_is_in_one_of_the_four_parts(
    site: Path, pages: dict[Path, Page]
) -> None:
    written = {path.relative_to(ROOT / "docs") for path in ROOT.glob("docs/**/*.md")}
    built = {path.relative_to(site) for path in pages}
    assert {path.with_suffix(".html") for path in written} <= built
    index = pages[site / "index.html"].links
    assert {f"{path.with_suffix('.html')}" for path in written} - {"index.html"} <= {
        urlsplit(link).path for link in index
    }


@pytest.mark.parametrize("room", ROOMS)
def test_every_public_name_is_on_the_page_of_its_room(site, pages, room: str) -> None:
    names = importlib.import_module(f"seacage.{room}").__all__
    anchors = pages[site / "api" / f"{room}.html"].anchors
    assert [name for name in names if f"seacage.{room}.{name}" not in anchors] == []


@pytest.mark.parametrize("name", ["settle", "two-fidelities"])
def test_a_notebook_was_run(site: Path, name: str) -> None:
    text = (site / "notebooks" / f"{name}.html").read_text("utf-8")
    assert text.count("cell_output") >= 3
    assert "data:image" in text or "_images" in text


def test_the_search_finds_the_words_of_a_page(site: Path) -> None:
    index = (site / "searchindex.js").read_text("utf-8")
    assert all(word in index for word in ("netting", "calibr", "nargp", "seacage.dynamics.settle"))
