from pathlib import Path

import pytest

from seacage.service._settings import Settings, read_settings

PACKAGING = Path(__file__).parents[3] / "packaging"


def uncommented(text):
    """The example with every commented setting in force."""
    lines = [line.removeprefix("# ") for line in text.splitlines()]
    return "\n".join(line for line in lines if line.startswith("[") or " = " in line)


def test_the_example_settings_can_be_read():
    settings = read_settings(PACKAGING / "seacage.toml")
    assert settings.site == "bay"
    assert [cage.name for cage in settings.cages] == ["north"]


def test_what_the_example_comments_out_can_be_read_too_and_leaves_nothing_out(tmp_path):
    file = tmp_path / "whole.toml"
    file.write_text(uncommented((PACKAGING / "seacage.toml").read_text()))
    settings = read_settings(file)
    assert settings.model_fields_set == Settings.model_fields.keys()
    assert settings.mqtt is not None
    for section in (settings.store, settings.mqtt, settings.limits):
        assert section.model_fields_set == type(section).model_fields.keys()
    assert settings.limits.body_bytes == Settings().limits.body_bytes


@pytest.mark.parametrize("name", ["seacage.service", "Containerfile"])
def test_a_service_is_started_with_its_file_of_settings_and_never_as_root(name):
    text = (PACKAGING / name).read_text()
    assert "--config" in text
    assert "DynamicUser=yes" in text or "USER seacage" in text


@pytest.mark.parametrize("name", ["seacage.service", "Containerfile"])
def test_where_the_data_lie_is_stated_once_and_where_the_service_may_write(name):
    text = (PACKAGING / name).read_text()
    assert "SEACAGE_" not in text, "a variable would go before the file, and nobody would see it"
    data = read_settings(PACKAGING / "seacage.toml").data
    assert f"WorkingDirectory={data}" in text or f"VOLUME {data}" in text


def test_the_unit_lets_as_many_connections_be_open_as_the_settings_do():
    text = (PACKAGING / "seacage.service").read_text()
    files = next(line for line in text.splitlines() if line.startswith("LimitNOFILE="))
    assert int(files.partition("=")[2]) > 2 * Settings().limits.connections
