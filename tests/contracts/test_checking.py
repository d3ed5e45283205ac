"""While the tests run, every function of seacage checks what it is given and what it returns."""

from typing import Literal

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


def test_what_was_found_right_is_not_taken_for_another_shape_type_or_word():
    check = at_first_call(scaled)
    for _ in range(2):
        assert check(np.ones(3), np.ones(3)) == 6.0
    for wrong in (np.ones(4), np.ones(3, dtype=int), np.ones((3, 1)), [1.0] * 3, 1.0):
        with pytest.raises(jaxtyping.TypeCheckError, match=r"parameters of .*scaled"):
            check(np.ones(3), wrong)
        assert check(np.ones(3), np.ones(3)) == 6.0
    assert check(np.ones(4), y=np.ones(4)) == 8.0
    with pytest.raises(jaxtyping.TypeCheckError):
        check(np.ones(4), y=np.ones(3))
    named = at_first_call(cut)
    assert named(np.ones(3), "all", []).size == 3
    with pytest.raises(jaxtyping.TypeCheckError):
        named(np.ones(3), "most", [])


def test_a_result_is_checked_where_the_arguments_have_been_found_right():
    check = at_first_call(cut)
    for _ in range(2):
        assert check(np.ones(3), "all", []).size == 3
    for results in ([np.ones(2)], [1.0], [np.ones(3, dtype=int)]):
        with pytest.raises(jaxtyping.TypeCheckError, match=r"return value .*cut"):
            check(np.ones(3), "all", results)
    assert check(np.ones(3), "all", []).size == 3


def cut(
    x: jaxtyping.Float[np.ndarray, " n"], how: Literal["all", "none"], instead: list
) -> jaxtyping.Float[np.ndarray, " n"]:
    del how
    return instead.pop() if instead else x


def test_functions_that_are_defined_in_another_are_checked_each():
    def add(step):
        def added(x: int) -> int:
            return x + step

        def moved(x: jaxtyping.Float[np.ndarray, " n"]) -> jaxtyping.Float[np.ndarray, " n"]:
            return x + step

        return at_first_call(added), at_first_call(moved)

    for step in (1, 2):
        added, moved = add(step)
        assert added(1) == 1 + step
        assert moved(np.ones(2)).tolist() == [1.0 + step] * 2
        with pytest.raises(TypeError, match="parameter x"):
            added("1")
        with pytest.raises(jaxtyping.TypeCheckError, match=r"parameters of .*moved"):
            moved("1")
    added, moved = add("a")
    with pytest.raises(TypeError):
        added(1)
    _, moved = add(np.ones((3, 2)))
    with pytest.raises(jaxtyping.TypeCheckError, match=r"return value .*moved"):
        moved(np.ones(2))


def test_the_functions_and_dataclasses_of_seacage_are_checked():
    with pytest.raises(jaxtyping.TypeCheckError):
        aarsnes("0.2", np.array([1.0]))
    with pytest.raises(TypeError):
        SeaState(current_speed="fast")
