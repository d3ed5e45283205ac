"""What every screen law promises, whoever wrote it."""

import numpy as np

from seacage.cage import Cage
from seacage.dynamics import ScreenLaw, settle, simulate
from seacage.ocean import SeaState

SOLIDITY = np.linspace(0.05, 0.7, 27)
ANGLE = np.radians(np.linspace(0.0, 90.0, 91))


def check_screen_law(law: ScreenLaw) -> None:
    """Hold a screen law to what the solvers rely on; an assertion names the first broken promise.

    Its numbers are sound for solidities of 0.05 to 0.7 and all angles, and a cage comes to rest
    by it in a current of 0.5 m/s, at the same place in the equilibrium as in time.
    """
    drag, lift = _check_numbers(law)
    cosine, s = np.cos(ANGLE), law.skin_friction
    along_third = (1.0 - law.third) * cosine + law.third * np.cos(3.0 * ANGLE)
    each = s * (1.0 - cosine) + drag[:, None] * along_third
    assert (each >= -1e-9).all(), "C_D falls below 0 at an angle, where the solvers would cut it"
    # published laws are no better than their fits below a solidity of 0.1
    assert (drag >= s)[SOLIDITY >= 0.1].all(), "C_D0 is less than the C_D along the flow"
    assert (np.diff(drag) >= 0.0).all(), "C_D of a facing panel falls as the solidity rises"
    sideways = np.sin(2.0 * ANGLE) * (1.0 + law.second * np.cos(2.0 * ANGLE))
    assert (np.abs(lift[:, None] * sideways) <= drag[:, None]).all(), "C_L is larger than C_D0"
    _check_in_a_cage(law)


def _check_numbers(law: ScreenLaw) -> tuple[np.ndarray, np.ndarray]:
    given = SOLIDITY.copy()
    drag, lift = law.coefficients(given)
    np.testing.assert_array_equal(given, SOLIDITY, err_msg="it writes into the solidities")
    for name, values in (("C_D0", drag), ("C_L0", lift)):
        assert values.shape == SOLIDITY.shape, f"{name} has shape {values.shape}, not one each"
        assert np.isfinite(values).all(), f"{name} is not finite everywhere"
    for one in SOLIDITY:  # of one panel in two cases
        cases = np.stack(law.coefficients(np.full((2, 1), one)))
        assert cases.shape == (2, 2, 1), "solidities of several cases lose their shape"
        same = np.stack([drag, lift])[:, one == SOLIDITY][:, None].repeat(2, axis=1)
        np.testing.assert_allclose(cases, same, rtol=1e-9, err_msg="it depends on neighbours")
    return law.facing(SOLIDITY)


def _check_in_a_cage(law: ScreenLaw) -> None:
    cage = Cage.named("ace").altered(mesh={"spokes": 8})
    sea = SeaState(current_speed=0.5, current_to=200.0)
    settled, still = settle(cage, sea, law=law), sea.current_velocity
    assert settled.result == 0, "a cage does not come to rest by it in 0.5 m/s"
    assert settled.net_force[:2] @ still > 0.0, "the current does not push the net along"
    moved = simulate(cage, sea, law=law, duration=10.0, spin_up=30.0, ramp=10.0)
    # it starts from the equilibrium, about which a net on its mooring may sway by centimetres
    away = np.abs(moved.node.mean - settled.node_position).max()
    assert away < 0.1, f"in time a node rests {away:.2g} m from its place in the equilibrium"
    np.testing.assert_allclose(
        moved.net_force.mean, settled.net_force, rtol=0.01, atol=50.0, err_msg="load in time"
    )
