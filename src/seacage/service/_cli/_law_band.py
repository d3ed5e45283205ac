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


def report_responses(
    cage: "Cage | Structure", response: "Response", laws: Sequence[str], about: Mapping[str, object]
) -> None:
    """Print the bands of equilibria, one for each law."""
    bands = _Bands(cage, laws)
    tensions = zip(response.line_names, response.line_tension.T / 1e3, strict=True)
    answer = {
        "net_load_kn": bands.of("Load on the net", _size(response.net_force) / 1e3, "kN"),
        "volume_fraction": bands.of("Volume kept", response.volume_fraction, ""),
        "lines": {name: {"tension_kn": bands.of(name, each, "kN")} for name, each in tensions},
        "depth_m": bands.of_depths(response.node_position),
    }
    bands.report("settle", response.result, about, **answer)


def report_histories(
    cage: "Cage | Structure", history: "History", laws: Sequence[str], about: Mapping[str, object]
) -> None:
    """Print the bands of histories in the same waves, one for each law."""
    bands, lines = _Bands(cage, laws), history.lines
    columns = {
        "mean_kn": ("mean", lines.tension.mean),
        "maximum_kn": ("largest", lines.tension.maximum),
        "mpm_3h_kn": ("3 h MPM", lines.extremes.mpm),
    }
    answer = {
        "net_load_kn": bands.of("Mean load on the net", _size(history.net_force.mean) / 1e3, "kN"),
        "volume_fraction": bands.of("Volume kept", history.volume_fraction, ""),
        "lines": {
            name: {
                key: bands.of(f"{name} {what}", values[:, line] / 1e3, "kN")
                for key, (what, values) in columns.items()
            }
            for line, name in enumerate(lines.names)
        },
        "depth_m": bands.of_depths(history.node.mean),
    }
    bands.report("simulate", history.result, about, **answer)


class _Bands:
    """Collects the rows of a table while the bands of its quantities are made."""

    def __init__(self, cage: "Cage | Structure", laws: Sequence[str]) -> None:
        self.cage, self.laws = cage, laws
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
        return {**dict(named), "by_law": dict(zip(self.laws, map(_number, values), strict=True))}

    def of_depths(self, position: Float[np.ndarray, "law node 3"]) -> Mapping[str, object]:
        """The bands of the depths of the cage's sensors."""
        sensors = self.cage.depth_sensors
        return {one.name: self.of(one.name, -position[:, one.node, 2], "m") for one in sensors}

    def report(
        self, command: str, results: np.ndarray, about: Mapping[str, object], **answer: object
    ) -> None:
        """Print the bands, and fail where a law has no sound answer."""
        from seacage.conventions import RESULTS, Result, has_answer

        by_law = dict(zip(self.laws, map(int, results), strict=True))
        about = {"cage": self.cage.name, "origin": "computed", **about, "result": by_law}
        report({**about, **answer}, rows=self.rows)
        unsound = [law for law, code in by_law.items() if not has_answer(np.array(code))]
        if unsound:
            wrong = "; ".join(f"{law}: {RESULTS[Result(by_law[law])]}" for law in unsound)
            raise exit_with(f"{command}: {wrong}.", Exit.FAILED)


def _number(value: float) -> float | None:
    return round(float(value), 3) if isfinite(value) else None


def _size(force: Float[np.ndarray, "law 3"]) -> Values:
    return np.linalg.norm(force, axis=1)
