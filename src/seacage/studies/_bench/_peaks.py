"""Half-hours of the hidden cage in waves: shackles in some, and the largest loads of the others."""

from datetime import datetime

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.campaigns import Plan, TruthParameters
from seacage.conventions import Origin, has_answer
from seacage.dynamics import simulate
from seacage.ocean import SeaState
from seacage.records import SEA_COLUMNS, FieldRecord, Record, instant, sea_columns

HALF_HOUR, EVERY, WINDOW = 1800.0, 0.5, 600.0  # s
GROWTH = 0.5  # of the net


def sea_field(
    cage: Cage, hidden: TruthParameters, start: datetime, *, count: int, chance: np.random.Generator
) -> tuple[FieldRecord, dict[str, np.ndarray], Float[np.ndarray, "sea window shackle"]]:
    """A field of the first half of some seas, the others, and the largest load of each ten minutes.

    The buoy reports each sea as it is at the cage: what differs from the drawing is the cage.
    Loads are in kN, every half second.
    """
    seed = int(chance.integers(2**31))
    seas = Plan.named("loads", seed, count).seas
    history = simulate(
        hidden.true_cage(cage, GROWTH),
        seas,
        duration=HALF_HOUR,
        seed=seed,
        **hidden.net_loads,
        sample_every=EVERY,
        series_nodes=[],
    )
    bridles = [one.bridle for one in cage.shackles]
    load = history.bridle_tension[:, : round(HALF_HOUR / EVERY), bridles] / 1e3
    table = {
        key: np.array([getattr(sea, of) for sea in seas]) for key, of in sea_columns(seas).items()
    }
    answered = has_answer(history.result)
    first = np.arange(count) < count // 2
    train, held = (np.flatnonzero(answered & part) for part in (first, ~first))
    noise = chance.normal(scale=hidden.shackle.noise_sd_kn, size=load[train].shape)
    seen = {name: column[train] for name, column in table.items()}
    others = {f"sea_{name}": column[held] for name, column in table.items()}
    windows = load[held].reshape(len(held), round(HALF_HOUR / WINDOW), -1, len(bridles))
    return _field(cage, hidden, start, seen, load[train] + noise), others, windows.max(axis=2)


def _field(
    cage: Cage,
    hidden: TruthParameters,
    start: datetime,
    seas: dict[str, np.ndarray],
    load: Float[np.ndarray, "sea t shackle"],
) -> FieldRecord:
    """Half-hours one after another, the buoy with a value every ten minutes."""

    def record(stream: str, every: float, values: dict[str, np.ndarray]) -> Record:
        count = len(next(iter(values.values())))
        steps = (1e6 * every * np.arange(count)).astype("timedelta64[us]")
        origin = Origin.VIRTUAL_FIELD
        return Record(stream=stream, time=instant(start) + steps, values=values, origin=origin)

    each = round(HALF_HOUR / WINDOW)
    return FieldRecord(
        cage=cage.name,
        buoy=record("buoy-1", WINDOW, {key: np.repeat(one, each) for key, one in seas.items()}),
        sensors={
            shackle.name: record(shackle.name, EVERY, {"tension_kn": load[..., k].ravel()})
            for k, shackle in enumerate(cage.shackles)
        },
        origin=Origin.VIRTUAL_FIELD,
        hidden_sha256=hidden.sha256,
    )


def seas_of(queries: dict[str, np.ndarray]) -> list[SeaState]:
    """The seas whose largest loads are to be predicted."""
    names = {key: name for key, name in SEA_COLUMNS.items() if f"sea_{key}" in queries}
    rows = zip(*(queries[f"sea_{key}"].tolist() for key in names), strict=True)
    return [SeaState(**dict(zip(names.values(), row, strict=True))) for row in rows]
