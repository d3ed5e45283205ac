"""A minute of a cage in waves as a looping picture."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage
from seacage.conventions import InputError, Origin, Progress, towards
from seacage.figures._net import draw_frame
from seacage.figures._style import FAINT, INK, MULTI, MUTED, caption, style
from seacage.figures._types import Axes, Collection, Figure
from seacage.ocean import SeaState, Waves, surface_elevation

if TYPE_CHECKING:
    from matplotlib.colors import LinearSegmentedColormap
    from matplotlib.lines import Line2D

_SIZE = (7.2, 4.25)  # of the picture [inch]; its width in pixels is the caller's
_TILT = np.deg2rad(8.0)  # how far the eye looks down, so that the collar is seen as a ring
_WATER, _SURFACE, _CREST = "#f0f6fb", "#e0edf7", "#8fbce0"
_NET = ("#2a5590", "#2f7fc1", "#37a0a6", "#9ccf5e", "#f7dd4a")
_TWINE = "#1c3a5e"
_TENSION = ("#a3b1bd", "#efb04c", "#d3222a")
_NET_LEVELS, _TENSION_LEVELS = 8, 5
_MARGIN = 7.0  # water drawn outside the frame [m]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """What an animation shows: a cage's shapes and tensions, one after the other."""

    time: Float[np.ndarray, " t"]  # of each shape, rising evenly, on the clock of ``waves`` [s]
    node_position: Float[np.ndarray, "t node 3"]  # of all nodes [m]
    bridle_tension: Float[np.ndarray, "t bridle"]  # [N]
    rest_position: Float[np.ndarray, "node 3"]  # what displacement is measured from [m]
    sea: SeaState  # its current goes to the right; its numbers stand above the picture
    waves: Waves | None = None  # of the surface that is drawn; a level one if None
    origin: Origin = Origin.COMPUTED  # where the shapes come from

    def __post_init__(self) -> None:
        if len(self.time) < 4:
            raise InputError(
                f"Motion: {len(self.time)} moments are too few to move. Simulate longer, or "
                "sample the series more often."
            )
        if not (np.isfinite(self.node_position).all() and np.isfinite(self.bridle_tension).all()):
            raise InputError(
                "Motion: some positions or tensions are not finite numbers: the case diverged. "
                "Draw a case whose result is CONVERGED."
            )

    def sampled(self, every: float) -> "Motion":
        """The same motion at even moments, by cubic splines; tensions stay above zero [s]."""
        from scipy.interpolate import CubicSpline

        count = int((self.time[-1] - self.time[0]) / every * (1.0 + 1e-9)) + 1
        moments = self.time[0] + every * np.arange(count)
        tension = CubicSpline(self.time, self.bridle_tension)(moments)
        position = CubicSpline(self.time, self.node_position)(moments)
        tension = np.maximum(tension, 0.0)
        return replace(self, time=moments, node_position=position, bridle_tension=tension)


def write_animation(
    path: Path,  # ends in ``.gif``
    cage: Cage,
    motion: Motion,  # the loop closes without a jump where the sea repeats after its last moment
    *,
    frames_per_second: float = 6.25,  # six follow waves of 4 s and longer; the file grows with it
    width: int = 640,  # of the picture [pixel]
    progress: Progress | None = None,  # called as ("draw", done, total), in pictures
) -> Path:
    """Write a motion as a GIF that runs in real time and loops.

    Seen from the side and a little from above: the net coloured by its displacement, the bridles
    by their tension, the water's surface, and the tension of the bridle that is fullest on average
    as a running trace below. Left out: the motion of the frame's corners, which are drawn where
    they are in still water.

    Raises InputError: another ending than ``.gif``.
    """
    if path.suffix != ".gif":
        raise InputError(f"{path}: animations are written as GIF. End the name in .gif.")
    shown = motion.sampled(1.0 / frames_per_second)

    def pictures() -> Iterator[np.ndarray]:
        scene = _Scene(cage, shown, width)
        for frame in range(len(shown.time)):
            yield scene.picture(frame)
            if progress is not None:
                progress("draw", frame + 1, len(shown.time))

    with style():
        write_gif(path, pictures(), colours=_colours(), seconds=1.0 / frames_per_second)
    return path


