from datetime import UTC, datetime, timedelta

import pytest

from seacage.service._auth._sessions import Sessions
from seacage.service._auth._token_store import Tokens

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


@pytest.fixture
def tokens(tmp_path):
    return Tokens(tmp_path)


def grant_in(tokens, **how):
    return tokens.grant(tokens.mint(["read"], keep=True, **how))


def test_a_cookie_stands_for_its_token_until_the_session_ends(tokens):
    sessions, grant = Sessions(tokens, lasting_s=60.0), grant_in(tokens)
    cookie, session = sessions.begin(grant, NOON)
    assert sessions.find(cookie, NOON) == (grant, session)
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
    monkeypatch.setattr("seacage.service._auth._sessions._MOST_SESSIONS", 1)
    sessions, grant = Sessions(tokens, lasting_s=60.0), grant_in(tokens)
    first, second = (sessions.begin(grant, NOON)[0] for _ in range(2))
    assert sessions.find(first, NOON) is None
    assert sessions.find(second, NOON) is not None


def test_where_there_are_too_many_sessions_who_has_most_loses_one(tokens, monkeypatch):
    monkeypatch.setattr("seacage.service._auth._sessions._MOST_SESSIONS", 3)
    sessions, ada, bob = Sessions(tokens, lasting_s=60.0), grant_in(tokens), grant_in(tokens)
    of_ada, _ = sessions.begin(ada, NOON)
    of_bob = [sessions.begin(bob, NOON)[0] for _ in range(3)]
    assert sessions.find(of_ada, NOON) is not None
    assert [sessions.find(one, NOON) is not None for one in of_bob] == [False, True, True]


def test_a_session_that_has_ended_takes_no_room(tokens):
    sessions = Sessions(tokens, lasting_s=60.0)
    sessions.begin(grant_in(tokens), NOON)
    sessions.begin(grant_in(tokens), NOON + timedelta(seconds=60))
    assert len(sessions._open) == 1


def test_a_service_that_is_started_again_knows_its_sessions(tokens, tmp_path):
    cookie, session = Sessions(tokens, lasting_s=60.0).begin(grant_in(tokens), NOON)
    again = Sessions(Tokens(tmp_path), lasting_s=60.0)
    assert again.find(cookie, NOON)[1] == session
    again.end(cookie)
    assert Sessions(tokens, lasting_s=60.0).find(cookie, NOON) is None


def test_a_session_of_a_token_that_was_not_kept_ends_with_the_service(tokens, tmp_path):
    grant = tokens.grant(tokens.mint(["read"], keep=False))
    cookie, _ = Sessions(tokens, lasting_s=60.0).begin(grant, NOON)
    assert Sessions(Tokens(tmp_path), lasting_s=60.0).find(cookie, NOON) is None


def test_the_file_opens_nothing(tokens, tmp_path):
    cookie, session = Sessions(tokens, lasting_s=60.0).begin(grant_in(tokens), NOON)
    file = tmp_path / "sessions.json"
    assert file.stat().st_mode & 0o077 == 0
    assert cookie not in file.read_text()
    assert session.csrf not in file.read_text()


@pytest.mark.parametrize(
    "text", ["", "[]", "{", '{"a": 1}', '{"a": ["b", "noon"]}', '{"a": ["b", "2020-02-01"]}']
)
def test_a_damaged_file_signs_nobody_in_and_stops_nobody(tokens, tmp_path, text):
    (tmp_path / "sessions.json").write_text(text)
    sessions = Sessions(tokens, lasting_s=60.0)
    assert sessions.find("guess", NOON) is None
    cookie, _ = sessions.begin(grant_in(tokens), NOON)
    assert sessions.find(cookie, NOON) is not None


def test_a_disk_that_takes_nothing_still_lets_people_in(tmp_path):
    tokens = Tokens(tmp_path)
    (tmp_path / "sessions.json.new").mkdir()  # where the file would be written
    sessions = Sessions(tokens, lasting_s=60.0)
    grant = tokens.grant(tokens.mint(["read"], keep=False))
    cookie, _ = sessions.begin(grant, NOON)
    assert sessions.find(cookie, NOON) is not None


def test_a_session_that_is_renewed_lasts_anew(tokens):
    sessions = Sessions(tokens, lasting_s=60.0)
    cookie, _ = sessions.begin(grant_in(tokens), NOON)
    soon, later = NOON + timedelta(seconds=50), NOON + timedelta(seconds=100)
    assert sessions.renew(cookie, soon).expires == soon + timedelta(seconds=60)
    assert sessions.find(cookie, later) is not None
    assert sessions.renew(cookie, later + timedelta(seconds=60)) is None
