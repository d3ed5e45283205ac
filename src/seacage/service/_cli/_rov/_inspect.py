"""``seacage inspect-path``: an ROV's way along the net."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._cli._console import guard, refusal, report
from seacage.service._cli._options import OutFile
from seacage.service._cli._rov._options import Below, NetOptions, about_rows

if TYPE_CHECKING:
    from seacage.service._rov._client import Ask
    from seacage.service._schemas._clearance import InspectionAnswer, InspectionQuery


@guard
def inspect_path(
    *,
    stand_off: Annotated[float, typer.Option(min=0.1)] = 2.0,
    side: Literal["inside", "outside"] = "inside",
    pattern: Literal["rows", "spiral"] = "rows",
    row_spacing: Annotated[float, typer.Option(min=0.1)] = 2.0,
    step: Annotated[float, typer.Option(min=0.1)] = 1.0,
    top: Annotated[float, typer.Option(min=0.0)] = 1.0,
    frame: Literal["enu", "ned", "wgs84"] = "enu",
    below: Below = 1.0,
    net: NetOptions,
    out: OutFile = None,
) -> None:
    """Lay an ROV's way along the net, facing it.

    The way follows the net that is to be expected, from the top to the tip, and every waypoint
    says how far the net is and how surely.

    Example:
        seacage inspect-path --to http://127.0.0.1:8000 --token TOKEN --out way.csv
        seacage inspect-path --twin twin --current-speed 0.4 --current-to 90 --out way.mcap

    Options:
        stand_off: Distance to keep, m.
        side: Of the net.
        pattern: Rows there and back, or one spiral.
        row_spacing: Between rows, m.
        step: Between waypoints, m.
        top: Depth of the first row, m.
        frame: Of the waypoints.
        out: Write the way as .csv, .mcap or .geojson.
    """
    from seacage.service._schemas._clearance import InspectionAnswer, InspectionQuery

    query = InspectionQuery(
        frame=frame,
        stand_off_m=stand_off,
        side=side,
        pattern=pattern,
        row_spacing_m=row_spacing,
        step_m=step,
        top_m=top,
        below_m=below,
        allow_stale=net.allow_stale,
        max_age_s=net.max_age,
    )
    ask = net.asker()
    answer = InspectionAnswer.model_validate_json(ask("inspection", query))
    if out is not None:
        _write_way(out, query, answer, ask)
    report(answer.model_dump(mode="json"), rows=_inspection_rows(answer, out))


def _write_way(out: Path, query: "InspectionQuery", answer: "InspectionAnswer", ask: "Ask") -> None:
    from seacage.service._rov._table import write_waypoints

    form = out.suffix.lower()
    if form == ".csv":
        write_waypoints(out, answer)
    elif form in {".mcap", ".geojson"}:
        out.write_bytes(ask(f"inspection{form}", query))
    else:
        raise refusal(f"{out}: a way is written as .csv, .mcap or .geojson.")


def _inspection_rows(answer: "InspectionAnswer", out: Path | None) -> list[tuple[str, str]]:
    known = [one.p_below for one in answer.waypoints if one.p_below is not None]
    likeliest = f"with {max(known):.3f} at most" if known else "with a probability not known"
    return [
        ("Waypoints", f"{len(answer.waypoints)} in {answer.parts} parts"),
        ("Left out", f"{answer.left_out} that could not keep off the net"),
        ("Too near", f"the net is nearer than {answer.below_m:g} m {likeliest}"),
        *about_rows(answer, out),
    ]
