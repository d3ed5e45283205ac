"""Text answers and the page's files travel compressed, what is packed already does not."""

import pytest

from running_service import Running, buoy, depth, eventually
from seacage.service._http._api import PAGE


@pytest.fixture
def fed(live: Running):
    live.post(buoy(-30), buoy(-10), *[depth(-minute / 10) for minute in range(50)])
    eventually(live.state, lambda state: state["valid"])
    return live


@pytest.mark.parametrize("name", ["state", "topology", "samples", "history", "samples.csv"])
def test_a_text_is_compressed_for_who_can_read_that(fed: Running, name):
    path = f"/api/v1/cages/ace/{name}"
    packed = fed.reader.get(path)
    plain = fed.reader.get(path, headers={"Accept-Encoding": "identity"})
    assert packed.headers["content-encoding"] == "gzip"
    assert "content-encoding" not in plain.headers
    for answer in (packed, plain):
        assert answer.headers["vary"] == "Accept-Encoding"
        assert answer.headers["content-type"] == plain.headers["content-type"]
    assert packed.content == plain.content
    assert packed.num_bytes_downloaded < len(plain.content) / 2


@pytest.mark.parametrize("name", ["frame", "history.nc", "shape.mcap"])
def test_what_is_packed_or_comes_every_second_is_not(fed: Running, name):
    answer = fed.reader.get(f"/api/v1/cages/ace/{name}", timeout=60.0)
    assert answer.status_code == 200
    assert "content-encoding" not in answer.headers


def test_a_short_text_is_not_worth_it(fed: Running):
    assert "content-encoding" not in fed.reader.get("/healthz").headers


@pytest.mark.skipif(not PAGE.is_dir(), reason="no page was built here")
@pytest.mark.parametrize("path", ["/", "/page/index.html", "script"])
def test_the_pages_files_are_compressed_and_keep_their_tags(live: Running, path):
    if path == "script":
        path = f"/page/assets/{max((PAGE / 'assets').glob('*.js')).name}"
    answer = live.reader.get(path)
    assert answer.headers["content-encoding"] == "gzip"
    assert answer.headers["vary"] == "Accept-Encoding"
    assert answer.headers["etag"].startswith("W/"), "its bytes are not those of the file"
    assert ("immutable" in answer.headers["cache-control"]) is ("assets" in path)
    again = live.reader.get(path, headers={"If-None-Match": answer.headers["etag"]})
    assert again.status_code == 304
    assert again.headers["etag"] == answer.headers["etag"]
