"""One sea state by every law of the netting: the band in which the answer lies."""

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from seacage.service._cli._console import Exit, exit_with, report

if TYPE_CHECKING:
    from seacage.cage import Cage, Structure
    from seacage.dynamics import History, Response

Values = Float[np.ndarray, " law"]


def answer_of_response(
    cage: "Cage | Structure", response: "Response", laws: Sequence[str]
) -> tuple[dict[str, Any], list[tuple[str, str]]]:
    """JSON and table of equilibria, one for each law."""
    bands = _Bands(laws)
    tensions = zip(response.line_names, response.line_tension.T / 1e3, strict=True)
    depth = -response.node_position[:, :, 2]
    answer: dict[str, Any] = {
        "result": _by_law(laws, response.result),
        "net_load_kn": bands.of("Load on the net", _size(response.net_force) / 1e3, "kN"),
        "volume_fraction": bands.of("Volume kept", response.volume_fraction, ""),
        "lines": {name: {"tension_kn": bands.of(name, each, "kN")} for name, each in tensions},
        "depth_m": {
            one.name: bands.of(one.name, depth[:, one.node], "m") for one in cage.depth_sensors
        },
    }
    return answer, bands.rows


def answer_of_history(
    cage: "Cage | Structure", history: "History", laws: Sequence[str]
) -> tuple[dict[str, Any], list[tuple[str, str]]]:
    """JSON and table of histories in the same waves, one for each law."""
    bands, lines = _Bands(laws), history.lines
    columns = {
        "mean_kn": ("mean", lines.tension.mean),
        "maximum_kn": ("largest", lines.tension.maximum),
        "mpm_3h_kn": ("3 h MPM", lines.extremes.mpm),
    }
    answer: dict[str, Any] = {
        "result": _by_law(laws, history.result),
        "net_load_kn": bands.of("Mean load on the net", _size(history.net_force.mean) / 1e3, "kN"),
        "volume_fraction": bands.of("Volume kept", history.volume_fraction, ""),
        "lines": {
            name: {
                key: bands.of(f"{name} {what}", values[:, line] / 1e3, "kN")
                for key, (what, values) in columns.items()
            }
            for line, name in enumerate(lines.names)
        },
        "depth_m": {
            one.name: bands.of(one.name, -history.node.mean[:, one.node, 2], "m")
            for one in cage.depth_sensors
        },
    }
    return answer, bands.rows


def report_band(
    command: str,
    cage: "Cage | Structure",
    laws: Sequence[str],
    results: np.ndarray,
    about: Mapping[str, object],
    band: tuple[dict[str, Any], list[tuple[str, str]]],
) -> None:
    """Print a band, and fail where a law has no sound answer."""
    from seacage.conventions import RESULTS, Result, has_answer

    answer, rows = band
    report({"cage": cage.name, "origin": "computed", **about, **answer}, rows=rows)
    wrong = [
        f"{law}: {RESULTS[Result(code)]}"
        for law, code in zip(laws, map(int, results), strict=True)
        if not has_answer(np.array(code))
    ]
    if wrong:
        raise exit_with(f"{command}: {'; '.join(wrong)}.", Exit.FAILED)


class _Bands:
    """Collects the rows of a table while the bands of its quantities are made."""

    def __init__(self, laws: Sequence[str]) -> None:
        self._laws = laws
        self.rows = [("", " lowest central highest")]

    def of(self, name: str, values: Values, unit: str) -> Mapping[str, Any]:
        """Lowest, median and highest of the laws, and each law's own; null where unknown."""
        known = values[np.isfinite(values)]
        band = [float(of(known)) if len(known) else np.nan for of in (np.min, np.median, np.max)]
        if len(known) == len(values):
            digits = 1 if unit == "kN" else 2
            row = "".join(f"{value:8.{digits}f}" for value in band)
            self.rows.append((name, f"{row} {unit}".rstrip()))
        named = zip(("lowest", "central", "highest"), map(_number, band), strict=True)
        return {**dict(named), "by_law": dict(zip(self._laws, map(_number, values), strict=True))}


def _number(value: float) -> float | None:
    return round(float(value), 3) if isfinite(value) else None


def _size(force: Float[np.ndarray, "law 3"]) -> Values:
    return np.linalg.norm(force, axis=1)


def _by_law(laws: Sequence[str], results: np.ndarray) -> dict[str, int]:
    return dict(zip(laws, map(int, results), strict=True))
