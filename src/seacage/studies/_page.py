"""A report: a page that needs nothing beside itself, and its numbers for programs."""

import base64
import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from seacage.figures import svg_text
from seacage.studies._text import join_names, number, percent

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def render(template: str, **values: object) -> str:
    """A file of ``templates`` filled with values; all text is escaped on its way in."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    pages = Environment(
        loader=PackageLoader("seacage.studies"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    pages.filters |= {
        "number": number,
        "percent": percent,
        "names": join_names,
        "embedded": _embedded,
        "mean": lambda values: float(np.mean(list(values))),
        "median": lambda values: float(np.median(list(values))),
    }
    return pages.get_template(template).render(values)


def _embedded(figure: "Figure") -> str:
    """A figure as the address of an SVG image, which keeps its identifiers to itself."""
    return f"data:image/svg+xml;base64,{base64.b64encode(svg_text(figure).encode()).decode()}"


def write_report(
    out: Path,
    template: str,  # of the page, which shows the scores
    scores: Mapping[str, object],  # by name, as programs read them
    values: Mapping[str, object],  # of the page alone
) -> tuple[Path, Path]:
    """Write the page and the scores of a study into a folder, and name both files."""
    page = render(template, **{**scores, **values})
    out.mkdir(parents=True, exist_ok=True)
    report, numbers = out / "report.html", out / "scores.json"
    report.write_text(page, encoding="utf-8")
    write_scores(numbers, scores)
    return report, numbers


def write_scores(path: Path, scores: Mapping[str, object]) -> None:
    """Write scores and what belongs to them as JSON."""
    path.write_text(json.dumps(scores, default=_plain, indent=2) + "\n", encoding="utf-8")


def _plain(value: object) -> object:
    """What JSON can hold, of what it cannot."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if is_dataclass(value) and not isinstance(value, type):
        return {
            part.metadata.get("key", part.name): getattr(value, part.name) for part in fields(value)
        }
    raise TypeError(f"{type(value)} has no place in a score file")
