"""While the tests run, every function of seacage checks what it is given and what it returns."""

import jaxtyping
import numpy as np
import pytest

from checking import at_first_call
from seacage.dynamics import aarsnes
from seacage.ocean import SeaState


def scaled(x: jaxtyping.Float[np.ndarray, " n"], y: jaxtyping.Float[np.ndarray, " n"]) -> float:
    return float(x @ x) + y.size


def repeated(word: str, times: int) -> str:
    return word * times if times else None


def test_axes_of_one_name_have_one_length():
    check = at_first_call(scaled)
    assert check(np.ones(3), np.ones(3)) == 6.0
    with pytest.raises(jaxtyping.TypeCheckError, match=r"parameters of .*scaled"):
        check(np.ones(3), np.ones(4))


def test_arguments_and_results_without_an_array_are_checked_too():
    check = at_first_call(repeated)
    assert check("a", 2) == "aa"
    with pytest.raises(TypeError, match="parameter times"):
        check("a", "b")
    with pytest.raises(TypeError, match="return"):
        check("a", 0)


def test_the_functions_and_dataclasses_of_seacage_are_checked():
    with pytest.raises(jaxtyping.TypeCheckError):
        aarsnes("0.2", np.array([1.0]))
    with pytest.raises(TypeError):
        SeaState(current_speed="fast")
