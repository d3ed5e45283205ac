"""``seacage clearance`` and ``seacage inspect``: distances and ways for an ROV."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._console import Exit, Json, guarded, stopped, tell

if TYPE_CHECKING:
    from seacage.service._clearance_client import Asker
    from seacage.service._clearance_schemas import (
        ClearanceAnswer,
        FrameName,
        InspectionAnswer,
        InspectionAsked,
        PathAnswer,
        PointClearance,
    )
    from seacage.service._clearance_table import Row
    from seacage.twin import PredictedNet

TwinFolder = Annotated[
    Path | None,
    typer.Option(exists=True, file_okay=False, help="Folder of a twin, to be asked here."),
]
Speed = Annotated[float | None, typer.Option(min=0.0, help="With --twin: the current, m/s.")]
Towards = Annotated[
    float | None,
    typer.Option(help="With --twin: where it goes, degrees clockwise from north."),
]
Hs = Annotated[float, typer.Option(min=0.0, help="With --twin: significant wave height, m.")]
WaveFrom = Annotated[float, typer.Option(help="With --twin: where the waves come from, degrees.")]
To = Annotated[
    str | None, typer.Option(help="Address of a running service, as http://127.0.0.1:8000.")
]
CageThere = Annotated[str, typer.Option("--cage", help="The cage's name there.")]
Token = Annotated[
    str, typer.Option(envvar="SEACAGE_TOKEN", help="For the service, with the scope read.")
]
AllowStale = Annotated[
    bool, typer.Option("--allow-stale", help="Take the last reading however old it is.")
]
MaxAge = Annotated[
    float | None, typer.Option("--max-age", min=0.0, help="Refuse a reading older than this, s.")
]
Below = Annotated[float, typer.Option(min=0.0, max=100.0, help="Distance asked about, m.")]


@guarded
def clearance(
    points: Annotated[
        Path | None,
        typer.Argument(
            exists=True,
            dir_okay=False,
            help="CSV with east_m,north_m,up_m or north_m,east_m,down_m or "
            "latitude_deg,longitude_deg,depth_m.",
        ),
    ] = None,
    *,
    point: Annotated[
        list[str] | None, typer.Option(help='One point, "EAST,NORTH,UP" in m; may be repeated.')
    ] = None,
    path: Annotated[
        bool, typer.Option("--path", help="Look at the straight lines between the points, too.")
    ] = False,
    below: Below = 1.0,
    most: Annotated[
        float | None,
        typer.Option(min=0.0, max=1.0, help="End with 4 where the probability is higher."),
    ] = None,
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
        Path | None, typer.Option(dir_okay=False, help="Write one line per point as CSV.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Say how far points or a path are from the net, and how surely.

    Asks a running service about its net now, or a twin's folder about a current. Distances
    are to the predicted net; the probability that the true one is nearer than --below takes in
    what the twin knows of its own error. Ends with 4 where it exceeds --most: for --path that
    of the whole path, else that of any point.

    Example:
        seacage clearance way.csv --path --most 0.05 --to http://127.0.0.1:8000 --token TOKEN
        seacage clearance --point 20,0,-8 --twin twin --current-speed 0.4 --current-to 90
    """
    from seacage.service._clearance import clearance_answer
    from seacage.service._clearance_table import asked_of, write_clearances

    frame, rows = _points(points, point or [])
    asked = asked_of(
        frame,
        rows,
        as_path=path,
        below_m=below,
        allow_stale=allow_stale,
        max_age_s=max_age,
    )
    net = _net(twin, to, current_speed, current_to, hs, wave_from)
    answer = (
        _asker(to, cage, token).clearance(asked) if net is None else clearance_answer(net, asked)
    )
    if out is not None:
        write_clearances(out, rows, answer)
    likeliest = max(one.p_below for one in answer.points)
    p = answer.path.p_below if answer.path else likeliest
    tell(answer.model_dump(mode="json"), as_json=as_json, rows=_clearance_rows(answer, out))
    if most is not None and p > most:
        raise stopped(
            f"clearance: the net is nearer than {below:g} m with probability {p:.3f}, which is "
            f"more than {most:g}.",
            Exit.EXCEEDED,
        )


