"""``seacage simulate``: one sea state in time."""

from importlib.metadata import version
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from seacage.service._cli import _options
from seacage.service._cli._console import Exit, exit_with, progress_bar, refusal, report_case

if TYPE_CHECKING:
    import numpy as np

    from seacage.cage import Cage, Structure
    from seacage.dynamics import History, LineLoads, Statistics, WaterLoad
    from seacage.figures import Motion
    from seacage.ocean import SeaState, Waves

Settings = dict[str, str | int | float]  # of a simulation, with the unit in each key
_SMOOTH = 0.5  # between samples that an animation can follow waves by [s]


def simulate(
    *,
    sea: _options.SeaOptions,
    duration: float = 1800.0,
    spin_up: _options.SpinUp = 300.0,
    seed: _options.Seed = 0,
    cage: _options.CageName = "ace",
    law: _options.Law = "kristiansen-faltinsen",
    net: _options.LawOptions,
    mooring: _options.Mooring = "catenary",
    without: _options.Without = None,
    mooring_draws: int = 0,
    sample_every: float = 0.5,
    pieces: int | None = None,
    out: _options.OutFile = None,
    animation: _options.OutFile = None,
) -> None:
    """Simulate one sea state in time: shape and loads in waves.

    The cage starts at rest in the current and the waves rise; after the spin-up everything
    counts. The same seed gives the same waves.

    Example: half an hour in a current towards east, with waves from west.
        seacage simulate --current-speed 0.5 --current-to 90 --hs 2 --wave-from 270 --out sea.nc

    Options:
        duration: That counts, s.
        seed: Of the waves.
        mooring_draws: Simulate so many moorings more, drawn from the uncertainty that the cage
            file states, in the same waves, and answer each line's band over them.
        sample_every: Between samples of the series, s: whole tenths.
        pieces: That the time is cut into, simulated side by side: 16 take a quarter of the time of
            1. Series leap a little where one begins. As many as last a minute each, up to 16.
        out: Write series and statistics as CF-NetCDF.
        animation: Write the first minute as a GIF.
    """
    from seacage.cage import Cage
    from seacage.conventions import extension_names
    from seacage.dynamics import MOVING_LAWS, law_label
    from seacage.dynamics import simulate as simulated
    from seacage.ocean import sample_waves

    net.check_files(out, animation)
    if net.laws is not None and mooring_draws:
        raise refusal(
            "simulate: --laws all and --mooring-draws are two bands. Ask for one at a time."
        )
    for path, ending in ((out, ".nc"), (animation, ".gif")):
        _check_file(path, ending)
    if animation is not None and sample_every > _SMOOTH:
        raise refusal(
            f"simulate: a sample every {sample_every:g} s is too seldom for an animation. "
            f"Give --sample-every {_SMOOTH:g} or less."
        )
    pieces = max(1, min(16, int(duration // 60.0))) if pieces is None else pieces
    read = _options.read_cage if mooring_draws or animation else _options.read_cage_or_structure
    subject, state = read(cage), sea.state()
    warnings = [*subject.warnings, *_options.warn_of(mooring)]
    waves = sample_waves(state, seed=seed, depth=subject.site.water_depth)
    given: dict[str, Any] = {
        "duration": duration,
        "spin_up": spin_up,
        "ramp": min(60.0, spin_up),
        "skin_friction": net.skin_friction,
        "lift_factor": net.lift_factor,
        "mooring": mooring,
        "parted": without or (),
        "waves": waves,
        "pieces": pieces,
    }
    drawn = [subject.drawn(n) for n in range(mooring_draws) if isinstance(subject, Cage)]
    laws = (law,) if net.laws is None else (*MOVING_LAWS, *extension_names("screen_laws"))
    with progress_bar() as progress:
        history = simulated(
            subject,
            [state] * len(laws) if net.laws else state,
            law=laws if net.laws else law,
            sample_every=sample_every,
            workers=len(laws),
            progress=progress,
            **given,
        )
        others = [simulated(one, state, law=law, sample_every=None, **given) for one in drawn]
    remarks = [*history.warnings, *(() if net.laws else _remarks(history))]
    _options.warn(remarks)
    warnings += remarks
    settings = {
        "law": net.laws or law_label(law),
        **net.changes,
        "mooring": mooring,
        "seed": seed,
        "duration_s": duration,
        "spin_up_s": spin_up,
        "sample_every_s": sample_every,
        "pieces": pieces,
    } | ({"without": " ".join(without)} if without else {})
    if net.laws is not None:
        from seacage.service._cli._law_band import report_histories

        report_histories(subject, history, laws, {"warnings": warnings, **settings})
        return
    answer = _answer(subject, history, warnings, settings)
    bands = _bands(others)
    answer |= {"mooring_draws": {"draws": mooring_draws, "lines": bands}} if others else {}
    if out is not None:
        comment = {"comment": " ".join(warnings)} if warnings else {}
        _write(out, subject, state, history, settings | comment)
        answer["written"] = str(out)
    _refuse_failure(history)
    if animation is not None and isinstance(subject, Cage):
        from seacage.dynamics import rest_shape
        from seacage.figures import write_animation

        motion = _motion(rest_shape(subject, mooring=mooring), state, waves, history, spin_up)
        with progress_bar() as progress:
            write_animation(animation, subject, motion, progress=progress)
        answer["animation"] = str(animation)
    rows = _rows(subject, history) + _band_rows(bands)
    report_case("simulate", answer, history.result, rows)


def _remarks(history: "History") -> list[str]:
    """Sentence on lines that bear nothing, if there are any."""
    lines = history.lines
    slack = [n for n, share in zip(lines.names, lines.slack_share, strict=True) if share > 0.99]
    return [f"Slack throughout: {', '.join(slack)}."] if slack else []


def _check_file(path: Path | None, ending: str) -> None:
    """Refuse a file that could not be written before an hour is simulated for it."""
    if path is None:
        return
    if path.suffix != ending:
        raise refusal(f"{path}: this file ends in {ending}. Name it {path.stem}{ending}.")
    if not path.absolute().parent.is_dir():
        raise refusal(f"{path}: there is no folder {path.parent}. Make it first.")


def _refuse_failure(history: "History") -> None:
    from seacage.conventions import RESULTS, Result

    result = Result(int(history.result))
    if result is Result.DIVERGED:
        raise exit_with(
            f"simulate: {result.name.lower()} after {float(history.diverged_at):.1f} s: "
            f"{RESULTS[result]}. Look at the cage's file and the sea state.",
            Exit.FAILED,
        )


def _answer(
    cage: "Cage | Structure", history: "History", warnings: list[str], settings: Settings
) -> dict[str, object]:
    from seacage.dynamics import BODIES

    return {
        "cage": cage.name,
        "origin": "computed",
        "warnings": warnings,
        "result": int(history.result),
        "hs_left_out": round(float(history.hs_left_out), 4),
        **settings,
        "net_force_kn": _statistics(history.net_force, 1e-3),
        "volume_m3": _statistics(history.volume, 1.0),
        "volume_fraction": round(float(history.volume_fraction), 4),
        "bridle_tension_kn": {
            name: _statistics(history.bridle, 1e-3, index)
            for index, name in enumerate(cage.bridle_names)
        },
        "lines": _lines(history),
        "water_load_kn": {
            body: _statistics(history.water_load, 1e-3, index) for index, body in enumerate(BODIES)
        },
        "twine_tension_n": {
            "mean": round(float(history.twines.mean.mean()), 3),
            "maximum": round(float(history.twines.maximum.max()), 3),
        }
        if history.twines.mean.size
        else None,
        "depth_m": {
            one.name: _statistics(history.node, -1.0, (one.node, 2)) for one in cage.depth_sensors
        },
    }


def _lines(history: "History") -> dict[str, dict[str, object]]:
    """All ropes and chains by their names; null where something is not known."""
    from seacage.records import LINES

    lines = history.lines
    answer = {
        name: dict[str, object](kind=kind)
        for name, kind in zip(lines.names, lines.kinds, strict=True)
    }
    for column, values in lines.columns.items():
        key, scale = (f"{column}_kn", 1e3) if LINES[column][0] == "N" else (column, 1.0)
        digits = 9 if column == "damage_per_year" else 3
        for each, value in zip(answer.values(), values / scale, strict=True):
            each[key] = round(float(value), digits) if isfinite(value) else None
    return answer


def _bands(others: "list[History]") -> dict[str, dict[str, dict[str, float]]]:
    """Mean and 5 to 95 % over the drawn moorings, of each line's statistics [kN]."""
    import numpy as np

    def band(values: "np.ndarray") -> dict[str, float]:
        low, high = np.quantile(values, (0.05, 0.95))
        numbers = {"mean": values.mean(), "p05": low, "p95": high}
        return {key: round(float(value) / 1e3, 3) for key, value in numbers.items()}

    def one(index: int) -> dict[str, dict[str, float]]:
        return {
            f"{kind}_kn": band(np.array([getattr(h.lines.tension, kind)[index] for h in others]))
            for kind in ("mean", "std", "maximum")
        }

    names = others[0].lines.names if others else ()
    return {name: one(index) for index, name in enumerate(names)}


def _band_rows(bands: dict[str, dict[str, dict[str, float]]]) -> list[tuple[str, str]]:
    """Each line's band over the drawn moorings, of its mean and its largest tension."""

    def shown(band: dict[str, float]) -> str:
        return f"{band['mean']:7.2f} ({band['p05']:.2f} to {band['p95']:.2f})"

    rows = [
        (name, f"{shown(band['mean_kn'])} and {shown(band['maximum_kn'])} kN")
        for name, band in bands.items()
    ]
    heading = ("Moorings drawn", "mean and 5 to 95 % over them, of mean and of most")
    return [heading, *rows] if rows else []


def _statistics(
    statistics: "Statistics | WaterLoad", scale: float, place: int | tuple[int, ...] = ()
) -> dict[str, object]:
    """Mean, standard deviation and range of one quantity; a negative scale swaps the ends."""
    import numpy as np

    ends = scale * np.stack([statistics.minimum[place], statistics.maximum[place]])
    return {
        "mean": (scale * np.asarray(statistics.mean[place])).round(3).tolist(),
        "std": (abs(scale) * np.asarray(statistics.std[place])).round(3).tolist(),
        "minimum": ends.min(axis=0).round(3).tolist(),
        "maximum": ends.max(axis=0).round(3).tolist(),
    }


def _rows(cage: "Cage | Structure", history: "History") -> list[tuple[str, str]]:
    east, north, up = history.net_force.mean / 1e3
    volume, lines = history.volume, history.lines
    kept = f"{volume.mean:.0f} m3, {history.volume_fraction:.1%} of still water"
    rows = [
        ("Mean load", f"{east:.1f} kN east, {north:.1f} kN north, {up:.1f} kN up on the net"),
        ("Volume", f"{kept}, {volume.minimum:.0f} to {volume.maximum:.0f} m3"),
        ("", "  mean     std     least    most"),
    ]
    rows += [
        (name, f"{_line(lines.tension, 1e-3, index)} kN{_beyond(lines, index)}")
        for index, name in enumerate(lines.names)
    ]
    sensors = ((one.name, (one.node, 2)) for one in cage.depth_sensors)
    return rows + [(name, f"{_line(history.node, -1.0, place)} m") for name, place in sensors]


def _beyond(lines: "LineLoads", index: int) -> str:
    """What a line's largest tension is of its capacity, and what three hours would bring."""
    share, extremes = lines.utilisation[index], lines.extremes
    of_capacity = f", {share:.0%} of capacity at most" if isfinite(share) else ""
    mpm, spread = extremes.mpm[index] / 1e3, extremes.mpm_std[index] / 1e3
    damage = lines.damage_per_year[index]
    most = f"; 3 h MPM {mpm:.1f} ± {spread:.1f} kN" if isfinite(mpm) else ""
    return of_capacity + most + (f"; damage {damage:.2g} a year" if isfinite(damage) else "")


def _line(statistics: "Statistics", scale: float, place: int | tuple[int, ...]) -> str:
    values = _statistics(statistics, scale, place)
    least_to_most = f"{values['minimum']:7.1f} {values['maximum']:7.1f}"
    return f"{values['mean']:6.1f} ± {values['std']:5.2f}  {least_to_most}"


def _write(
    path: Path, cage: "Cage | Structure", sea: "SeaState", history: "History", settings: Settings
) -> None:
    import numpy as np

    from seacage.records import STATISTICS, TWINES, HistoryRecord, write_history

    quantities = {
        "node_position": history.node,
        "bridle_tension": history.bridle,
        "net_force": history.net_force,
        "volume": history.volume,
    }
    record = HistoryRecord(
        cage_name=cage.name,
        cage_toml=cage.to_toml(),
        bridle_names=cage.bridle_names,
        sea=sea,
        time=history.time,
        kept_node=history.nodes,
        node_position=history.node_position,
        bridle_tension=history.bridle_tension,
        surface_elevation=history.surface_elevation,
        statistics={
            f"{name}_{kind}": np.asarray(getattr(quantity, kind))
            for name, quantity in quantities.items()
            for kind in STATISTICS
        },
        quantile_level=history.quantile_levels,
        node_displacement=history.node_displacement,
        volume_fraction=float(history.volume_fraction),
        result=int(history.result),
        diverged_at=float(history.diverged_at),
        settings=settings,
        line_names=history.lines.names,
        line_kinds=history.lines.kinds,
        lines=history.lines.columns,
        water_load={name: getattr(history.water_load, name) for name in STATISTICS[:4]},
        twines={name: getattr(history.twines, name) for name in TWINES},
        version=version("seacage"),
    )
    write_history(record, path)


def _motion(
    rest: "np.ndarray", sea: "SeaState", waves: "Waves", history: "History", spin_up: float
) -> "Motion":
    """The first minute that counts."""
    from seacage.figures import Motion

    first = history.time < 60.0
    return Motion(
        time=spin_up + history.time[first],
        node_position=history.node_position[first],
        bridle_tension=history.bridle_tension[first],
        rest_position=rest,
        sea=sea,
        waves=waves,
    )
