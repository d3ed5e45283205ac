"""The page on other simulators: its files are read, and its commands lead to a twin."""

import re
import shlex
from pathlib import Path

from typer.testing import CliRunner

from seacage.records._readers._results import EDGE_COLUMNS, NODE_COLUMNS, STATISTICS
from seacage.service._cli._app import app
from seacage.twin import Twin

PAGE = (Path(__file__).parents[2] / "docs/simulators.md").read_text()


def test_every_column_is_on_the_page():
    assert all(f"`{one}`" in PAGE for one in (*NODE_COLUMNS, *EDGE_COLUMNS, *STATISTICS))


def test_the_example_leads_to_a_twin(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (script,) = re.findall(r"```python\n(.+?)```", PAGE, re.DOTALL)
    exec(script, {})  # the page's own
    (commands,) = re.findall(r"```console\n(.+?)```", PAGE, re.DOTALL)
    for command in commands.replace("--cage mine.toml", "--cage ace").splitlines():
        words = shlex.split(command.removeprefix("$ seacage "))
        result = CliRunner().invoke(app, words, catch_exceptions=False)
        assert result.exit_code == 0, f"{command}: {result.stderr}"
        assert "warning" not in result.stderr
    assert "Left out" in result.stdout
    twin = Twin.read("twin")
    assert (twin.cage.rings, twin.cage.spokes) == (5, 16)
    assert twin.provenance.law == "Mine 1.0"
