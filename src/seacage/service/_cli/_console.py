"""What every command shares: exit codes, one-sentence errors, output and progress."""

import functools
import inspect
import json
import os
import re
import sys
import textwrap
import time
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from copy import copy
from dataclasses import MISSING, asdict, dataclass, fields, is_dataclass
from enum import IntEnum
from importlib.metadata import requires
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar, get_args, get_origin

import typer

if TYPE_CHECKING:
    import numpy as np

    from seacage.conventions import Progress

R = TypeVar("R")
Json = Annotated[
    bool, typer.Option("--json", help="Print one JSON object on stdout, for programs.")
]
_MEANING = re.compile(r"^(\w+): (.+(?:\n {4}.+)*)", re.MULTILINE)  # of an option
_LINE_EVERY_S = 5.0  # of progress in a log
_wants_json = ContextVar("_wants_json", default=False)


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
    "that it names makes no sense; 3 the work failed; 4 a bound that was given is exceeded; 130 "
    "interrupted; 141 whoever read the output stopped reading."
)


def guard(command: Callable[..., R]) -> Callable[..., R]:
    """Let a command end with one sentence on stderr and an exit code, never a traceback.

    Every command gets the option ``--json``. A parameter whose type is a dataclass becomes one
    option per field, and the command gets them as that one value. The docstrings hold the help.
    """
    text, meanings = _split_docstring(command.__doc__)
    signature = inspect.signature(command)
    groups: dict[str, type[Any]] = {
        one.name: one.annotation
        for one in signature.parameters.values()
        if isinstance(one.annotation, type) and is_dataclass(one.annotation)
    }

    @functools.wraps(command)
    def run(*args: Any, as_json: bool = False, **kwargs: Any) -> R:
        from seacage.conventions import InputError, ModelError, NonsenseError, SeacageError

        _wants_json.set(as_json)
        for name, group in groups.items():
            kwargs[name] = group(**{one.name: kwargs.pop(one.name) for one in fields(group)})
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

    parameters = list(_with_options(signature, meanings))
    run.__signature__ = signature.replace(parameters=parameters)  # pyright: ignore[reportAttributeAccessIssue]
    # A backspace alone on a line tells typer not to rewrap the paragraph below it.
    run.__doc__ = text.replace("\nExample", "\n\b\nExample", 1)
    return run


def _split_docstring(docstring: str | None) -> tuple[str, dict[str, str]]:
    """The text of a docstring, and the meanings of its options."""
    text, _, section = inspect.cleandoc(docstring or "").partition("\n\nOptions:\n")
    found = _MEANING.findall(textwrap.dedent(section))
    return text, {name: " ".join(meaning.split()) for name, meaning in found}


def _with_options(
    signature: inspect.Signature, meanings: Mapping[str, str]
) -> Iterator[inspect.Parameter]:
    """The parameters that the command line has for a command's own."""
    for one in signature.parameters.values():
        if is_dataclass(one.annotation):
            _, own = _split_docstring(one.annotation.__doc__)
            for option in fields(one.annotation):
                default = one.empty if option.default is MISSING else option.default
                kind = _with_help(option.type, own.get(option.name))
                yield one.replace(name=option.name, annotation=kind, default=default)
        else:
            yield one.replace(annotation=_with_help(one.annotation, meanings.get(one.name)))
    kind = inspect.Parameter.KEYWORD_ONLY
    yield inspect.Parameter("as_json", kind, annotation=Json, default=False)


def _with_help(annotation: Any, meaning: str | None) -> Any:
    """An option's or an argument's type with its help; a shared type may have its own."""
    if meaning is None:
        return annotation
    parts = get_args(annotation) if get_origin(annotation) is Annotated else (annotation, None)
    info = copy(parts[1]) if parts[1] else typer.Option()
    info.help = meaning
    return Annotated[parts[0], info]


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


def refusal(sentence: str) -> Exception:
    """The error to raise where options make no sense."""
    from seacage.conventions import InputError

    return InputError(sentence)


def exit_with(sentence: str, code: Exit) -> typer.Exit:
    """Say a sentence on stderr and return the exit to raise."""
    typer.echo(f"seacage: {sentence}", err=True)
    return typer.Exit(code)


def wants_json() -> bool:
    """Whether ``--json`` was given to the command that runs."""
    return _wants_json.get()


def report(answer: Mapping[str, object], *, rows: Sequence[tuple[str, object]] = ()) -> None:
    """Print a command's answer.

    ``answer``: what a program gets with ``--json``; NaN becomes null, a dataclass an object, and
    what else JSON does not have its text. ``rows``: what a person gets: names and values, in two
    columns.
    """
    if wants_json():
        typer.echo(json.dumps(without_nan(answer), default=str))
        return
    width = max((len(name) for name, _ in rows), default=0)
    for name, value in rows:
        typer.echo(f"{name:<{width}}  {value}")


def report_case(
    command: str, answer: Mapping[str, object], result: "np.ndarray", rows: list[tuple[str, str]]
) -> None:
    """Print one case's answer and how it ended, and fail where there is none to learn from."""
    from seacage.conventions import RESULTS, Result, has_answer

    code = Result(int(result))
    ended = f"{code.name.lower().replace('_', ' ')}: {RESULTS[code]}"
    report(answer, rows=([("Result", ended)] if code else []) + rows)
    if not has_answer(result):
        raise exit_with(f"{command}: {ended}.", Exit.FAILED)


def without_nan(value: object) -> object:
    """Turn numbers that JSON does not have into null, and dataclasses into mappings, anywhere."""
    if isinstance(value, float):
        return value if abs(value) < float("inf") else None
    if is_dataclass(value) and not isinstance(value, type):
        value = asdict(value)
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

    def __init__(self) -> None:
        self._began: dict[str, tuple[float, int]] = {}
        self._said = 0.0

    def __call__(self, stage: str, done: int, total: int) -> None:
        now = time.monotonic()
        if stage in self._began and done < total and now - self._said < _LINE_EVERY_S:
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


def report_findings(command: str, findings: Sequence[Finding], *, code: Exit) -> None:
    """Print what a command found, and end with a code where something is wrong."""
    wrong = [one for one in findings if one.state == "wrong"]
    report(
        {"ok": not wrong}
        | {"findings": [{"what": f.what, "state": f.state, "said": f.message} for f in findings]},
        rows=[(f"{one.state:<6}  {one.what}", one.message) for one in findings],
    )
    if wrong:
        raise exit_with(f"{command}: {len(wrong)} of {len(findings)} are wrong.", code)
