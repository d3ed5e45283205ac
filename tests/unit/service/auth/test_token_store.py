import errno
import os
from concurrent.futures import ThreadPoolExecutor

import pytest

from seacage.conventions import InputError
from seacage.service._auth._token_store import Tokens


def test_a_minted_token_is_known_and_only_its_hash_is_kept(tmp_path):
    token = Tokens(tmp_path).mint(["ingest", "read"], keep=True)
    kept = (tmp_path / "tokens.jsonl").read_text()
    assert token not in kept
    assert Tokens(tmp_path).grant(token).scopes == ("ingest", "read")


def test_the_file_of_tokens_is_the_owners_alone(tmp_path):
    Tokens(tmp_path).mint(["read"], keep=True)
    assert (tmp_path / "tokens.jsonl").stat().st_mode & 0o077 == 0


def test_a_running_service_knows_a_new_token_at_once(tmp_path):
    running = Tokens(tmp_path)
    assert running.grant("guess") is None
    token = Tokens(tmp_path).mint(["read"], keep=True)
    assert running.grant(token) is not None


def test_a_passing_token_ends_with_the_process(tmp_path):
    tokens = Tokens(tmp_path)
    token = tokens.mint(["read"], keep=False)
    assert tokens.grant(token) is not None
    assert Tokens(tmp_path).grant(token) is None


@pytest.mark.parametrize(
    ("scope", "action", "cage", "allowed"),
    [
        ("read", "read", "ace", True),
        ("read", "ingest", "ace", False),
        ("ingest:ace", "ingest", "ace", True),
        ("ingest:ace", "ingest", "ice", False),
        ("ingest:ace", "read", "ace", False),
        ("read:ace", "read", None, True),
        ("admin", "ack", "ice", True),
    ],
)
def test_a_scope_allows_what_it_says(tmp_path, scope, action, cage, allowed):
    tokens = Tokens(tmp_path)
    assert tokens.grant(tokens.mint([scope], keep=False)).allows(action, cage) is allowed


@pytest.mark.parametrize("scopes", [["write"], [""], [], ["read", "ingest:../x"], ["admin:ace"]])
def test_a_scope_that_does_not_exist_is_refused(tmp_path, scopes):
    with pytest.raises(InputError, match="scopes are read, ingest and ack"):
        Tokens(tmp_path).mint(scopes, keep=True)
    assert not (tmp_path / "tokens.jsonl").exists()


def test_a_token_has_the_name_of_whoever_holds_it(tmp_path):
    tokens = Tokens(tmp_path)
    grant = tokens.grant(tokens.mint(["ack"], keep=True, name="Ada of the night shift"))
    assert grant.who == "Ada of the night shift"
    nameless = tokens.grant(tokens.mint(["ack"], keep=True))
    assert nameless.who == f"token {nameless.id}"


def test_a_revoked_token_opens_nothing_from_then_on(tmp_path):
    running = Tokens(tmp_path)
    token = Tokens(tmp_path).mint(["read"], keep=True, name="ada")
    other = Tokens(tmp_path).mint(["read"], keep=True)
    assert running.grant(token) is not None
    revoked = Tokens(tmp_path).revoke(running.grant(token).id)
    assert revoked.name == "ada"
    assert running.grant(token) is None
    assert running.grant(other) is not None
    with pytest.raises(InputError, match="No token is called 'ada'"):
        running.revoke("ada")


def test_two_tokens_cannot_have_one_name(tmp_path):
    tokens = Tokens(tmp_path)
    tokens.mint(["read"], keep=True, name="ada")
    with pytest.raises(InputError, match="called 'ada' already"):
        tokens.mint(["read"], keep=True, name="ada")


@pytest.mark.parametrize("name", ["a\nb", "<ada>", "x" * 65, " ada"])
def test_a_name_that_could_deceive_a_reader_is_refused(tmp_path, name):
    with pytest.raises(InputError, match="no name for a token"):
        Tokens(tmp_path).mint(["read"], keep=True, name=name)


def test_a_folder_without_an_admin_says_so(tmp_path):
    tokens = Tokens(tmp_path)
    tokens.mint(["read"], keep=True, name="admin")
    assert tokens.lacks_admin
    tokens.mint(["admin"], keep=True)
    assert not tokens.lacks_admin


@pytest.mark.parametrize(
    "rest", ['{"sha256": "0123', "{}", "null", '{"sha256": 1, "scopes": ["all"]}', "\xff\xfe", "["]
)
def test_a_line_that_a_full_disk_cut_off_shuts_nobody_out_and_is_named(tmp_path, rest):
    token = Tokens(tmp_path).mint(["read"], keep=True, name="ada")
    with (tmp_path / "tokens.jsonl").open("ab") as file:
        file.write(rest.encode("latin-1"))
    tokens = Tokens(tmp_path)
    assert tokens.grant(token).who == "ada"
    assert tokens.grant("guess") is None
    assert f"{tmp_path / 'tokens.jsonl'} holds what is no token: line 2" in tokens.damage


def test_a_token_that_a_running_service_knows_outlives_damage_to_its_line(tmp_path):
    running, path = Tokens(tmp_path), tmp_path / "tokens.jsonl"
    ada = running.mint(["read"], keep=True, name="ada")
    bob = running.mint(["read"], keep=True, name="bob")
    assert running.grant(ada) is not None
    lines = path.read_text().splitlines()
    path.write_text(lines[0][:20] + "\n" + lines[1] + "\n")
    assert running.grant(ada) is not None
    Tokens(tmp_path).revoke("bob")
    assert running.grant(bob) is None
    assert running.grant(ada) is not None


def test_a_token_made_after_a_line_was_cut_off_is_known(tmp_path):
    tokens = Tokens(tmp_path)
    tokens.mint(["read"], keep=True)
    with (tmp_path / "tokens.jsonl").open("a") as file:
        file.write('{"sha256": "0123')
    assert Tokens(tmp_path).grant(tokens.mint(["read"], keep=True)) is not None


def test_a_disk_that_takes_no_token_leaves_those_that_were_there(tmp_path, monkeypatch):
    tokens = Tokens(tmp_path)
    token = tokens.mint(["read"], keep=True)
    before = (tmp_path / "tokens.jsonl").read_bytes()
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        tokens.mint(["read"], keep=True)
    assert (tmp_path / "tokens.jsonl").read_bytes() == before
    assert [file.name for file in tmp_path.iterdir()] == ["tokens.jsonl"]
    assert Tokens(tmp_path).grant(token) is not None


def full(*_):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_tokens_that_many_make_at_once_are_all_kept(tmp_path):
    with ThreadPoolExecutor(8) as pool:
        made = list(pool.map(lambda _: Tokens(tmp_path).mint(["read"], keep=True), range(40)))
    tokens = Tokens(tmp_path)
    assert all(tokens.grant(token) for token in made)


def test_a_token_with_half_a_character_is_only_unknown(tmp_path):
    assert Tokens(tmp_path).grant("\ud800") is None
