from pathlib import Path

import pytest

from seacage.conventions import InputError, NonsenseError
from seacage.service._settings import Settings, read_settings, without_password


@pytest.fixture
def file(tmp_path):
    """A file of settings that a test writes."""

    def written(text):
        path = tmp_path / "seacage.toml"
        path.write_text(text)
        return path

    return written


def test_the_command_line_goes_before_the_environment_and_that_before_the_file(monkeypatch, file):
    monkeypatch.setenv("SEACAGE_PORT", "9001")
    monkeypatch.setenv("SEACAGE_HOST", "localhost")
    settings = read_settings(file('port = 9000\nsite = "bay"\n'), host="::1", data=None)
    assert (settings.host, settings.port, settings.site) == ("::1", 9001, "bay")
    assert settings.tick_s == 2.0


def test_a_section_can_come_in_parts_from_everywhere(monkeypatch, file):
    monkeypatch.setenv("SEACAGE_STORE__URL", "postgresql://from-the-environment")
    text = '[store]\nkeep_days = 30\narchive = "parquet"\n'
    store = read_settings(file(text), store={"keep_days": 10}).store
    assert (store.url, store.keep_days) == ("postgresql://from-the-environment", 10.0)
    assert str(store.archive) == "parquet"


def test_a_whole_farm_fits_in_a_file(file):
    settings = read_settings(
        file(
            """
            site = "bay"
            [mqtt]
            url = "mqtts://broker.example"
            group = "farm"
            [[cages]]
            name = "north"
            twin = "twins/north"
            [cages.alarms."load.bridle-3"]
            raise_at = 0.6
            [[cages]]
            name = "south"
            twin = "twins/south"
            [alarms.load]
            raise_at = 0.7
            [[webhooks]]
            url = "https://phone.example/alarm"
            after_s = 600
            [limits]
            requests_per_s = 50
            """
        )
    )
    assert [cage.name for cage in settings.cages] == ["north", "south"]
    assert settings.cages[0].alarms == {"load.bridle-3": {"raise_at": 0.6}}
    assert settings.alarms == {"load": {"raise_at": 0.7}}
    assert settings.limits.requests_per_s == 50.0
    assert settings.webhooks[0].after_s == 600.0


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ('tick_s = "often"', "tick_s = 'often'"),
        ("prot = 8000", "'prot' is unknown"),
        ("port = ", "not TOML"),
        ("[store]\nkeep = 3", "store.keep"),
        ('[store]\narchive = "parquet"', "keep_days too"),
        ('certificate = "c.pem"', "its key"),
        ('[opcua]\nkey = "k.pem"', "its key"),
        ("[opcua]\nport = 0", "opcua.port = 0"),
        ('[mqtt]\nurl = "mqtt://h"\nhome_assistant = "a/#"', "mqtt.home_assistant"),
        ('[[cages]]\ntwin = "a"\n[[cages]]\ntwin = "b"', "a name each"),
        ('[[cages]]\ntwin = "a"\nname = "../a"', "cages.0.name"),
        ("[limits]\nburst = 0", "limits.burst = 0"),
        ('[[webhooks]]\nurl = "ftp://x"', "webhooks.0.url"),
    ],
)
def test_a_setting_that_does_not_do_is_named(file, text, named):
    with pytest.raises(InputError, match=named.replace("[", "\\[")):
        read_settings(file(text))


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("[alarms.load]\nraise_at = inf", "alarms.load.raise_at = inf is no finite number"),
        (
            '[[cages]]\ntwin = "a"\n[cages.alarms.load]\nclear_at = nan',
            "cages.alarms.load.clear_at",
        ),
        ("[store]\nkeep_days = inf", "store.keep_days = inf"),
    ],
)
def test_a_number_that_is_none_is_nonsense_and_the_file_is_named(file, text, named):
    with pytest.raises(NonsenseError, match=f"seacage.toml: {named}"):
        read_settings(file(text))


def test_a_settings_file_is_bounded_in_depth_and_in_kind(file):
    with pytest.raises(InputError, match="more than 32 deep"):
        read_settings(file("a = " + "[" * 100_000))
    with pytest.raises(InputError, match="no regular file"):
        read_settings(Path("/dev/zero"))


def test_a_fault_does_not_show_a_password(file):
    with pytest.raises(InputError) as error:
        read_settings(file('[mqtt]\nurl = ["mqtt://u:secret@h"]\n'))
    assert "secret" not in str(error.value)
    assert without_password("mqtts://user:secret@host:8883") == "mqtts://host:8883"
    assert without_password("/var/lib/a.sqlite") == "/var/lib/a.sqlite"


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "cage.example"])
def test_plain_http_beyond_this_machine_takes_a_decision(host, tmp_path):
    with pytest.raises(InputError, match="--insecure-http"):
        Settings(host=host).check_host()
    Settings(host=host, insecure_http=True).check_host()
    Settings(host=host, certificate=tmp_path / "c.pem", key=tmp_path / "k.pem").check_host()


def test_opc_ua_beyond_this_machine_takes_a_certificate_and_nothing_else_does(tmp_path):
    outside = {"host": "0.0.0.0"}
    with pytest.raises(InputError, match=r"opcua\.host = 0\.0\.0\.0 is reachable from outside"):
        Settings(opcua=outside, insecure_http=True).check_host()
    Settings(opcua={}).check_host()
    files = {"certificate": tmp_path / "c.pem", "key": tmp_path / "k.pem"}
    Settings(opcua=outside | files).check_host()


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "localhost"])
def test_this_machine_needs_no_decision(host):
    Settings(host=host).check_host()


def test_a_worker_is_one_of_the_workers_and_shares_named_cages(file):
    with pytest.raises(InputError, match="worker = 2 of workers = 2"):
        read_settings(file("worker = 2\nworkers = 2\n"))
    with pytest.raises(InputError, match="take a name each"):
        read_settings(file('workers = 2\n[[cages]]\ntwin = "."\n'))


@pytest.mark.parametrize("proxy", ["proxy.example", "10.0.0.1/8", "*", ""])
def test_a_trusted_proxy_is_an_address_or_a_network(proxy):
    with pytest.raises(InputError, match="trusted_proxies"):
        read_settings(trusted_proxies=[proxy])