@guarded
def inspect(
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
        seacage inspect --to http://127.0.0.1:8000 --token TOKEN --out way.csv
        seacage inspect --twin twin --current-speed 0.4 --current-to 90 --out way.mcap
    """
    from seacage.service._clearance import inspection_answer
    from seacage.service._clearance_schemas import InspectionAsked

    asked = InspectionAsked(
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
    net = _net(twin, to, current_speed, current_to, hs, wave_from)
    asker = _asker(to, cage, token) if net is None else None
    answer = asker.inspection(asked) if asker else inspection_answer(_known(net), asked)
    if out is not None:
        _write_way(out, asked, answer, net, asker)
    tell(answer.model_dump(mode="json"), as_json=as_json, rows=_inspection_rows(answer, out))


def _points(path: Path | None, given: list[str]) -> "tuple[FrameName, list[Row]]":
    from seacage.conventions import InputError
    from seacage.service._clearance_table import read_points

    if (path is None) == (not given):
        raise InputError("clearance: give a CSV file of points, or some with --point; one of them.")
    if path is not None:
        return read_points(path)
    rows = list["Row"]()
    for one in given:
        try:
            east, north, up = (float(part) for part in one.split(","))
        except ValueError as error:
            raise InputError(
                f'clearance: --point {one!r} is not three numbers. Give "EAST,NORTH,UP" in m.'
            ) from error
        rows.append((east, north, up))
    return "enu", rows


def _net(
    folder: Path | None,
    to: str | None,
    speed: float | None,
    towards: float | None,
    hs: float,
    wave_from: float,
) -> "PredictedNet | None":
    """The net of a twin's folder in a current; None where a service is asked."""
    from seacage.conventions import InputError

    if (folder is None) == (to is None):
        raise InputError("Say whom to ask: --twin for a folder, or --to for a service.")
    if folder is None:
        return None
    if speed is None or towards is None:
        raise InputError(
            "With --twin the current has to be said: --current-speed in m/s and --current-to in "
            "degrees."
        )
    from datetime import UTC, datetime

    from seacage.ocean import SeaState
    from seacage.twin import Answered, Metocean, PredictedNet, Twin

    asked = Twin.read(folder)
    water = Metocean.of(
        SeaState(current_speed=speed, current_to=towards, hs=hs, wave_from=wave_from)
    )
    # What is asked about is now, and as fresh as the question.
    answered = Answered(
        t=datetime.now(UTC), answer=asked.predict(water), metocean=water, input_age_s=0.0
    )
    return PredictedNet.of(asked, answered)


def _known(net: "PredictedNet | None") -> "PredictedNet":
    assert net is not None  # whoever is not asked over there is asked here
    return net


def _asker(to: str | None, cage: str, token: str) -> "Asker":
    from seacage.service._clearance_client import Asker

    assert to is not None  # `_net` refused both and neither
    return Asker(address=to, cage=cage, token=token)


def _write_way(
    out: Path,
    asked: "InspectionAsked",
    answer: "InspectionAnswer",
    net: "PredictedNet | None",
    asker: "Asker | None",
) -> None:
    from seacage.conventions import InputError
    from seacage.service._clearance import inspection_of
    from seacage.service._clearance_table import write_waypoints
    from seacage.service._rov_files import inspection_geojson, inspection_mcap

    form = out.suffix.lower()
    if form == ".csv":
        write_waypoints(out, answer)
    elif form not in {".mcap", ".geojson"}:
        raise InputError(f"{out}: a way is written as .csv, .mcap or .geojson.")
    elif asker is not None:
        out.write_bytes(asker.ask(f"inspection{form}", asked.model_dump_json(exclude_none=True)))
    else:
        write = inspection_mcap if form == ".mcap" else inspection_geojson
        out.write_bytes(write(_known(net), inspection_of(_known(net), asked)))


def _clearance_rows(answer: "ClearanceAnswer", out: Path | None) -> list[tuple[str, str]]:
    rows = [
        (
            f"Point {number}",
            _point_row(one, answer.below_m),
        )
        for number, one in enumerate(answer.points[:20], start=1)
    ]
    if len(answer.points) > len(rows):
        rows.append(("…", f"{len(answer.points) - len(rows)} more; see them all with --json"))
    if answer.path:
        rows.append(("Path", _path_row(answer.path, answer.below_m)))
    return rows + _about_rows(answer, out)


def _point_row(point: "PointClearance", below_m: float) -> str:
    return (
        f"{point.distance_m:.2f} m {'inside' if point.inside else 'outside'}; expected "
        f"{point.expected_m:.2f} m ± {point.sigma_m:.2f} m; nearer than {below_m:g} m with "
        f"probability {point.p_below:.3f}"
    )


def _path_row(path: "PathAnswer", below_m: float) -> str:
    return (
        f"{path.length_m:.1f} m; closest {path.closest.distance_m:.2f} m after "
        f"{path.along_m:.1f} m; nearer than {below_m:g} m somewhere with probability "
        f"{path.p_below:.3f} ({path.p_least:.3f} to {path.p_most:.3f})"
    )


def _inspection_rows(answer: "InspectionAnswer", out: Path | None) -> list[tuple[str, str]]:
    likeliest = max(one.p_below for one in answer.waypoints)
    return [
        ("Waypoints", f"{len(answer.waypoints)} in {answer.parts} parts"),
        ("Left out", f"{answer.left_out} that could not keep off the net"),
        ("Too near", f"the net is nearer than {answer.below_m:g} m with {likeliest:.3f} at most"),
        *_about_rows(answer, out),
    ]


def _about_rows(
    answer: "ClearanceAnswer | InspectionAnswer", out: Path | None
) -> list[tuple[str, str]]:
    learned = answer.shape_error
    error = f"learned from: {learned}" if learned else "not known; the probabilities are too sure"
    rows = [("Shape error", error), ("State", f"{answer.state_age_s:.0f} s old")]
    if not answer.in_domain:
        rows.append(("Extrapolating", "the twin has not learned about such a current"))
    return rows if out is None else [*rows, ("Written", str(out))]
