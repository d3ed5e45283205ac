"""Stretches of a virtual field: simulated side by side, and kept as they are done."""

import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.campaigns._pool import map_tasks, one_thread, report_progress
from seacage.campaigns._virtual_field._timetable import Stretch, Timetable, side_by_side
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters
from seacage.campaigns._virtual_field._weather import Weather
from seacage.conventions import InputError, RecordError
from seacage.dynamics import PHYSICS, Followed, Law, follow, simulation_lanes

_MANIFEST = "manifest.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class TrueCage:
    """The cage that is followed, and where it is looked at."""

    toml: str  # of the true cage, on its finer mesh
    # As ``follow`` takes them
    refined: int  # how much finer it is than drawn
    law: Law
    skin_friction: float | None
    lift_factor: float
    stiffening: tuple[float, float]
    watched: tuple[int, ...]  # the depth sensors' nodes
    drawn: tuple[int, ...]  # nodes of the drawing's mesh

    @classmethod
    def of(cls, cage: Cage, hidden: TruthParameters) -> Self:
        """True cage behind a drawn one."""
        true, times = hidden.fine_cage(cage), hidden.netting.refined
        rings, spokes = np.divmod(np.arange(cage.node_count - 1), cage.spokes)
        drawn = np.append(true.spokes * times * rings + times * spokes, true.bottom_node)
        return cls(
            toml=true.to_toml(),
            refined=times,
            **hidden.net_loads,
            stiffening=(hidden.lines.stiffer_from_strain, hidden.lines.stiffer_share),
            watched=tuple(int(drawn[sensor.node]) for sensor in cage.depth_sensors),
            drawn=tuple(drawn.tolist()),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Stretches side by side, and all that simulating them takes: it travels to a worker."""

    stretches: tuple[Stretch, ...]
    weathers: tuple[Weather, ...]
    cage: TrueCage
    timetable: Timetable
    every: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Passed:
    """Samples of the cage along one stretch, in single precision."""

    watched_position: Float[np.ndarray, "reading watched 3"]  # [m]
    # What the waves add to the pressure there, as a depth [m]
    wave_head: Float[np.ndarray, "reading watched"]
    bridle_tension: Float[np.ndarray, "reading bridle"]  # [N]
    shape: Float[np.ndarray, "mean node 3"]  # mean positions of the drawn nodes [m]
    lost: bool  # whether the simulation left the finite numbers: then nothing of it counts


@dataclass(frozen=True, slots=True, kw_only=True)
class StretchStore:
    """A folder of finished stretches of one field.

    A file comes in whole or not at all; which were there before a stop, and how many workers
    there are, makes no difference to any of them.
    """

    folder: Path

    @classmethod
    def opened(cls, folder: Path, identity: Mapping[str, object]) -> Self:
        """A folder for the stretches of the field with this identity, made if it is not there.

        Raises InputError: it holds those of another field.
        """
        software = {"seacage": version("seacage"), "physics": PHYSICS}
        identity = {"schema": "seacage stretches 1", **software, **identity}
        manifest = folder / _MANIFEST
        if manifest.exists():
            found = _manifest(manifest)
            other = [name for name, value in identity.items() if found.get(name) != value]
            if other:
                words = [name.removesuffix("_sha256").replace("_", " ") for name in other]
                raise InputError(
                    f"{folder} holds stretches of a field with another {' and '.join(words)}. "
                    "Give another folder, or delete this one."
                )
        else:
            folder.mkdir(parents=True, exist_ok=True)
            _write(manifest, (json.dumps(identity, indent=2) + "\n").encode())
        return cls(folder=folder)

    def has(self, stretch: Stretch) -> bool:
        """Whether a stretch is done."""
        return self._path(stretch).exists()

    def keep(self, stretch: Stretch, passed: Passed) -> None:
        """Put a stretch in its place."""
        from safetensors.numpy import save

        # safetensors takes the memory as it lies
        arrays = {name: np.ascontiguousarray(getattr(passed, name)) for name in Passed.__slots__}
        _write(self._path(stretch), save(arrays))

    def read(self, stretch: Stretch) -> Passed:
        """Read a stretch that is done.

        Raises RecordError: its file is damaged.
        """
        from safetensors import SafetensorError
        from safetensors.numpy import load

        path = self._path(stretch)
        try:
            found = load(path.read_bytes())
            arrays = {name: found[name] for name in Passed.__slots__}
        except (OSError, KeyError, SafetensorError) as error:
            raise RecordError(
                f"{path}: this is no finished stretch ({error}). "
                "Delete the file and run again: it will be simulated anew."
            ) from error
        return Passed(**{**arrays, "lost": bool(arrays["lost"])})

    def _path(self, stretch: Stretch) -> Path:
        return self.folder / f"{stretch.first:08d}.safetensors"


def simulate_stretches(
    stretches: Sequence[Stretch],
    kept: StretchStore,
    weather: Weather,
    *,
    cage: TrueCage,
    timetable: Timetable,
    every: float,
    workers: int | None,
    report: Callable[[float], None],
) -> None:
    """Simulate those stretches that are not kept yet.

    ``stretches``: all that are wanted. ``kept``: where they go. ``weather``: of the whole record.
    ``cage``, ``timetable``, ``every``: what is simulated and how, and the time between readings
    [s]. ``workers``: processes; None for one per available core. ``report``: told how many
    stretches are done, first those there already; parts count.
    """
    missing = [one for one in stretches if not kept.has(one)]
    groups = [
        Group(
            stretches=alike,
            weathers=tuple(
                weather.between(start - timetable.spin_up, start + timetable.stretch)
                for start in (one.first * every for one in alike)
            ),
            cage=cage,
            timetable=timetable,
            every=every,
        )
        for alike in side_by_side(missing, simulation_lanes())
    ]
    there = len(stretches) - len(missing)
    report(there)
    running = map_tasks(
        simulate_group, groups, workers=workers, progress=lambda since: report(there + since)
    )
    with closing(running) as finished:
        for group, answers in finished:
            for stretch, answer in zip(group.stretches, answers, strict=True):
                kept.keep(stretch, answer)
    report(len(stretches))


def simulate_group(group: Group) -> list[Passed]:
    """Simulate a group of stretches."""
    timetable, settings = group.timetable, asdict(group.cage)
    toml, drawn = settings.pop("toml"), settings.pop("drawn")
    with one_thread():
        followed = follow(
            Cage.from_toml(toml),
            group.weathers,
            [one.first * group.every for one in group.stretches],
            duration=timetable.stretch,
            every=group.every,
            spin_up=timetable.spin_up,
            time_step=timetable.time_step,
            damaged=group.stretches[0].damaged,
            breaking=group.stretches[0].breaking,
            shape_nodes=drawn,
            shape_every=timetable.mean,
            progress=lambda _, done, total: report_progress(len(group.stretches) * done / total),
            **settings,
        )
    return [
        _stretch_of_lane(followed, lane, weather) for lane, weather in enumerate(group.weathers)
    ]


def _stretch_of_lane(followed: Followed, lane: int, weather: Weather) -> Passed:
    seen = (followed.watched_position, followed.bridle_tension, followed.shape)
    position, tension, shape = (each[lane] for each in seen)
    finite = all(np.isfinite(each).all() for each in (position, tension, shape))
    lost = not (finite and np.isnan(followed.lost_at[lane]))
    head = np.zeros(position.shape[:2])
    if not lost and weather.waves(followed.time[lane, 0]).amplitude.size:
        head = weather.pressure_head(followed.time[lane], position)
    return Passed(
        watched_position=position.astype(np.float32),
        wave_head=head.astype(np.float32),
        bridle_tension=tension.astype(np.float32),
        shape=shape.astype(np.float32),
        lost=lost,
    )


def _manifest(path: Path) -> dict[str, object]:
    try:
        return dict(json.loads(path.read_text("utf-8")))
    except (OSError, ValueError, TypeError) as error:
        raise RecordError(
            f"{path}: this is no manifest of stretches ({error}). Delete its folder."
        ) from error


def _write(path: Path, content: bytes) -> None:
    unborn = path.with_name(f".{path.name}.unborn")
    unborn.write_bytes(content)
    unborn.replace(path)
