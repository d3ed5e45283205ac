"""What every command shares: exit codes, one-sentence errors, output and progress."""

import functools
import json
import os
import re
import sys
import time
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from enum import IntEnum
from importlib.metadata import requires
from typing import TYPE_CHECKING, Annotated, Literal, ParamSpec, TypeVar

import typer

if TYPE_CHECKING:
    from seacage.conventions import Progress

P = ParamSpec("P")
R = TypeVar("R")

Json = Annotated[
    bool,
    typer.Option("--json", help="Print one JSON object on stdout, for programs."),
]


class Exit(IntEnum):
    """How a command ended."""

    OK = 0
    REFUSED = 1
    USAGE = 2
    FAILED = 3
    EXCEEDED = 4
    INTERRUPTED = 130
    PIPE_CLOSED = 141


EXIT_CODES = (
    "Exit codes: 0 done; 1 the input was refused; 2 the command line was not understood, or a file "
    "that it names makes no sense; "
    "3 the work failed; 4 a bound that was given is exceeded; 130 interrupted; 141 whoever read "
    "the output stopped reading."
)


def guard(command: Callable[P, R]) -> Callable[P, R]:
    """Let a command end with one sentence on stderr and an exit code, never a traceback."""

    @functools.wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> R:
        from seacage.conventions import InputError, ModelError, NonsenseError, SeacageError

        try:
            return command(*args, **kwargs)
        except NonsenseError as error:
            raise exit_with(str(error), Exit.USAGE) from error
        except (InputError, ModelError) as error:
            raise exit_with(str(error), Exit.REFUSED) from error
        except BrokenPipeError as error:
            # As after `seacage … | head`: nobody is left to tell, also not when Python ends.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(Exit.PIPE_CLOSED) from error
        except ModuleNotFoundError as error:
            raise exit_with(_of_an_extra(error), Exit.FAILED) from error
        except (SeacageError, OSError) as error:
            raise exit_with(str(error), Exit.FAILED) from error
        except KeyboardInterrupt as error:
            raise exit_with("Interrupted; run it again to go on.", Exit.INTERRUPTED) from error

    run.__doc__ = _with_examples_kept(command.__doc__ or "")
    return run


def _of_an_extra(error: ModuleNotFoundError) -> str:
    """Name the extra that brings a module; a module of none is our own fault."""
    package = (error.name or "").partition(".")[0]
    for line in requires("seacage") or ():
        known, _, condition = line.partition(";")
        if package in re.split(r"\W", known) and (extra := re.search(r"'(?!dev)(\w+)'", condition)):
            return (
                f"This needs {package}, which the base install leaves out. "
                f"Install it with: pip install 'seacage[{extra[1]}]'."
            )
    raise error


def _with_examples_kept(text: str) -> str:
    # A backspace alone on a line tells typer not to rewrap the paragraph below it.
    return re.sub(r"\n( *)Example", "\n\\1\b\n\\1Example", text, count=1)


def exit_with(sentence: str, code: Exit) -> typer.Exit:
    """Say a sentence on stderr and return the exit to raise."""
    typer.echo(f"seacage: {sentence}", err=True)
    return typer.Exit(code)


def report(
    answer: Mapping[str, object], *, as_json: bool, rows: Sequence[tuple[str, str]] = ()
) -> None:
    """Print a command's answer.

    Parameters
    ----------
    answer
        What a program gets with ``--json``; NaN becomes null.
    as_json
        Whether ``--json`` was given.
    rows
        What a person gets: names and values, in two columns.
    """
    if as_json:
        typer.echo(json.dumps(without_nan(answer), default=str))
        return
    width = max((len(name) for name, _ in rows), default=0)
    for name, value in rows:
        typer.echo(f"{name:<{width}}  {value}")


def without_nan(value: object) -> object:
    """Turn numbers that JSON does not have into null, at any depth."""
    if isinstance(value, float):
        return value if abs(value) < float("inf") else None
    if isinstance(value, Mapping):
        return {str(key): without_nan(item) for key, item in value.items()}  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]
    if isinstance(value, list | tuple):
        return [without_nan(item) for item in value]  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]
    return value


@contextmanager
def progress_bar() -> "Generator[Progress]":
    """Show stages with the time left on stderr: a bar for a person, lines for a log."""
    if not sys.stderr.isatty():
        yield _Lines()
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn
    from rich.progress import TimeElapsedColumn as Elapsed
    from rich.progress import TimeRemainingColumn as Remaining

    tasks: dict[str, TaskID] = {}
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), Elapsed())
    with Progress(*columns, Remaining(), console=Console(stderr=True)) as bar:

        def show(stage: str, done: int, total: int) -> None:
            if stage not in tasks:
                tasks[stage] = bar.add_task(stage, total=total)
            bar.update(tasks[stage], completed=done, total=total)

        yield show


class _Lines:
    """Progress for a log: a line when a stage begins, ends, and now and then between."""

    def __init__(self, *, every_s: float = 5.0) -> None:
        self._every_s = every_s
        self._began: dict[str, tuple[float, int]] = {}
        self._said = 0.0

    def __call__(self, stage: str, done: int, total: int) -> None:
        now = time.monotonic()
        if stage in self._began and done < total and now - self._said < self._every_s:
            return
        began, first = self._began.setdefault(stage, (now, done))
        self._said = now
        pace_s = (now - began) / (done - first) if done > first else 0.0
        left = f", {pace_s * (total - done):.0f} s left" if pace_s and done < total else ""
        typer.echo(f"{stage}: {done} of {total}{left}", err=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """What was looked at, how it is, and what to do where it is wrong."""

    what: str
    state: Literal["ok", "absent", "wrong"]
    message: str


def report_findings(
    command: str, findings: Sequence[Finding], *, code: Exit, as_json: bool
) -> None:
    """Print what was found, and end with a code where something is wrong.

    Parameters
    ----------
    command
        Whose findings they are.
    findings
        All of them, in the order in which they are read.
    code
        To end with where one is wrong.
    as_json
        Whether ``--json`` was given.
    """
    wrong = [one for one in findings if one.state == "wrong"]
    report(
        {"ok": not wrong}
        | {"findings": [{"what": f.what, "state": f.state, "said": f.message} for f in findings]},
        as_json=as_json,
        rows=[(f"{one.state:<6}  {one.what}", one.message) for one in findings],
    )
    if wrong:
        raise exit_with(f"{command}: {len(wrong)} of {len(findings)} are wrong.", code)
