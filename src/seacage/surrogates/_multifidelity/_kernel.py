"""Covariance functions of a fidelity over its inputs and the fidelity below."""

import math
from dataclasses import dataclass

import numpy as np

from seacage.surrogates import _gp

BELL = "squared-exponential"
LOCAL, BELOW = slice(None, -1), slice(-1, None)  # columns of the features, and of the level below
RANGE = 3.5  # spreads that the level below goes through, about
# Mean and sd of a log variance, the outputs having unit variance. With a held bend rho's is that of
# a slope: the same at the link's median length of 6 spreads.
RHO_SLOPE = (-3.6, 4.0)
DELTA_VARIANCE = (-5.5, 3.0)
# Mean and sd of a log length in spreads, for one feature
RHO_LENGTH = (math.log(8.0), 1.1)
DELTA_LENGTH = (math.log(3.0), 1.1)
LINK_LENGTH = (math.log(6.0), 0.9)
# Mean and sd of the line's log variance about a ratio of 1, in spreads of both levels
ALIKE_LINE = (-4.0, 2.0)
# Mean and sd of the log variance of a line in the inputs, in their spreads
TREND = (-6.0, 1.0)
# Mean and sd of delta's log length less that of the lowest level, where that is known and short. A
# level that turns fast with a feature leaves something that does so too. One that hardly follows a
# feature may do so wrongly: of the remainder there, a long length says nothing.
KNOWN_LENGTH = (0.2, 0.5)
# A log length of the lowest level counts as known only so far below delta's general one
STRANGE = 2.5
MANY = 20  # from so many cases on priors may be broad, as functions that are sums need
# Second curve where there is no level below: larger, and smoother than the first
SMOOTH = _gp.StationaryKernel(BELL, variance=(3.0, 4.0), length=(math.log(12.0), 1.5))
# Of the published kernel: any smooth curve of the level below, and rho
FREE = _gp.StationaryKernel(BELL, variance=None, length=LINK_LENGTH)
RHO = _gp.StationaryKernel(BELL, variance=(0.0, 4.0), length=RHO_LENGTH)
# Curve of the level below, rho and delta with broad priors (decision 111): where a function is a
# polynomial its length is many spreads, and its variance large to match. Shorter lengths over the
# level below need thousands of quadrature nodes.
BROAD = (
    _gp.StationaryKernel(BELL, variance=None, length=(math.log(10.0), 1.1)),
    _gp.StationaryKernel(BELL, variance=(2.0, 5.0), length=(math.log(20.0), 3.0)),
    _gp.StationaryKernel(BELL, variance=(2.0, 5.0), length=(math.log(5.0), 3.0)),
)


@dataclass(frozen=True, slots=True)
class HeldBend(_gp.AbstractKernel):
    """A smooth curve held to nothing at the mean of the level below, and an offset.

    l^2 (k(f, f') - k(f, 0) k(0, f')) + RANGE^2, k the squared exponential of length l: the curve
    given that it is nothing at f = 0. There its slope has unit variance whatever the length, and
    the offset a deviation as large as such a slope makes over the range of the level below. In
    a product with a function of the inputs, slope, bend and offset change over the inputs, and
    a longer length straightens the curve without making its slope or the offset smaller.

    Source: Rasmussen & Williams (2006), eq. (2.19), for a process that is known at a point.
    """

    def prior(self, width: int) -> _gp.Prior:
        return FREE.prior(width)

    def size(self, width: int) -> int:
        return FREE.size(width)

    def at(self, log_parameters: np.ndarray, z: np.ndarray) -> _gp.Covariances:
        square = np.exp(2.0 * log_parameters)
        free_at, z_to_mean = FREE.at(log_parameters, z), _to_mean(z, square)

        def evaluate(x: np.ndarray) -> _gp.Evaluation:
            free, to_mean = free_at(x), _to_mean(x, square)
            value = to_mean[..., None] * z_to_mean[..., None, :]
            np.subtract(free.value, value, out=value)
            value *= square[..., None]
            value += RANGE**2

            def slope(share: np.ndarray) -> np.ndarray:
                return square * free.slope(share) + x * (to_mean * (share @ z_to_mean))[:, None]

            def pull(adjoint: np.ndarray) -> np.ndarray:
                far = x[:, 0] ** 2
                # The part that is known at the mean, summed over the symmetric pairs.
                of_known = 2.0 * (far * to_mean) @ adjoint @ to_mean
                of_square = 2.0 * np.sum(adjoint * (value - RANGE**2))
                return square * free.pull(adjoint) + of_square - of_known

            return _gp.Evaluation(value, slope, pull)

        return evaluate

    def diagonal(self, log_parameters: np.ndarray, x: np.ndarray) -> _gp.Evaluation:
        square = np.exp(2.0 * log_parameters)
        known = _to_mean(x, square) ** 2
        return _gp.Evaluation(
            square * (1.0 - known) + RANGE**2, lambda share: 2.0 * x * (share * known)[:, None]
        )


