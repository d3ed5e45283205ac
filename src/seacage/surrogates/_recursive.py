"""Linear autoregressive co-kriging: each fidelity is a constant times the one below, and more."""

from dataclasses import dataclass

from seacage.surrogates._autoregressive import LinkKernel, StraightKernel
from seacage.surrogates._nargp import AbstractMultifidelity


@dataclass(frozen=True, slots=True, kw_only=True)
class AR1(AbstractMultifidelity):
    """Linear autoregressive multifidelity regression, not yet fitted; any number of levels.

    f_t(x) = rho_t f_{t-1}(x) + delta_t(x), with a constant rho_t of its own for each level: a
    baseline to compare ``NARGP`` with. Levels are learned one after the other at the mean of
    the level below, and rho_t is integrated out. The fitted model is that of ``NARGP``.

    Parameters
    ----------
    noise, ensemble, restarts
        As for ``NARGP``.

    References
    ----------
    Kennedy & O'Hagan (2000), "Predicting the output from a complex computer code when fast
    approximations are available", Biometrika 87:1-13; Le Gratiet & Garnier (2014), Int. J.
    Uncertainty Quantification 4:365-386, for the recursion.
    """

    def link(self, lengths: tuple[float, ...], *, alike: bool) -> LinkKernel:  # noqa: ARG002
        return StraightKernel()
