"""The problems that multifidelity learners are compared on."""

import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, read_packaged_table
from seacage.studies._benchmarks import _functions as functions

# Of the noise that lasts in time: its standard deviation over the truth's, and AR(1)
NOISE_SHARE, NOISE_CORRELATION = 0.1, 0.9


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
    # Of the noise from each case to the next; above 0 the learner gets the cases' times
    correlation: float = 0.0
    # The box is of speed and direction [rad], and learners get the vector (east, north)
    polar: bool = False
    nested: bool = False  # inputs of each fidelity are among those of the one below

    @property
    def recipe(self) -> str:
        """Sizes, low to high, in a few characters."""
        return " / ".join(str(size) for size in self.sizes) + ", nested" * self.nested

    def resized(self, sizes: tuple[int, ...], *, nested: bool = False) -> Self:
        """With other numbers of cases, under a name of its own."""
        name = "-".join([self.name, *map(str, sizes), *["nested"] * nested])
        return replace(self, name=name, sizes=sizes, nested=nested)

    def disturbed(self) -> Self:
        """With AR(1) noise, a tenth of the truth's standard deviation, on the highest fidelity."""
        noise = NOISE_SHARE * float(np.std(self.sample(0).y_test))
        name = f"{self.name}-in-time"
        return replace(self, name=name, noise=noise, correlation=NOISE_CORRELATION)

    def sample(self, seed: int) -> Sample:
        """A Latin hypercube for each fidelity and for the tests, each on its own.

        In a nested design the inputs of each fidelity then take the places of those nearest to
        them in the one below; else no input of a fidelity is among those of another.

        ``seed``: of all that is drawn; the problem's name joins it.
        """
        root = np.random.SeedSequence([seed, zlib.crc32(self.name.encode())])
        *draws, for_tests, for_noise = map(np.random.default_rng, root.spawn(len(self.sizes) + 2))
        inputs = [self._design(size, draw) for size, draw in zip(self.sizes, draws, strict=True)]
        for place in reversed(range(len(inputs) - 1) if self.nested else ()):
            inputs[place] = _nest(inputs[place], inputs[place + 1])
        outputs = [one(x) for one, x in zip(self.functions, inputs, strict=True)]
        noise = autoregressive_noise(self.sizes[-1], self.correlation, for_noise)
        outputs[-1] = outputs[-1] + self.noise * noise
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


def autoregressive_noise(
    cases: int, correlation: float, random: np.random.Generator
) -> Float[np.ndarray, "{cases}"]:
    """An AR(1) series of unit variance; ``correlation``: from each case to the next [-]."""
    from scipy.signal import lfilter

    shocks = random.standard_normal(cases)
    shocks[1:] *= np.sqrt(1.0 - correlation**2)
    return np.asarray(lfilter([1.0], [1.0, -correlation], shocks))


def _nest(
    low: Float[np.ndarray, "row feature"], high: Float[np.ndarray, "_ feature"]
) -> Float[np.ndarray, "row feature"]:
    """The low design with each case of the high one in place of one near it.

    Source: the idea of Le Gratiet & Garnier (2014); all places are chosen together here.
    """
    from scipy.optimize import linear_sum_assignment
    from scipy.spatial.distance import cdist

    unit = np.ptp(low, axis=0)
    rows, places = linear_sum_assignment(cdist(high / unit, low / unit))
    nested = low.copy()
    nested[places] = high[rows]
    return nested


_TABLES = read_packaged_table("seacage.studies._benchmarks", "problems.toml")


def _read() -> Iterator[Problem]:
    for table in _TABLES["problem"]:
        table["functions"] = [getattr(functions, name) for name in table["functions"]]
        given: dict[str, Any] = {k: tuple(v) if type(v) is list else v for k, v in table.items()}
        yield Problem(**given)


*PROBLEMS, CAGE_SIZE, FRANKE = _read()  # the published ones, one as large as a cage's, one more


def _read_pairs() -> Iterator[Problem]:
    base = {problem.name: problem for problem in (*PROBLEMS, FRANKE)}
    for pair in _TABLES["pairs"]:
        yield base[pair["of"]].resized(tuple(pair["sizes"]), nested=pair.get("nested", False))


PAIRS = (*PROBLEMS, *_read_pairs())  # published problems at their own sizes, and at others


def problem_named(name: str) -> Problem:
    """One of the published problems, at their own size or another, or ``cage-size``."""
    known: Sequence[Problem] = (*PAIRS, CAGE_SIZE)
    found = [problem for problem in known if problem.name == name]
    if not found:
        names = ", ".join(problem.name for problem in known)
        raise InputError(f"There is no benchmark problem {name!r}. Choose from {names}.")
    return found[0]
