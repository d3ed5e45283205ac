"""Default choices of a network's training."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from seacage.conventions import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Recipe:
    """The choices of a training."""

    width: int  # channels per node
    epochs: int  # most passes through the cases
    patience: int  # epochs without a better answer to the held-out cases, after which training ends
    # Of Adam, at its largest; it rises over the first twentieth and falls as a cosine to 0
    learning_rate: float


RECIPES: Mapping[str, Recipe] = {
    "paper": Recipe(width=64, epochs=150, patience=30, learning_rate=5e-3),
    "modal": Recipe(width=16, epochs=800, patience=200, learning_rate=3e-3),
}

LARGEST_BATCH, FEWEST_BATCHES = 64, 10  # cases per step of the optimiser, and steps per epoch


def recipe_of(kind: str, **wanted: float | None) -> Recipe:
    """The recipe of a kind, changed where a value is given.

    Raises InputError: there is no such network, or a value is not above 0.
    """
    if kind not in RECIPES:
        raise InputError(f"GCN: no network {kind!r}; there are: {', '.join(RECIPES)}.")
    chosen = {name: value for name, value in wanted.items() if value is not None}
    for name, value in chosen.items():
        if not value > 0:
            raise InputError(
                f"GCN: {name} = {value:g} is not above 0. "
                f"Leave it out for {getattr(RECIPES[kind], name):g}."
            )
    return replace(RECIPES[kind], **chosen)