@dataclass(frozen=True, slots=True)
class LinearKernel(_gp.AbstractKernel):
    """s (offset + x x'): a straight line through 0, or at random height."""

    offset: float = 0.0  # variance at 0, as a share of that of the slope
    variance: _gp.Normal = _gp.VARIANCE_PRIOR  # prior of s

    def prior(self, width: int) -> _gp.Prior:  # noqa: ARG002
        return _gp.Prior.of(self.variance)

    def size(self, width: int) -> int:  # noqa: ARG002
        return 1

    def at(self, log_parameters: np.ndarray, z: np.ndarray) -> _gp.Covariances:
        variance = np.exp(log_parameters)[..., None]
        scaled_z = variance * z

        def evaluate(x: np.ndarray) -> _gp.Evaluation:
            value = x @ np.swapaxes(scaled_z, -1, -2)
            value += self.offset * variance
            return _gp.Evaluation(
                value,
                lambda share: np.broadcast_to(share @ scaled_z, x.shape),
                lambda adjoint: np.sum(adjoint * value),
            )

        return evaluate

    def diagonal(self, log_parameters: np.ndarray, x: np.ndarray) -> _gp.Evaluation:
        variance = np.exp(log_parameters)
        return _gp.Evaluation(
            variance * (self.offset + np.sum(x**2, axis=-1)),
            lambda share: 2.0 * variance * x * share[:, None],
        )


@dataclass(frozen=True, slots=True)
class LinkKernel(_gp.Sum):
    """Covariance of a level over (x, f), f being the level below: the last feature."""

    ratio: float = 0.0  # expected change of the level per change of the one below
    # Whether the level bends with the one below, over a length that comes first after rho's
    # hyperparameters
    bends: bool = True


def autoregressive(*, lengths: tuple[float, ...] = (), broad: bool = False) -> LinkKernel:
    """The NARGP's covariance as published: k_rho(x, x') k_f(f, f') + k_delta(x, x').

    Each is a squared exponential with ARD. Hyperparameters, in logarithms: rho's variance and
    lengths, f's length, delta's variance and lengths.

    ``lengths``: as for ``line_and_bend``. ``broad``: whether the priors are; known lengths do not
    shape these.

    Source: Perdikaris et al. (2017), eq. (2.14).
    """
    link, rho, delta = BROAD if broad else (FREE, RHO, _delta(lengths))
    curve = _gp.Columns(rho, LOCAL) * _gp.Columns(link, BELOW)
    return LinkKernel(curve, _gp.Columns(delta, LOCAL), "autoregressive")