class _Scene:
    """A figure whose moving parts are set anew for each frame."""

    def __init__(self, cage: Cage, motion: Motion, width: int) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.collections import LineCollection, PolyCollection
        from matplotlib.figure import Figure

        self._cage, self._motion = cage, motion
        self._bridle = int(motion.bridle_tension.mean(axis=0).argmax())
        self._eye = _Eye.across(motion.sea.current_to)
        figure = Figure(figsize=_SIZE, dpi=width / _SIZE[0])
        self._canvas = FigureCanvasAgg(figure)
        axes = figure.add_axes((0.0, 0.27, 1.0, 0.73))
        reach = float(np.abs(self._eye.project(cage.corner_position)[:, 0]).max()) + _MARGIN
        self._moved = np.linalg.norm(motion.node_position - motion.rest_position, axis=2)
        _frame_axes(axes, reach, float(motion.rest_position[:, 2].min()))
        self._water = _Water(axes, self._eye, motion, reach)
        self._patches = _patches(cage)
        self._net = PolyCollection([], edgecolors=_TWINE, linewidths=0.25, zorder=2)
        self._lines = LineCollection([], linewidths=1.5, zorder=4)
        _colour(axes, self._net, _NET, _NET_LEVELS, max(float(self._moved.max()), 0.1))
        most = max(float(motion.bridle_tension.max()), 1.0)
        _colour(axes, self._lines, _TENSION, _TENSION_LEVELS, most)
        (self._collar,) = axes.plot([], [], color=INK, lw=2.6, solid_joinstyle="round", zorder=5)
        (self._mark,) = axes.plot([], [], "o", color=MULTI, ms=5.5, mec="white", mew=0.8, zorder=6)
        draw_frame(axes, cage, self._eye.view)
        _write_legend(axes, self._net, self._lines)
        _write_head(axes, cage, motion)
        self._past, self._now = _trace(figure, cage, motion, self._bridle)

    def picture(self, frame: int) -> np.ndarray:
        """Pixels of one moment, rows × columns × RGB."""
        cage, eye, motion = self._cage, self._eye, self._motion
        shape = motion.node_position[frame]
        self._water.show(frame)
        corners = shape[self._patches]
        order = np.argsort(corners.mean(axis=1) @ eye.toward)
        self._net.set_verts(list(eye.project(corners)[order]))
        self._net.set_array(self._moved[frame][self._patches].mean(axis=1)[order])
        ends = np.stack([cage.corner_position[cage.bridle_corner], shape[cage.bridle_nodes]], 1)
        self._lines.set_segments(list(eye.project(ends)))
        self._lines.set_array(motion.bridle_tension[frame])
        collar = eye.project(shape[np.append(cage.ring_nodes(0), 0)])
        self._collar.set_data(collar[:, 0], collar[:, 1])
        held = eye.project(shape[cage.bridle_nodes[[self._bridle]]])
        self._mark.set_data(held[:, 0], held[:, 1])
        since = motion.time[: frame + 1] - motion.time[0]
        tension = motion.bridle_tension[: frame + 1, self._bridle] / 1e3
        self._past.set_data(since, tension)
        self._now.set_data(since[-1:], tension[-1:])
        self._canvas.draw()
        return np.asarray(self._canvas.buffer_rgba())[:, :, :3].copy()


