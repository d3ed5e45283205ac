from collections.abc import Iterator

import httpx
import pytest

from running_service import Running, buoy, running
from seacage.service._auth._authorization import COOKIE
from seacage.service._auth._limits import Limits


@pytest.fixture
def page(idle: Running) -> Iterator[httpx.Client]:
    """A browser of somebody who may do everything, not yet signed in."""
    with httpx.Client(base_url=idle.address) as client:
        yield client


def token_of(one: Running, *scopes) -> str:
    return one.service.tokens.mint(scopes or ["read"], keep=False)


def signed_in(idle: Running, page: httpx.Client, *scopes, **headers) -> httpx.Response:
    token = idle.service.tokens.mint(scopes or ["admin"], keep=False, name="")
    return page.post("/session", json={"token": token}, headers=headers)


def test_a_token_buys_a_cookie_that_no_script_and_no_other_page_can_use(idle, page):
    answer = signed_in(idle, page)
    assert answer.status_code == 201
    cookie = answer.headers["set-cookie"]
    for rule in ("HttpOnly", "SameSite=strict", "Path=/", "Max-Age=43200"):
        assert rule in cookie
    assert "Secure" not in cookie, "without TLS a browser would not send it back"
    assert page.get("/api/v1/cages").status_code == 200
    again = page.get("/session")
    assert again.json() | {"expires": ""} == answer.json() | {"expires": ""}
    assert again.json()["expires"] > answer.json()["expires"], "whoever looks stays signed in"
    assert "Max-Age=43200" in again.headers["set-cookie"]


def test_behind_tls_the_cookie_stays_there(idle, page, tmp_path):
    # A proxy on this machine says how it was reached, where the settings name it.
    by_tls = {"X-Forwarded-Proto": "https"}
    assert "Secure" not in signed_in(idle, page, **by_tls).headers["set-cookie"]
    with running(tmp_path, proxies=("127.0.0.1",)) as one:
        answer = httpx.post(f"{one.address}/session", json={"token": token_of(one)}, headers=by_tls)
    assert "Secure" in answer.headers["set-cookie"]


def test_a_write_by_cookie_repeats_what_only_our_page_knows(idle, page):
    csrf = signed_in(idle, page).json()["csrf"]
    post = {"url": "/api/v1/cages/ace/samples", "json": {"samples": [buoy(minutes=-1)]}}
    assert page.post(**post).status_code == 403
    assert page.post(**post, headers={"X-CSRF-Token": "guess"}).status_code == 403
    elsewhere = {"X-CSRF-Token": csrf, "Origin": "https://elsewhere.example"}
    assert page.post(**post, headers=elsewhere).status_code == 403
    assert page.post(**post, headers={"X-CSRF-Token": csrf}).status_code == 201


def test_another_page_may_not_sign_somebody_in(idle, page):
    assert signed_in(idle, page, Origin="https://elsewhere.example").status_code == 403
    assert not page.cookies


def test_signing_out_ends_the_session(idle, page):
    csrf = signed_in(idle, page).json()["csrf"]
    cookie = page.cookies[COOKIE]
    assert page.delete("/session").status_code == 403
    assert page.delete("/session", headers={"X-CSRF-Token": csrf}).status_code == 204
    old = httpx.get(f"{idle.address}/api/v1/cages", cookies={COOKIE: cookie})
    assert old.status_code == 401


def test_signing_in_again_ends_the_session_before(idle, page):
    signed_in(idle, page)
    cookie = page.cookies[COOKIE]
    signed_in(idle, page, "read")
    old = httpx.get(f"{idle.address}/api/v1/cages", cookies={COOKIE: cookie})
    assert old.status_code == 401
    assert page.get("/session").json()["scopes"] == ["read"]


def test_a_session_opens_no_more_than_its_token(idle, page):
    csrf = signed_in(idle, page, "read").json()["csrf"]
    headers = {"X-CSRF-Token": csrf}
    answer = page.post("/api/v1/cages/ace/samples", json={"samples": [buoy()]}, headers=headers)
    assert answer.status_code == 403


def test_whoever_signs_in_often_ends_only_sessions_of_their_own(tmp_path):
    with running(tmp_path, limits=Limits(sessions_per_token=3)) as one:
        admin, reader = token_of(one, "admin"), token_of(one, "read")
        cookies = [
            httpx.post(f"{one.address}/session", json={"token": token}).cookies[COOKIE]
            for token in (admin, *[reader] * 5)
        ]
        standing = [
            httpx.get(f"{one.address}/session", cookies={COOKIE: cookie}).is_success
            for cookie in cookies
        ]
        assert standing == [True, False, False, True, True, True]


def test_signing_in_takes_no_long_body(idle, page):
    assert page.post("/session", json={"token": "x" * 5000}).status_code == 413


def test_a_wrong_token_signs_nobody_in(page):
    assert page.post("/session", json={"token": "guess"}).status_code == 401
    assert page.get("/session").status_code == 401
