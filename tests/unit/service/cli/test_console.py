import json
import math
import subprocess
import sys
from dataclasses import dataclass
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from seacage.conventions import InputError, ModelError, NonsenseError, SeacageError
from seacage.service._cli._console import Exit, guard, progress_bar, report, without_nan


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (NonsenseError("no"), Exit.USAGE),
        (InputError("no"), Exit.REFUSED),
        (ModelError("no"), Exit.REFUSED),
        (SeacageError("no"), Exit.FAILED),
        (OSError("no"), Exit.FAILED),
        (KeyboardInterrupt(), Exit.INTERRUPTED),
    ],
    ids=lambda one: type(one).__name__,
)
def test_an_error_becomes_one_sentence_and_a_code(error, code, capsys):
    @guard
    def command():
        raise error

    with pytest.raises(typer.Exit) as ended:
        command()
    assert ended.value.exit_code == code
    assert capsys.readouterr().err.count("\n") == 1


def test_a_fault_of_our_own_is_not_hidden():
    @guard
    def command():
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        command()


def test_numbers_that_json_does_not_have_become_null():
    assert without_nan({"a": [1.0, math.nan, (math.inf,)], "b": "nan"}) == {
        "a": [1.0, None, [None]],
        "b": "nan",
    }


@dataclass(frozen=True, kw_only=True)
class Colours:
    """Two colours.

    Options:
        left: On the left, of a name that
            goes over two lines.
    """

    left: str
    right: Annotated[str, typer.Option(help="On the right.")] = "green"


def test_a_dataclass_becomes_options_with_the_help_of_its_docstring():
    app = typer.Typer(rich_markup_mode=None)

    @app.command()
    @guard
    def paint(size: Annotated[int, typer.Argument()], *, colours: Colours, fast: bool = False):
        """Paint a net.

        Example:
            paint 3

        Options:
            size: In metres.
        """
        report({"size": size, "colours": [colours.left, colours.right], "fast": fast})

    said = CliRunner().invoke(app, ["--help"]).stdout
    assert "size:" not in said
    for words in ("Paint a net.", "paint 3", "In metres.", "two lines.", "On the right."):
        assert words in said
    said = CliRunner().invoke(app, ["3", "--left", "red", "--json"]).stdout
    assert json.loads(said) == {"size": 3, "colours": ["red", "green"], "fast": False}


def test_a_log_gets_the_first_and_the_last_line_of_a_stage(capsys):
    with progress_bar() as progress:
        for done in range(101):
            progress("settle", done, 100)
    output = capsys.readouterr().err.splitlines()
    assert output == ["settle: 0 of 100", "settle: 100 of 100"]


def test_a_reader_who_stops_reading_is_sent_nothing():
    script = (
        "from seacage.service._cli._console import guard\n"
        "import typer\n"
        "@guard\n"
        "def many():\n"
        "    for line in range(100_000):\n"
        "        typer.echo(line)\n"
        "try:\n"
        "    many()\n"
        "except typer.Exit as end:\n"
        "    raise SystemExit(end.exit_code)\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.readline()
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == Exit.PIPE_CLOSED
