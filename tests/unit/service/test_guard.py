import httpx
import pytest

from seacage.service._guard import same_origin
from serviced import Running, buoy

READING = ["cages", "cages/ace/state", "cages/ace/samples", "cages/ace/history", "cages/ace/shape"]


@pytest.mark.parametrize("path", READING)
def test_reading_takes_a_token(idle: Running, path):
    answer = httpx.get(f"{idle.address}/api/v1/{path}")
    assert answer.status_code == 401
    assert answer.headers["www-authenticate"] == "Bearer"


@pytest.mark.parametrize("path", READING)
def test_a_token_that_only_sends_may_not_read(idle: Running, path):
    assert idle.logger.get(f"/api/v1/{path}").status_code == 403


def test_a_token_that_only_reads_may_not_send(idle: Running):
    answer = idle.reader.post("/api/v1/cages/ace/samples", json={"samples": [buoy()]})
    assert answer.status_code == 403


def test_a_guessed_token_is_refused_without_saying_which_cages_there_are(idle: Running):
    headers = {"Authorization": "Bearer guess"}
    answer = httpx.get(f"{idle.address}/api/v1/cages/ice/state", headers=headers)
    assert answer.status_code == 401


def test_a_token_for_one_cage_does_not_open_another(idle: Running):
    token = idle.service.tokens.mint(["read:ice"], keep=False)
    headers = {"Authorization": f"Bearer {token}"}
    answer = httpx.get(f"{idle.address}/api/v1/cages/ace/state", headers=headers)
    assert answer.status_code == 403


@pytest.mark.parametrize("path", ["", "page/main.js", "healthz", "api/v1/cages", "no-such"])
def test_every_answer_carries_the_browsers_rules(idle: Running, path):
    headers = httpx.get(f"{idle.address}/{path}").headers
    policy = headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    assert headers["x-content-type-options"] == "nosniff"


def test_the_page_lies_at_the_root_and_its_folder_gives_nothing_else_away(idle: Running):
    assert "<title>seacage</title>" in httpx.get(idle.address).text
    assert httpx.get(f"{idle.address}/page/%2e%2e/_tokens.py").status_code == 404
    assert httpx.get(f"{idle.address}/page/").status_code == 404


@pytest.mark.parametrize(
    ("origin", "host", "same"),
    [
        (None, "cage.example", True),
        ("http://cage.example", "cage.example", True),
        ("https://cage.example", "cage.example", True),
        ("https://elsewhere.example", "cage.example", False),
        ("null", "cage.example", False),
        ("http://cage.example", "cage.example:8000", False),
    ],
)
def test_only_our_own_page_opens_a_live_connection(origin, host, same):
    assert same_origin(origin, host) is same