def line_and_bend(
    *,
    # Log lengths of the lowest level, in spreads of the inputs; empty where they are not known.
    # They shape the prior alone.
    lengths: tuple[float, ...] = (),
    # Whether the level below explains most of this one as it is: the line is then about a ratio of
    # 1, in the units of the levels, and not about 0
    alike: bool = False,
) -> LinkKernel:
    """That of ``autoregressive`` with a line s (1 + f f') beside it.

    k_f is a ``HeldBend``, so that its product with k_rho is what bends about the line, the same
    everywhere, that s stands for. Hyperparameters: those of ``autoregressive``, then s.

    The priors expect the level above to be near a line in the level below, to bend smoothly
    about it, with a bend that hardly changes over the inputs, and to leave little else, which
    varies over the inputs about as fast as the lowest level does where that is fast.
    """
    rho = _gp.StationaryKernel(BELL, variance=RHO_SLOPE, length=RHO_LENGTH)
    curve = _gp.Columns(rho, LOCAL) * _gp.Columns(HeldBend(), BELOW)
    line = LinearKernel(offset=1.0, variance=ALIKE_LINE if alike else _gp.VARIANCE_PRIOR)
    return LinkKernel(
        curve + _gp.Columns(_delta(lengths), LOCAL),
        _gp.Columns(line, BELOW),
        "line-and-bend",
        ratio=float(alike),
    )


def straight() -> LinkKernel:
    """Constant ratio to the level below, and what it leaves: s f f' + k_delta(x, x').

    Hyperparameters, in logarithms: s, then delta's variance and lengths. A ratio of any size and
    sign is expected.

    Source: Kennedy & O'Hagan (2000), Biometrika 87:1-13, eq. (1), the ratio being integrated out
    under a Gaussian prior; one level at a time as in Le Gratiet & Garnier (2014).
    """
    line, rest = _gp.Columns(LinearKernel(), BELOW), _gp.Columns(_gp.StationaryKernel(BELL), LOCAL)
    return LinkKernel(line, rest, "straight", bends=False)


def regression() -> LinkKernel:
    """Lines in the level below and in the inputs: s (1 + f f') + t (1 + x x').

    Bayesian linear regression on both, as a spreadsheet would do it.
    """
    line, trend = LinearKernel(offset=1.0), LinearKernel(offset=1.0, variance=TREND)
    return LinkKernel(
        _gp.Columns(trend, LOCAL), _gp.Columns(line, BELOW), "regression", bends=False
    )


def alone(*, broad: bool = False) -> LinkKernel:
    """The inputs alone: k(x, x') + t (1 + x x'), without the level below.

    ``broad``: with a second curve, larger and smoother, for functions that are a sum, such as of
    a polynomial and of a curve in one input.
    """
    curve: _gp.AbstractKernel = _gp.StationaryKernel(BELL)
    if broad:
        curve += SMOOTH
    trend = _gp.Columns(LinearKernel(offset=1.0, variance=TREND), LOCAL)
    label = "curves-alone" if broad else "alone"
    return LinkKernel(_gp.Columns(curve, LOCAL), trend, label, bends=False)


def bend_of(level: _gp.FittedGaussianProcess) -> float:
    """Least length over which a level bends with the one below, in that one's unit."""
    width = len(level.inputs.centre)
    lengths = [
        member.log_parameters[width]
        for member in level.members
        if isinstance(member.kernel, LinkKernel) and member.kernel.bends
    ]
    return math.exp(min(lengths, default=math.inf)) * float(level.inputs.unit[-1])


def _to_mean(x: np.ndarray, square: np.ndarray) -> np.ndarray:
    """Correlation of each value with the mean of the level below, which is 0."""
    return np.exp(-0.5 * x[..., 0] ** 2 / square)


def _delta(lengths: tuple[float, ...]) -> _gp.StationaryKernel:
    """What a level leaves, given the log lengths of the lowest level."""
    # Distances grow with the root of the number of features.
    general = DELTA_LENGTH[0] + 0.5 * math.log(max(len(lengths), 1)), DELTA_LENGTH[1]
    shift, sd = KNOWN_LENGTH
    expected = [max(known, general[0] - STRANGE) + shift for known in lengths]
    each = tuple((one, sd) if one < general[0] else general for one in expected)
    return _gp.StationaryKernel(BELL, variance=DELTA_VARIANCE, length=DELTA_LENGTH, lengths=each)


_gp.register_kernels(
    line_and_bend(), autoregressive(), straight(), regression(), alone(), alone(broad=True)
)
