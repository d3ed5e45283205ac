"""Laws of the netting: drag and lift of a panel from its solidity and its angle to the flow."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import WATER_VISCOSITY, InputError, call_extension, load_extension

LAWS = ("aarsnes", "loland", "kristiansen-faltinsen")
"""The screen laws that come with seacage."""
MOVING_LAWS = (*LAWS, "morison")
"""Laws of a net that moves: "morison" loads it twine by twine."""

CasePanel = Float[np.ndarray, "case panel"]
PerPanel = Float[np.ndarray, "*case panel"]
PerCase = Float[np.ndarray, " case"]

# Drag coefficient of a smooth cylinder: coefficients of powers of log10 Re, from 0 up. Goldstein
# (1965) as fitted by Kristiansen & Faltinsen (2012), for 10^1.5 <= Re <= 10^4.
CYLINDER = (-78.46675, 254.73873, -327.8864, 223.64577, -87.92234, 20.00769, -2.44894, 0.12479)

REYNOLDS_RANGE = (32.0, 1.0e4)
# C_D of a panel along the flow by each law as published [-]
SKIN_FRICTION = {"aarsnes": 0.04, "loland": 0.04, "kristiansen-faltinsen": 0.0}

Values = float | Float[np.ndarray, "*#n"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ScreenLaw:
    """Screen law of one's own, for ``settle`` and ``simulate`` or for an entry point.

    C_D = s (1 − cosθ) + C_D0 ((1 − h) cosθ + h cos3θ), at least 0, and
    C_L = C_L0 sin2θ (1 + e cos2θ), θ being the angle between a panel's normal and the flow.
    """

    title: str  # its authors and the year, for messages
    # C_D0, at least 0, and C_L0 of solidities [-]: arrays of the same shape
    coefficients: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    skin_friction: float = 0.0  # s, the C_D of a panel along the flow [-]
    # h and e, the shares of drag and lift that vary with cos3θ and cos2θ [-]
    third: float = 0.0
    second: float = 0.0

    def facing(self, solidity: PerPanel) -> tuple[PerPanel, PerPanel]:
        """C_D0 and C_L0 of each panel [-]. Raises InputError: the law gives no sound numbers."""
        drag, lift = call_extension(
            f"screen law {self.title!r}", self.coefficients, solidity.copy()
        )
        least = min(float(np.min(drag)), self.skin_friction)
        if not (np.isfinite(drag + lift + self.third + self.second).all() and least >= 0.0):
            raise InputError(
                f"Screen law {self.title!r}: solidities of {solidity.min():g} to "
                f"{solidity.max():g} give a drag down to {least:g} and a lift down to "
                f"{np.min(lift):g}; they must be finite and drag at least 0. Use another law."
            )
        return drag, lift


Law = str | ScreenLaw
"""Law of the netting: the name of one of ours or of an installed one, or a ``ScreenLaw``."""


def own_law(law: Law, *, ours: tuple[str, ...] = MOVING_LAWS) -> ScreenLaw | None:
    """A law that is not ours, loaded by its name; None for one of ours.

    Raises InputError: a name that is neither ours nor installed, or no law behind it.
    """
    if isinstance(law, ScreenLaw):
        return law
    return None if law in ours else load_extension("screen_laws", law, ScreenLaw, ours).value


def law_label(law: str) -> str:
    """A law's name for a record, with its package and version where it is not ours."""
    if own_law(law) is None:
        return law
    return f"{law} ({load_extension('screen_laws', law, ScreenLaw, MOVING_LAWS).source})"


@dataclass(frozen=True, slots=True, kw_only=True)
class Tuning:
    """Changes to a screen law as published, for what measurements part on.

    Source: Aarsnes, Rudi & Løland (1990); Løland (1991). Xu et al. (2020) quote 0.3 of the facing
    panel's drag along the flow, which is 0.08 to 0.1 for a solidity of 0.21. Lift: Lee et al.
    (2005), Bi et al. (2014), Tang et al. (2018).
    """

    # C_D of a panel along the flow; falls as 1 − cosθ, so that a facing panel keeps its drag [-].
    # None takes the law's own: 0.04 of Aarsnes' and of Løland's, from towed panels, 0 of
    # Kristiansen and Faltinsen's, which knows cross-flow on twines alone.
    skin_friction: float | None = None
    # On C_L [-]. Fits to flume tests have C_L/C_D(0) of 0.25 to 0.43 at 30° to 60°, the laws 0.11
    # to 0.24.
    lift_factor: float = 1.0

    def __post_init__(self) -> None:
        skin = 0.0 if self.skin_friction is None else self.skin_friction
        for name, value in (("skin_friction", skin), ("lift_factor", self.lift_factor)):
            if not 0.0 <= value < np.inf:
                raise InputError(
                    f"Net law: {name} = {value:g} must be a finite number of at least 0. Leave it "
                    "out for the law as published."
                )