def write_gif(
    path: Path, pictures: Iterable[np.ndarray], *, colours: list[str], seconds: float
) -> None:
    """Write a looping GIF of few, chosen colours: it stays small, and flat areas stay flat.

    ``pictures``: rows × columns × RGB, from 0 to 255. ``colours``: as ``#rrggbb``, at most 255;
    each pixel takes the nearest. ``seconds``: between pictures. A GIF counts hundredths; pictures
    are spread so that the whole keeps time.
    """
    from PIL import Image

    if seconds < 0.02:
        raise InputError(
            f"Gif: a picture every {seconds:g} s; browsers slow down below 0.02 s. "
            "Draw fewer pictures a second."
        )
    palette = Image.new("P", (1, 1))
    palette.putpalette(bytes.fromhex("".join(one.removeprefix("#") for one in colours)))
    first, *others = (
        Image.fromarray(pixels).quantize(palette=palette, dither=Image.Dither.NONE)
        for pixels in pictures
    )
    ends = np.round(100.0 * seconds * np.arange(len(others) + 2)).astype(int)
    first.save(
        path,
        format="GIF",
        save_all=True,
        append_images=others,
        duration=(10 * np.diff(ends)).tolist(),
        loop=0,
        optimize=True,
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Eye:
    """How a point in space is seen: a view from afar, the current going to the right."""

    view: Float[np.ndarray, "2 3"]
    toward: Float[np.ndarray, "3"]
    along: Float[np.ndarray, "2"]
    away: Float[np.ndarray, "2"]

    @classmethod
    def across(cls, current_to: float) -> "_Eye":
        along = towards(np.array(1.0), np.array(current_to))
        away = np.array([-along[1], along[0]])
        sine, cosine = np.sin(_TILT), np.cos(_TILT)
        view = np.array([[*along, 0.0], [*(sine * away), cosine]])
        toward = np.array([*(-cosine * away), sine])
        return cls(view=view, toward=toward, along=along, away=away)

    def project(self, position: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 2"]:
        return position @ self.view.T


class _Water:
    """The water's surface as a band from a far to a near crest, and the water below it."""

    def __init__(self, axes: Axes, eye: _Eye, motion: Motion, reach: float) -> None:
        self._eye, self._motion = eye, motion
        along = np.linspace(-reach - 1.0, reach + 1.0, 96)
        rows = [reach * far for far in (0.8, 0.0, -0.8)]
        self._place = np.array([[x * eye.along + y * eye.away for x in along] for y in rows])
        self._floor = 1.2 * float(motion.rest_position[:, 2].min()) - reach
        hard = {"lw": 0.7, "antialiased": False}
        (self._surface,) = axes.fill([], [], facecolor=_SURFACE, zorder=0, **hard)
        (self._body,) = axes.fill([], [], facecolor=_WATER, zorder=0, **hard)
        self._crests = [
            axes.plot([], [], color=_CREST, zorder=order, **hard)[0] for order in (0.5, 0.5, 3.5)
        ]

    def show(self, frame: int) -> None:
        height = np.zeros(self._place.shape[:2])
        if self._motion.waves is not None:
            time = np.full(height.shape, self._motion.time[frame])
            height = surface_elevation(self._motion.waves, self._place, time)
        rows = self._eye.project(np.concatenate([self._place, height[..., None]], axis=-1))
        far, _, near = rows
        for crest, row in zip(self._crests, rows, strict=True):
            crest.set_data(row[:, 0], row[:, 1])
        self._surface.set_xy(np.vstack([far, near[::-1]]))
        ends = np.array([[near[-1, 0], self._floor], [near[0, 0], self._floor]])
        self._body.set_xy(np.vstack([near, ends]))


def _frame_axes(axes: Axes, reach: float, bottom: float) -> None:
    """Metres as wide as high, the deepest point at rest just inside."""
    axes.set_axis_off()
    high = 2.0 * reach * (0.73 * _SIZE[1]) / _SIZE[0]
    low = bottom - 3.0
    axes.set(xlim=(-reach, reach), ylim=(low, low + high), autoscale_on=False)


def _patches(cage: Cage) -> Int[np.ndarray, "patch corner"]:
    """Panels two by two round the cage where they pair: half the meridians, twice as calm."""
    if cage.spokes % 2:
        return cage.panels
    left, right = cage.panels[0::2], cage.panels[1::2]
    return np.column_stack([left[:, :2], right[:, 1:], left[:, 3]])


def _colour(
    axes: Axes, artists: Collection, colours: tuple[str, ...], levels: int, largest: float
) -> None:
    """Add artists that take one of so many colours, from zero to the largest value."""
    from matplotlib.colors import BoundaryNorm

    artists.set_cmap(_ramp(colours, levels))
    artists.set_norm(BoundaryNorm(np.linspace(0.0, largest, levels + 1), levels))
    # Hard edges here and on what else is long and moves: each soft pixel costs the file more
    # than it gives the eye.
    artists.set_antialiased(False)
    axes.add_collection(artists)


def _ramp(colours: tuple[str, ...], levels: int) -> "LinearSegmentedColormap":
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("seacage", list(colours), N=levels)


def _write_head(axes: Axes, cage: Cage, motion: Motion) -> None:
    sea = motion.sea
    waves = f"waves Hs {sea.hs:.3g} m, Tp {sea.peak_period:.3g} s" if sea.hs else "no waves"
    about = f"current {sea.current_speed:.3g} m/s to the right, {waves}, {motion.origin}"
    caption(axes, f"Cage {cage.name}", (0.012, 0.985), va="top", weight="bold")
    caption(axes, about, (0.988, 0.985), va="top", ha="right", color=MUTED)


def _write_legend(axes: Axes, net: Collection, lines: Collection) -> None:
    """Two slim colour bars in the corners of the deep water."""
    for left, artist, unit, label, scale in (
        (0.03, net, "m", "Net: displacement from rest", 1.0),
        (0.72, lines, "kN", "Bridles: tension", 1e-3),
    ):
        bar = axes.inset_axes((left, 0.07, 0.25, 0.03))
        levels = artist.get_cmap().N
        bar.imshow(np.arange(levels)[None], cmap=artist.get_cmap(), aspect="auto")
        bar.set_axis_off()
        most = scale * artist.get_clim()[1]
        caption(bar, label, (0.0, 1.5), va="bottom", fontsize=8.0)
        caption(bar, "0", (0.0, -0.5), va="top", fontsize=7.5)
        caption(bar, f"{most:.0f} {unit}", (1.0, -0.5), ha="right", va="top", fontsize=7.5)


def _trace(figure: Figure, cage: Cage, motion: Motion, bridle: int) -> "tuple[Line2D, Line2D]":
    """One bridle's tension: all of it faintly, what has been strongly, now as a dot."""
    axes = figure.add_axes((0.075, 0.085, 0.905, 0.15))
    since = motion.time - motion.time[0]
    tension = motion.bridle_tension[:, bridle] / 1e3
    axes.plot(since, tension, color="#d5dbe0", lw=1.2)
    (past,) = axes.plot([], [], color=MULTI, lw=1.5)
    (now,) = axes.plot([], [], "o", color=MULTI, ms=5.5, mec="white", mew=0.8)
    axes.set(xlim=(0.0, since[-1]), ylim=(0.0, max(1.15 * float(tension.max()), 1.0)))
    axes.set_ylabel(f"{cage.bridle_names[bridle]} [kN]")
    axes.annotate("s", (1.0, 0.0), (0, -10), xycoords="axes fraction", textcoords="offset points")
    return past, now


def _colours() -> list[str]:
    """Every colour of the picture, and what its soft edges blend to."""
    from matplotlib.colors import to_hex

    ramps = ((_NET, _NET_LEVELS), (_TENSION, _TENSION_LEVELS))
    levels = [to_hex(_ramp(of, count)(level)) for of, count in ramps for level in range(count)]
    plain = ["#ffffff", _WATER, _SURFACE, _CREST, _TWINE, INK, MUTED, FAINT, MULTI, "#d5dbe0"]
    soft = [_blend(INK, _WATER), _blend(INK, "#ffffff"), _blend(MUTED, "#ffffff")]
    soft += [_blend(MULTI, "#ffffff"), _blend(MUTED, _WATER), _blend(_CREST, _SURFACE)]
    return list(dict.fromkeys([*plain, *levels, *soft]))


def _blend(one: str, other: str) -> str:
    from matplotlib.colors import to_hex, to_rgb

    return to_hex(tuple((np.array(to_rgb(one)) + np.array(to_rgb(other))) / 2.0))
