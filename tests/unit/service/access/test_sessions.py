from datetime import UTC, datetime, timedelta

import pytest

from seacage.service._access._sessions import Sessions
from seacage.service._access._tokens import Tokens

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


@pytest.fixture
def tokens(tmp_path):
    return Tokens(tmp_path)


def grant_in(tokens, **how):
    return tokens.grant(tokens.mint(["read"], keep=True, **how))


def test_a_cookie_stands_for_its_token_until_the_session_ends(tokens):
    sessions, grant = Sessions(tokens, lasting_s=60.0), grant_in(tokens)
    cookie, session = sessions.begin(grant, NOON)
    assert sessions.find(cookie, NOON) == (session, grant)
    assert sessions.find(cookie, NOON + timedelta(seconds=60)) is None
    sessions.end(cookie)
    assert sessions.find(cookie, NOON) is None


def test_a_revoked_token_ends_its_sessions(tokens):
    sessions, grant = Sessions(tokens, lasting_s=60.0), grant_in(tokens, name="ada")
    cookie, _ = sessions.begin(grant, NOON)
    tokens.revoke("ada")
    assert sessions.find(cookie, NOON) is None


def test_a_cookie_is_kept_only_as_a_hash(tokens):
    sessions = Sessions(tokens, lasting_s=60.0)
    cookie, _ = sessions.begin(grant_in(tokens), NOON)
    assert cookie not in sessions._open


def test_the_oldest_of_too_many_sessions_ends(tokens, monkeypatch):
    monkeypatch.setattr("seacage.service._access._sessions._MOST_SESSIONS", 1)
    sessions, grant = Sessions(tokens, lasting_s=60.0), grant_in(tokens)
    first, second = (sessions.begin(grant, NOON)[0] for _ in range(2))
    assert sessions.find(first, NOON) is None
    assert sessions.find(second, NOON) is not None