# Current above which Kristiansen and Faltinsen's law is warned of [m/s]. On the reference cage
# Aarsnes' and Løland's give 1.6 times its load at 1 m/s, 1.9 times at 1.25 and 2.4 times at 2.
FASTEST = 1.2

AS_PUBLISHED = Tuning()  # no change


def aarsnes(solidity: Values, cos_theta: Values) -> tuple[Values, Values]:
    """Drag and lift coefficients after Aarsnes.

    ``solidity``: projected twine area over panel area [-].
    ``cos_theta``: cosine of the angle between the panel's normal and the flow, in [0, 1].

    Returns C_D and C_L on the panel's whole area [-]; lift is along (u × n) × u.

    Source: Aarsnes, Rudi & Løland (1990).
    """
    slope, lift = _aarsnes_terms(solidity)
    return 0.04 + slope * cos_theta, lift * _sin_twice(cos_theta)


def loland(solidity: Values, cos_theta: Values) -> tuple[Values, Values]:
    """Drag and lift coefficients after Løland; arguments as in ``aarsnes``.

    Source: Løland (1991).
    """
    slope, lift = _loland_terms(solidity)
    return 0.04 + slope * cos_theta, lift * _sin_twice(cos_theta)


def kristiansen_faltinsen(
    solidity: Values, cos_theta: Values, reynolds: Values
) -> tuple[Values, Values]:
    """Drag and lift coefficients after Kristiansen and Faltinsen.

    ``solidity``, ``cos_theta``: as in ``aarsnes``.
    ``reynolds``: of a twine in the flow between the twines, d|u| / (nu (1 − Sn)); held in
    ``REYNOLDS_RANGE``, where the cylinder's fit ends.

    Returns C_D and C_L on the panel's whole area [-]; C_D is never negative.

    Source: Kristiansen & Faltinsen (2012), with the first two terms of their Fourier series.
    """
    cd0, cl0 = facing(solidity, cylinder_drag(reynolds))
    c = cos_theta
    # cos 3θ and sin 4θ without an arc cosine
    cd = np.maximum(cd0 * (0.9 * c + 0.1 * (4.0 * c**3 - 3.0 * c)), 0.0)
    cl = cl0 * _sin_twice(c) * (1.0 + 0.2 * (2.0 * c**2 - 1.0))
    return cd, cl


def cylinder_drag(reynolds: Values) -> Values:
    """Drag coefficient of a smooth cylinder, Reynolds number held in its range [-]."""
    logarithm = np.log10(np.clip(reynolds, *REYNOLDS_RANGE))
    return np.polynomial.polynomial.polyval(logarithm, np.array(CYLINDER))


def facing(solidity: Values, cylinder: Values) -> tuple[Values, Values]:
    """Kristiansen and Faltinsen's C_D0 (facing the flow) and C_L0 for a twine's drag [-]."""
    cd0 = cylinder * solidity * (2.0 - solidity) / (2.0 * (1.0 - solidity) ** 2)
    cn45 = cylinder * solidity / (2.0 * (1.0 - solidity) ** 2)
    return cd0, (0.5 * cd0 - np.pi * cn45 / (8.0 + cn45)) / np.sqrt(2.0)


def _aarsnes_terms(solidity: Values) -> tuple[Values, Values]:
    s = solidity
    return (
        -0.04 + s - 1.24 * s**2 + 13.7 * s**3,
        0.57 * s - 3.54 * s**2 + 10.1 * s**3,
    )


def _loland_terms(solidity: Values) -> tuple[Values, Values]:
    s = solidity
    return (
        -0.04 + 0.33 * s + 6.54 * s**2 - 4.88 * s**3,
        -0.05 * s + 2.3 * s**2 - 1.76 * s**3,
    )


def _sin_twice(cos_theta: Values) -> Values:
    return 2.0 * cos_theta * np.sqrt(np.maximum(1.0 - cos_theta**2, 0.0))


