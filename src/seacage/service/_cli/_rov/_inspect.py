"""``seacage inspect-path``: an ROV's way along the net."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._cli._console import Json, guard, report
from seacage.service._cli._rov._options import (
    AllowStale,
    Below,
    CageThere,
    Hs,
    MaxAge,
    Speed,
    To,
    Token,
    Towards,
    TwinFolder,
    WaveFrom,
    about_rows,
    asker_of,
    net_of,
)

if TYPE_CHECKING:
    from seacage.service._rov._client import Asker
    from seacage.service._schemas._clearance import InspectionAnswer, InspectionQuery
    from seacage.twin import PredictedNet


@guard
def inspect_path(
    *,
    stand_off: Annotated[float, typer.Option(min=0.1, help="Distance to keep, m.")] = 2.0,
    side: Annotated[Literal["inside", "outside"], typer.Option(help="Of the net.")] = "inside",
    pattern: Annotated[
        Literal["rows", "spiral"], typer.Option(help="Rows there and back, or one spiral.")
    ] = "rows",
    row_spacing: Annotated[float, typer.Option(min=0.1, help="Between rows, m.")] = 2.0,
    step: Annotated[float, typer.Option(min=0.1, help="Between waypoints, m.")] = 1.0,
    top: Annotated[float, typer.Option(min=0.0, help="Depth of the first row, m.")] = 1.0,
    frame: Annotated[
        Literal["enu", "ned", "wgs84"], typer.Option(help="Of the waypoints.")
    ] = "enu",
    below: Below = 1.0,
    twin: TwinFolder = None,
    current_speed: Speed = None,
    current_to: Towards = None,
    hs: Hs = 0.0,
    wave_from: WaveFrom = 0.0,
    to: To = None,
    cage: CageThere = "ace",
    token: Token = "",
    allow_stale: AllowStale = False,
    max_age: MaxAge = None,
    out: Annotated[
        Path | None,
        typer.Option(dir_okay=False, help="Write the way as .csv, .mcap or .geojson."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Lay an ROV's way along the net, facing it.

    The way follows the net that is to be expected, from the top to the tip, and every waypoint
    says how far the net is and how surely.

    Example:
        seacage inspect-path --to http://127.0.0.1:8000 --token TOKEN --out way.csv
        seacage inspect-path --twin twin --current-speed 0.4 --current-to 90 --out way.mcap
    """
    from seacage.service._rov._clearance import inspection_answer
    from seacage.service._schemas._clearance import InspectionQuery

    query = InspectionQuery(
        frame=frame,
        stand_off_m=stand_off,
        side=side,
        pattern=pattern,
        row_spacing_m=row_spacing,
        step_m=step,
        top_m=top,
        below_m=below,
        allow_stale=allow_stale,
        max_age_s=max_age,
    )
    net = net_of(twin, to, current_speed, current_to, hs, wave_from)
    asker = asker_of(to, cage, token) if net is None else None
    answer = asker.inspection(query) if asker else inspection_answer(_here(net), query)
    if out is not None:
        _write_way(out, query, answer, net, asker)
    report(answer.model_dump(mode="json"), as_json=as_json, rows=_inspection_rows(answer, out))


def _here(net: "PredictedNet | None") -> "PredictedNet":
    assert net is not None  # whoever is not asked over there is asked here
    return net


def _write_way(
    out: Path,
    query: "InspectionQuery",
    answer: "InspectionAnswer",
    net: "PredictedNet | None",
    asker: "Asker | None",
) -> None:
    from seacage.conventions import InputError
    from seacage.service._rov._clearance import inspection_of
    from seacage.service._rov._files import inspection_geojson, inspection_mcap
    from seacage.service._rov._table import write_waypoints

    form = out.suffix.lower()
    if form == ".csv":
        write_waypoints(out, answer)
    elif form not in {".mcap", ".geojson"}:
        raise InputError(f"{out}: a way is written as .csv, .mcap or .geojson.")
    elif asker is not None:
        out.write_bytes(asker.ask(f"inspection{form}", query.model_dump_json(exclude_none=True)))
    else:
        write = inspection_mcap if form == ".mcap" else inspection_geojson
        out.write_bytes(write(_here(net), inspection_of(_here(net), query)))


def _inspection_rows(answer: "InspectionAnswer", out: Path | None) -> list[tuple[str, str]]:
    known = [one.p_below for one in answer.waypoints if one.p_below is not None]
    likeliest = f"with {max(known):.3f} at most" if known else "with a probability not known"
    return [
        ("Waypoints", f"{len(answer.waypoints)} in {answer.parts} parts"),
        ("Left out", f"{answer.left_out} that could not keep off the net"),
        ("Too near", f"the net is nearer than {answer.below_m:g} m {likeliest}"),
        *about_rows(answer, out),
    ]
