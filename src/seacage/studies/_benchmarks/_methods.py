"""The methods that are compared: ours, simple baselines, and peers in an environment of theirs."""

import hashlib
import re
import sys
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path

from seacage.conventions import InputError
from seacage.surrogates import AR1, NARGP, GaussianProcess

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
        digest = hashlib.sha256(harness().read_bytes())
        theirs = [self.script.parent / name for name in ("scaling.py", "requirements.lock")]
        for path in (self.script, *(_learners() if self.ours else theirs)):
            digest.update(path.read_bytes())
        return digest.hexdigest()[:10]


def harness() -> Path:
    """The script that fits and times, for any interpreter."""
    return _own("_harness.py")


def own_methods() -> tuple[Method, ...]:
    """Ours and the baselines, run by the interpreter that runs this."""
    rows = (
        (OURS, "NARGP", "as it comes"),
        ("nargp-published", "NARGP, published kernel", "without the linear term"),
        ("ar1", "AR1", "each level is a constant times the one below, plus a Gaussian process"),
        (HIGH_ONLY, "High fidelity only", "a Gaussian process of the highest fidelity alone"),
    )
    return tuple(
        Method(
            name=name,
            title=title,
            maker="seacage",
            settings=settings,
            python=Path(sys.executable),
            script=_own("_ours.py"),
        )
        for name, title, settings in rows
    )


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
    return tuple(
        Method(
            name=name,
            title=title,
            maker=maker,
            settings=settings,
            # Not resolved: the link itself is what makes it this environment's interpreter.
            python=python.absolute(),
            script=scripts.resolve() / script,
        )
        for name, title, maker, settings, script in _PEERS
    )


_PEERS = (
    (
        EMUKIT,
        "Emukit NARGP",
        "emukit",
        (
            "on GPy; squared exponentials with a length per input, 10 restarts, 100 samples of the "
            "level below; inputs and outputs standardised before, as GPy scales nothing"
        ),
        "emukit_nargp.py",
    ),
    (
        SMT,
        "SMT MFK",
        "smt",
        (
            "defaults: squared exponentials, constant trend and ratio, 10 starts; noise is learned "
            "where there is some"
        ),
        "smt_mfk.py",
    ),
    (
        "botorch-multifidelity",
        "BoTorch multifidelity",
        "botorch",
        (
            "SingleTaskMultiFidelityGP, linear truncated kernel, fidelities from 0.5 to 1, inputs "
            "in the unit box, standardised outputs"
        ),
        "botorch_gp.py",
    ),
    (
        "botorch-multitask",
        "BoTorch multi-task",
        "botorch",
        "MultiTaskGP, a task per fidelity, inputs in the unit box, outputs standardised by task",
        "botorch_gp.py",
    ),
    (
        "sklearn-stacked",
        "scikit-learn, stacked",
        "scikit-learn",
        (
            "a process per level on the mean of the one below; squared exponential with a length "
            "per input and white noise, 3 restarts, standardised inputs and outputs"
        ),
        "sklearn_stacked.py",
    ),
)
"""Name, title, maker, settings and script."""


@cache  # what this process runs is what it has loaded, whatever is edited meanwhile
def _learners() -> tuple[Path, ...]:
    """The files of the surrogates that our methods reach, so that no other counts."""
    reached: dict[str, Path] = {}
    ahead = {one.__module__ for one in (AR1, NARGP, GaussianProcess)}
    while ahead:
        module = ahead.pop()
        reached[module] = _source(module)
        text = reached[module].read_text("utf-8")
        ahead |= set(re.findall(r"from (seacage\.surrogates\.[\w.]+) import", text)) - set(reached)
    return tuple(path for _, path in sorted(reached.items()))


def _source(module: str) -> Path:
    """File of a module of seacage: that of a package is its door."""
    path = Path(str(resources.files("seacage"))).joinpath(*module.split(".")[1:])
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def _own(name: str) -> Path:
    return Path(str(resources.files("seacage.studies._benchmarks") / name))
