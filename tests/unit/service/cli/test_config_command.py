import json

import pytest
from typer.testing import CliRunner

from seacage.service._cli._app import app
from seacage.testing import stand_in_twin


@pytest.fixture(scope="module")
def twin(tmp_path_factory):
    folder = tmp_path_factory.mktemp("twin") / "twin"
    stand_in_twin().write(folder)
    return folder


def checked(tmp_path, text, *words):
    file = tmp_path / "seacage.toml"
    file.write_text(f'data = "{tmp_path / "data"}"\n{text}')
    result = CliRunner().invoke(app, ["config", "check", "--config", str(file), "--json", *words])
    findings = {one["what"]: one for one in json.loads(result.stdout)["findings"]}
    return result.exit_code, findings


def test_settings_that_can_be_are_found_right_and_leave_no_trace(tmp_path, twin):
    text = f"""
    [store]
    keep_days = 30
    [mqtt]
    url = "mqtt://127.0.0.1"
    [[cages]]
    name = "north"
    twin = "{twin}"
    [cages.alarms."load.bridle-3"]
    raise_at = 0.75
    [[webhooks]]
    url = "https://phone.example/alarm"
    cages = ["north"]
    """
    code, findings = checked(tmp_path, text)
    assert code == 0, findings
    assert {one["state"] for one in findings.values()} == {"ok"}
    assert "sensors" in findings["cage north"]["said"]
    assert not (tmp_path / "data").exists()


@pytest.mark.parametrize(
    ("text", "what", "why"),
    [
        ('host = "0.0.0.0"', "address", "plain HTTP"),
        ('[[cages]]\nname = "a"\ntwin = "{here}"', "cage a", "not a whole twin"),
        (
            '[[cages]]\nname = "a"\ntwin = "{twin}"\n[alarms."load.bridle-99"]\nraise_at = 0.5',
            "cage a",
            "no alarm 'load.bridle-99'",
        ),
        ('certificate = "{here}/x"\nkey = "{here}/y"', "certificate", "no PEM"),
        ('[mqtt]\nurl = "http://x"', "mqtt", "no broker's address"),
        (
            '[[cages]]\nname = "a"\ntwin = "{twin}"\n[[webhooks]]\nurl = "http://x"\ncages = ["b"]',
            "webhook",
            "No cage is called 'b'",
        ),
    ],
)
def test_what_cannot_be_is_named(tmp_path, twin, text, what, why):
    code, findings = checked(tmp_path, text.format(here=tmp_path, twin=twin))
    assert code == 1
    assert findings[what]["state"] == "wrong"
    assert why in findings[what]["said"]


def test_a_broker_that_is_not_there_is_noticed_only_on_request(tmp_path):
    text = '[mqtt]\nurl = "mqtt://127.0.0.1:1"'
    assert checked(tmp_path, text)[0] == 0
    code, findings = checked(tmp_path, text, "--reach")
    assert code == 1
    assert findings["mqtt"]["state"] == "wrong"
    assert findings["store"]["said"].endswith("opens")


def test_settings_are_shown_as_they_would_be_taken_without_secrets(tmp_path, monkeypatch):
    monkeypatch.setenv("SEACAGE_STORE__URL", "postgresql://sea:hush@db/farm")
    file = tmp_path / "seacage.toml"
    file.write_text('site = "bay"\n[[webhooks]]\nurl = "https://a:hush@x"\nsecret = "hush"\n')
    result = CliRunner().invoke(app, ["config", "show", "--config", str(file), "--json"])
    shown = json.loads(result.stdout)
    assert shown["site"] == "bay"
    assert shown["store.url"] == "postgresql://db/farm"
    assert shown["webhooks.0.url"] == "https://x"
    assert shown["limits.burst"] == 1000.0
    assert "hush" not in result.stdout


def test_a_token_is_made_listed_and_revoked_by_name(tmp_path):
    def output_of(*words):
        result = CliRunner().invoke(app, ["token", *words, "--data", str(tmp_path)])
        assert result.exit_code == 0, result.stderr
        return result.stdout

    token = output_of("new", "--scope", "read,ack", "--name", "Night shift").splitlines()[-1]
    (listed,) = json.loads(output_of("list", "--json"))["tokens"]
    assert (listed["name"], listed["scope"]) == ("Night shift", ["read", "ack"])
    assert token not in output_of("list")
    output_of("revoke", "Night shift")
    assert json.loads(output_of("list", "--json"))["tokens"] == []
    audited = [json.loads(line) for line in (tmp_path / "audit.jsonl").read_text().splitlines()]
    assert [line["did"] for line in audited] == ["token new", "token revoke"]
    assert {line["about"] for line in audited} == {listed["id"]}
