"""What a training takes where its user does not say."""

import pytest

from seacage.conventions import InputError
from seacage.surrogates._gcn._layers import RECIPES, recipe_of


def test_what_is_left_out_is_the_kinds_own() -> None:
    recipe = recipe_of("paper", epochs=7, width=None)
    assert (recipe.epochs, recipe.width) == (7, RECIPES["paper"].width)


def test_a_network_that_there_is_not_is_refused() -> None:
    with pytest.raises(InputError, match="no network 'gat'; there are: paper, modal"):
        recipe_of("gat")


@pytest.mark.parametrize("value", [0, -1.0, float("nan")])
def test_a_choice_not_above_0_is_refused(value: float) -> None:
    with pytest.raises(InputError, match="is not above 0"):
        recipe_of("modal", learning_rate=value)
