"""The methods that are compared: ours, simple baselines, and peers in an environment of theirs."""

import hashlib
import re
import sys
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from seacage.conventions import InputError, read_packaged_table
from seacage.surrogates import AR1, NARGP, GaussianProcess, ModelAverage

_FOLDER = Path(__file__).parent
HARNESS = _FOLDER / "_harness.py"  # the script that fits and times, for any interpreter
OURS = "nargp"  # the method that the verdicts are about
EMUKIT, SMT, HIGH_ONLY = "emukit-nargp", "smt-mfk", "high-only"  # those that it is held against


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """How one method is run."""

    # For files; for tables
    name: str
    title: str
    maker: str  # the package that it is from
    settings: str  # what it is given beyond the package's defaults, for the page
    # Interpreter and script, as the harness takes them
    python: Path
    script: Path

    @property
    def ours(self) -> bool:
        """Whether it is seacage's own."""
        return self.maker == "seacage"

    def key(self) -> str:
        """A hash of the code that makes its answers."""
        digest = hashlib.sha256(HARNESS.read_bytes())
        theirs = [self.script.parent / name for name in ("scaling.py", "requirements.lock")]
        for path in (self.script, *(_learners() if self.ours else theirs)):
            digest.update(path.read_bytes())
        return digest.hexdigest()[:10]


def own_methods() -> tuple[Method, ...]:
    """Ours and the baselines, run by the interpreter that runs this."""
    python, script = Path(sys.executable), _FOLDER / "_ours.py"
    own = _methods_of("own")
    return tuple(Method(maker="seacage", python=python, script=script, **one) for one in own)


def peer_methods(environment: str | Path) -> tuple[Method, ...]:
    """The peers of the environment that ``make bench-peers`` made.

    Raises InputError: there is no such environment, or no link to the scripts in it.
    """
    python = Path(environment) / "bin" / "python"
    scripts = Path(environment) / "scripts"
    if not python.exists() or not (scripts / "scaling.py").is_file():
        raise InputError(
            f"study benchmarks: {environment} is no environment of peers: it lacks bin/python or "
            "scripts. Make one with `make bench-peers`."
        )
    # Not resolved: the link itself is what makes it this environment's interpreter.
    python, folder = python.absolute(), scripts.resolve()
    return tuple(
        Method(python=python, script=folder / script, **one)
        for one in _methods_of("peer")
        for script in (one.pop("script"),)
    )


def _methods_of(kind: str) -> list[dict[str, Any]]:
    return read_packaged_table("seacage.studies._benchmarks", "methods.toml")[kind]


@cache  # what this process runs is what it has loaded, whatever is edited meanwhile
def _learners() -> tuple[Path, ...]:
    """The files of the surrogates that our methods reach, so that no other counts."""
    reached: dict[str, Path] = {}
    ahead = {one.__module__ for one in (AR1, NARGP, GaussianProcess, ModelAverage)}
    while ahead:
        module = ahead.pop()
        reached[module] = _source(module)
        text = reached[module].read_text("utf-8")
        found = re.findall(r"from (seacage\.surrogates(?:\.[\w.]+| import _\w+))", text)
        ahead |= {one.replace(" import ", ".") for one in found} - set(reached)
    return tuple(path for _, path in sorted(reached.items()))


def _source(module: str) -> Path:
    """File of a module of seacage: that of a package is its door."""
    path = Path(str(resources.files("seacage"))).joinpath(*module.split(".")[1:])
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
