"""The problems that multifidelity learners are compared on."""

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.studies._benchmarks import _functions as functions

SIZES_SOURCE = "sizes and designs of Cutajar et al. (2019), arXiv:1903.07320"


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


PROBLEMS = (
    Problem(
        name="pedagogical",
        title="Pedagogical",
        source="Perdikaris et al. (2017), section 3(a): functions and sizes",
        lower=(0.0,),
        upper=(1.0,),
        functions=(functions.pedagogical_low, functions.pedagogical_high),
        sizes=(50, 14),
    ),
    Problem(
        name="branin-3",
        title="Branin, 3 levels",
        source=f"Perdikaris et al. (2017), section 3(b); {SIZES_SOURCE}",
        lower=(-5.0, 0.0),
        upper=(10.0, 15.0),
        functions=(functions.branin_low, functions.branin_middle, functions.branin_high),
        sizes=(80, 30, 10),
    ),
    Problem(
        name="currin",
        title="Currin",
        source=f"Currin et al. (1988); Xiong, Qian & Wu (2013); {SIZES_SOURCE}",
        lower=(0.0,) * 2,
        upper=(1.0,) * 2,
        functions=(functions.currin_low, functions.currin_high),
        sizes=(12, 5),
    ),
    Problem(
        name="park",
        title="Park",
        source=f"Park (1991); Xiong, Qian & Wu (2013); {SIZES_SOURCE}",
        lower=(0.0,) * 4,
        upper=(1.0,) * 4,
        functions=(functions.park_low, functions.park_high),
        sizes=(30, 5),
    ),
    Problem(
        name="borehole",
        title="Borehole",
        source="Morris, Mitchell & Ylvisaker (1993); Xiong, Qian & Wu (2013); "
        f"{SIZES_SOURCE}, without its noise",
        lower=(0.05, 100.0, 63070.0, 990.0, 63.1, 700.0, 1120.0, 9855.0),
        upper=(0.15, 50000.0, 115600.0, 1110.0, 116.0, 820.0, 1680.0, 12045.0),
        functions=(functions.borehole_low, functions.borehole_high),
        sizes=(60, 5),
    ),
    Problem(
        name="hartmann-3",
        title="Hartmann-3, 3 levels",
        source=f"Hartmann (1973); {SIZES_SOURCE}",
        lower=(0.0,) * 3,
        upper=(1.0,) * 3,
        functions=(functions.hartmann_low, functions.hartmann_middle, functions.hartmann_high),
        sizes=(80, 40, 20),
    ),
)
"""The published ones."""

CAGE_SIZE = Problem(
    name="cage-size",
    title="Cage size",
    source="Made here: formulas for a bridle's tension [kN] as large as a cage's training set",
    lower=(0.0, 0.0),
    upper=(1.0, 2.0 * np.pi),
    functions=(functions.cage_low, functions.cage_high),
    sizes=(1000, 300),
    noise=0.8,
    tests=2000,
    polar=True,
)
"""As many cases as a twin learns a sensor from, the few of them noisy."""


def problem_named(name: str) -> Problem:
    """One of the published problems, or ``cage-size``."""
    known: Sequence[Problem] = (*PROBLEMS, CAGE_SIZE)
    found = [problem for problem in known if problem.name == name]
    if not found:
        names = ", ".join(problem.name for problem in known)
        raise InputError(f"There is no benchmark problem {name!r}. Choose from {names}.")
    return found[0]