def law_of_each(law: Law | Sequence[Law], cases: int) -> tuple[Law, ...]:
    """The law of each case. Raises InputError: another number of laws than of cases."""
    if isinstance(law, str | ScreenLaw):
        return (law,) * cases
    if len(law) != cases:
        raise InputError(f"{len(law)} laws for {cases} seas. Give one for each, or one for all.")
    return tuple(law)


def check_laws(laws: Sequence[Law], tuning: Tuning) -> None:
    """Refuse laws of a moving net that are none, and changes where there is no screen law."""
    for law in laws:
        own_law(law)
    if tuning != AS_PUBLISHED and set(laws) == {"morison"}:
        raise InputError(
            "simulate: skin_friction and lift_factor change screen laws, and law 'morison' is "
            "none. Give twine_drag, whose second number is the skin friction along a twine."
        )


def beyond_law(laws: Sequence[Law], current_speed: PerCase) -> Bool[np.ndarray, " case"]:
    """Which cases meet a current [m/s] that their law is not known for."""
    theirs = np.array([law == "kristiansen-faltinsen" for law in laws])
    return theirs & (current_speed > FASTEST)


def law_warnings(laws: Sequence[Law], current_speed: PerCase) -> tuple[str, ...]:
    """What to know of the laws at the current's speeds [m/s], in sentences."""
    met = current_speed[[law == "kristiansen-faltinsen" for law in laws]]
    beyond = current_speed[beyond_law(laws, current_speed)]
    if len(beyond) == 0:
        return ()
    most = f"{beyond.max():.3g} m/s"
    which = (
        f"the current of {most} is"
        if len(met) == 1
        else f"{len(beyond)} of {len(met)} currents, up to {most}, are"
    )
    warning = (
        f"Law 'kristiansen-faltinsen': {which} above {FASTEST:g} m/s. There the laws of the "
        "netting part by a factor of 1.8 and more in its load, and this one, without skin "
        "friction, gives the least. Pass another law, or compare them all (seacage simulate --laws "
        "all)."
    )
    return (warning,)


@dataclass(frozen=True, slots=True, kw_only=True)
class Screen:
    """A screen law put to work on the panels of a net.

    Every law has the form C_D = max(0, a + b cosθ + h cos3θ), C_L = l sin2θ (1 + e cos2θ).
    The solidity fixes its numbers, and with Kristiansen and Faltinsen the speed too.
    """

    law: Law  # one of ``LAWS``, or one's own
    solidity: Float[np.ndarray, "*case panel"]  # of each panel [-]
    twine_diameter: Float[np.ndarray, "*case panel"]  # of each panel, grown [m]
    tuning: Tuning = AS_PUBLISHED  # what is changed of the law

    def __post_init__(self) -> None:
        own_law(self.law, ours=LAWS)

    @property
    def skin(self) -> float:
        """C_D of a panel along the flow [-]."""
        given = self.tuning.skin_friction
        return self._skin_as_published if given is None else given

    @property
    def _skin_as_published(self) -> float:
        own = own_law(self.law)
        return SKIN_FRICTION[str(self.law)] if own is None else own.skin_friction

    def terms(self, speed: CasePanel) -> dict[str, CasePanel]:
        """The law's a, b, h, l and e at known speeds [m/s], as ``SteadyFlow`` names them [-]."""
        if self.law == "kristiansen-faltinsen":
            twine_reynolds = self.twine_diameter / (WATER_VISCOSITY * (1.0 - self.solidity))
            cd0, cl0 = facing(self.solidity, cylinder_drag(twine_reynolds * speed))
            terms = (0.9 * cd0, 0.1 * cd0, cl0, 0.2)
        elif (own := own_law(self.law)) is not None:
            cd0, cl0 = own.facing(self.solidity)
            terms = ((1.0 - own.third) * cd0 - own.skin_friction, own.third * cd0, cl0, own.second)
        else:
            fixed = _aarsnes_terms if self.law == "aarsnes" else _loland_terms
            slope, lift = fixed(self.solidity)
            terms = (slope, 0.0, lift, 0.0)
        slope, third, lift, second = terms
        # what acts along the panel, as (1 − cosθ): a facing one bears what it did
        slope = slope + (self._skin_as_published - self.skin)
        terms = (self.skin, slope, third, self.tuning.lift_factor * lift, second)
        names = ("constant", "slope", "third", "lift", "lift_second")
        like = np.ones_like(speed)
        return {name: term * like for name, term in zip(names, terms, strict=True)}
