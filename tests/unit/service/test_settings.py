import pytest

from seacage.conventions import InputError
from seacage.service._commands._serve import _settings
from seacage.service._settings import Settings


def test_the_command_line_goes_before_the_environment_and_that_before_the_default(monkeypatch):
    monkeypatch.setenv("SEACAGE_PORT", "9001")
    monkeypatch.setenv("SEACAGE_HOST", "localhost")
    settings = _settings(port=9002, host=None)
    assert (settings.port, settings.host) == (9002, "localhost")
    assert settings.tick_s == 2.0


def test_a_setting_that_does_not_do_is_named(monkeypatch):
    monkeypatch.setenv("SEACAGE_TICK_S", "often")
    with pytest.raises(InputError, match="tick_s = 'often'"):
        _settings()


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "cage.example"])
def test_plain_http_beyond_this_machine_takes_a_decision(host):
    with pytest.raises(InputError, match="--insecure-http"):
        Settings(host=host).check_host()
    Settings(host=host, insecure_http=True).check_host()


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "localhost"])
def test_this_machine_needs_no_decision(host):
    Settings(host=host).check_host()
