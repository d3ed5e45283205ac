"""A cage put together with its bridles under pretension."""

from functools import lru_cache

import numpy as np

from seacage.cage import Cage
from seacage.dynamics._equilibrium._search import equilibria
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._flow import steady_flow


@lru_cache(maxsize=16)
def assemble(cage: Cage) -> Assembly:
    """The cage put together, its bridles cut so that each bears the pretension at rest.

    The collar gives to the bridles' pull by some decimetres. Its shape under that pull is found
    with bridles so soft that they pull equally wherever it comes to lie.
    """
    designed, pretension = Assembly.of(cage), cage.bridles.pretension
    still = steady_flow(designed, np.zeros((1, 2)), law="loland")
    shape = designed.position
    for _ in range(2):
        soft = designed.strung(shape, pretension, softness=30.0)
        shape = equilibria(soft, still).position[0]
    return designed.strung(shape, pretension, offset=cage.bridles.length_offset)
