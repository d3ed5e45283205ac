"""The problems that multifidelity learners are compared on."""

import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, read_packaged_table
from seacage.studies._benchmarks import _functions as functions


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Sample:
    """Training and test cases of a problem."""

    # Inputs (n, features) and outputs (n,) of each fidelity, from low to high
    levels: tuple[tuple[Float[np.ndarray, "_ _"], Float[np.ndarray, " _"]], ...]
    # Where the highest fidelity is asked for, and its answer without noise
    x_test: Float[np.ndarray, "row feature"]
    y_test: Float[np.ndarray, " row"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Problem:
    """Functions of rising fidelity on a box, and how many cases of each a learner gets."""

    # For files and commands; for tables
    name: str
    title: str
    source: str  # where functions and sizes are from
    # Ends of the box, in the units of the source
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    # From low to high fidelity; (row, feature) to (row,)
    functions: tuple[Callable[[functions.Rows], functions.Answers], ...]
    sizes: tuple[int, ...]  # training cases of each fidelity
    noise: float = 0.0  # standard deviation of the noise on the highest fidelity's training cases
    tests: int = 1000  # number of test points
    # The box is of speed and direction [rad], and learners get the vector (east, north)
    polar: bool = False

    @property
    def recipe(self) -> str:
        """Sizes, low to high, in a few characters."""
        return " / ".join(str(size) for size in self.sizes)

    def sample(self, seed: int) -> Sample:
        """A Latin hypercube for each fidelity and for the tests, each on its own.

        The designs are not nested: no input of a fidelity is among those of another.

        ``seed``: of all that is drawn; the problem's name joins it.
        """
        root = np.random.SeedSequence([seed, zlib.crc32(self.name.encode())])
        *draws, for_tests, for_noise = map(np.random.default_rng, root.spawn(len(self.sizes) + 2))
        inputs = [self._design(size, draw) for size, draw in zip(self.sizes, draws, strict=True)]
        outputs = [one(x) for one, x in zip(self.functions, inputs, strict=True)]
        outputs[-1] = outputs[-1] + self.noise * for_noise.standard_normal(self.sizes[-1])
        x_test = self._design(self.tests, for_tests)
        return Sample(
            levels=tuple(zip(inputs, outputs, strict=True)),
            x_test=x_test,
            y_test=self.functions[-1](x_test),
        )

    def _design(
        self, size: int, random: np.random.Generator
    ) -> Float[np.ndarray, "{size} feature"]:
        from scipy.stats import qmc

        unit = qmc.LatinHypercube(len(self.lower), rng=random).random(size)
        x = qmc.scale(unit, self.lower, self.upper)
        if not self.polar:
            return x
        speed, angle = x.T
        return np.column_stack([speed * np.cos(angle), speed * np.sin(angle)])


def _read() -> Iterator[Problem]:
    for table in read_packaged_table("seacage.studies._benchmarks", "problems.toml")["problem"]:
        table["functions"] = [getattr(functions, name) for name in table["functions"]]
        given: dict[str, Any] = {k: tuple(v) if type(v) is list else v for k, v in table.items()}
        yield Problem(**given)


*PROBLEMS, CAGE_SIZE = _read()  # the published ones, and one as large as a cage's


def problem_named(name: str) -> Problem:
    """One of the published problems, or ``cage-size``."""
    known: Sequence[Problem] = (*PROBLEMS, CAGE_SIZE)
    found = [problem for problem in known if problem.name == name]
    if not found:
        names = ", ".join(problem.name for problem in known)
        raise InputError(f"There is no benchmark problem {name!r}. Choose from {names}.")
    return found[0]
