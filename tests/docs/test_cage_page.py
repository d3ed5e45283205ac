"""The page on a cage of one's own: every key is on it, and its commands lead to a twin."""

import re
import shlex
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import get_args, get_origin

import pytest
from typer.testing import CliRunner

from seacage.cage import Cage
from seacage.cage._parts import key_of
from seacage.service._cli._app import app
from seacage.twin import Twin

PAGE = (Path(__file__).parents[2] / "docs/cage.md").read_text()


def keys(kind: type) -> set[str]:
    return {key_of(parameter) for parameter in fields(kind)}


def sections() -> dict[str, set[str]]:
    """Keys of each section that the reader knows."""
    known = dict[str, set[str]]()
    for parameter in fields(Cage):
        several = get_origin(parameter.type) is tuple
        kind = get_args(parameter.type)[0] if several else parameter.type
        if is_dataclass(kind):
            known[f"[[{parameter.name}]]" if several else f"[{parameter.name}]"] = keys(kind)
    return known


def test_every_key_that_is_read_is_on_the_page_and_no_other():
    tables = re.findall(r"^### `(\[.+?\])`$(.+?)(?=^### |\Z)", PAGE, re.MULTILINE | re.DOTALL)
    listed = {name: set(re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE)) for name, text in tables}
    assert listed == sections()
    for key in keys(Cage) - {name.strip("[]") for name in listed}:
        assert f"`{key}`" in PAGE


@pytest.mark.slow
@pytest.mark.parametrize("bridles", [8, 16])
def test_the_whole_way_leads_to_a_twin(bridles, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    way = PAGE[PAGE.index("## The whole way") : PAGE.index("## What is checked")]
    steps = re.findall(r"```(console|toml)\n(.+?)```", way, re.DOTALL)
    assert [kind for kind, _ in steps] == ["console", "toml", "console", "console"]
    for kind, text in steps:
        if kind == "toml":
            with Path("mine.toml").open("a") as file:
                file.write(f"\n{text}")
            continue
        for command in text.replace("--bridles 8", f"--bridles {bridles}").splitlines():
            words = shlex.split(command.removeprefix("$ seacage "))
            result = CliRunner().invoke(app, words, catch_exceptions=False)
            assert result.exit_code == 0, f"{command}: {result.stderr}"
            assert "warning" not in result.stderr
    twin = Twin.read("twin")
    assert twin.cage.bridle_count == bridles
    assert twin.sensor_names == ("depth-1", "shackle-1")
    assert Path("mine.png").stat().st_size > 10_000
