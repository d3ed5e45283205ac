"""An answer is held while the water stays the same: most ticks come between two readings."""

from dataclasses import dataclass

from seacage.twin._answer import Answer
from seacage.twin._metocean import Metocean
from seacage.twin._models import Models


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Held:
    """What these models answered to this water, before any interval was adapted."""

    models: Models
    water: Metocean
    answer: Answer

    def answers(self, models: Models, water: Metocean) -> bool:
        """Whether the models would only say it again."""
        return models is self.models and water.same(self.water)
