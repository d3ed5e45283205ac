"""``seacage clearance`` and ``inspect-path``: distances from the net, and a way along it."""

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._cli._console import Exit, exit_with, refusal, report
from seacage.service._cli._options import InFolder, OutFile, ServedCage

if TYPE_CHECKING:
    from seacage.service._rov._client import Ask
    from seacage.service._rov._table import Row
    from seacage.service._schemas import _clearance as schemas

Below = Annotated[float, typer.Option(min=0.0, max=100.0, help="Distance asked about, m.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class NetOptions:
    """The net that is asked about: of a twin's folder in a current, or of a running service.

    Options:
        twin: Folder of a twin, to be asked here.
        current_speed: With --twin: the current, m/s.
        current_to: With --twin: where it goes, degrees clockwise from north.
        hs: With --twin: significant wave height, m.
        wave_from: With --twin: where the waves come from, degrees.
        to: Address of a running service, as http://127.0.0.1:8000.
        token: For the service, with the scope read.
        allow_stale: Take the last reading however old it is.
        max_age: Refuse a reading older than this, s.
    """

    twin: InFolder = None
    current_speed: Annotated[float | None, typer.Option(min=0.0)] = None
    current_to: float | None = None
    hs: Annotated[float, typer.Option(min=0.0)] = 0.0
    wave_from: float = 0.0
    to: str | None = None
    cage: ServedCage = "ace"
    token: Annotated[str, typer.Option(envvar="SEACAGE_TOKEN")] = ""
    allow_stale: Annotated[bool, typer.Option("--allow-stale")] = False
    max_age: Annotated[float | None, typer.Option("--max-age", min=0.0)] = None

    def asker(self) -> "Ask":
        """A function that answers from the twin's folder, or from the service.

        Raises InputError: both or neither was named, or the twin without a current.
        """
        from seacage.service._rov._client import ANSWERS, ServiceAsker

        if (self.twin is None) == (self.to is None):
            raise refusal("Say whom to ask: --twin for a folder, or --to for a service.")
        if self.to is not None:
            return ServiceAsker(address=self.to, cage=self.cage, token=self.token).ask
        if self.twin is None or self.current_speed is None or self.current_to is None:
            raise refusal(
                "With --twin the current has to be said: --current-speed in m/s and --current-to "
                "in degrees."
            )
        from seacage.ocean import SeaState
        from seacage.twin import PredictedNet, Twin

        sea = SeaState(
            current_speed=self.current_speed,
            current_to=self.current_to,
            hs=self.hs,
            wave_from=self.wave_from,
        )
        predicted = PredictedNet.under(Twin.read(self.twin), sea, t=datetime.now(UTC))
        return lambda call, query: ANSWERS[call](predicted, query)


def clearance(
    points: Annotated[Path | None, typer.Argument(exists=True, dir_okay=False)] = None,
    *,
    point: list[str] | None = None,
    path: Annotated[bool, typer.Option("--path")] = False,
    below: Below = 1.0,
    most: Annotated[float | None, typer.Option(min=0.0, max=1.0)] = None,
    net: NetOptions,
    out: OutFile = None,
) -> None:
    """Measure how far points or a path are from the net, with the uncertainty.

    Asks a running service about its net now, or a twin's folder about a current. Distances
    are to the predicted net; the probability that the true one is nearer than --below takes in
    what the twin knows of its own error. Ends with 4 where it exceeds --most: for --path that
    of the whole path, else that of any point.

    Example:
        seacage clearance way.csv --path --most 0.05 --to http://127.0.0.1:8000 --token TOKEN
        seacage clearance --point 20,0,-8 --twin twin --current-speed 0.4 --current-to 90

    Options:
        points: CSV with east_m,north_m,up_m or north_m,east_m,down_m or
            latitude_deg,longitude_deg,depth_m.
        point: One point, "EAST,NORTH,UP" in m; may be repeated.
        path: Look at the straight lines between the points, too.
        most: End with 4 where the probability is higher.
        out: Write one line per point as CSV.
    """
    from seacage.service._rov._table import query_of, write_clearances
    from seacage.service._schemas._clearance import ClearanceAnswer

    frame, rows = _points(points, point or [])
    query = query_of(
        frame, rows, as_path=path, below_m=below, allow_stale=net.allow_stale, max_age_s=net.max_age
    )
    answer = ClearanceAnswer.model_validate_json(net.asker()("clearance", query))
    if out is not None:
        write_clearances(out, rows, answer)
    known = [one.p_below for one in answer.points if one.p_below is not None]
    p = answer.path.p_below if answer.path else max(known, default=None)
    report(answer.model_dump(mode="json"), rows=_clearance_rows(answer, out))
    if most is not None and p is None:
        raise refusal(
            f"clearance: whether the net is nearer than {below:g} m cannot be held against --most "
            f"{most:g}, for this twin's shape error is not known. Leave --most out and go by the "
            "distance."
        )
    if most is not None and p is not None and p > most:
        raise exit_with(
            f"clearance: the net is nearer than {below:g} m with probability {p:.3f}, which is "
            f"more than {most:g}.",
            Exit.EXCEEDED,
        )


def _points(path: Path | None, given: list[str]) -> "tuple[schemas.FrameName, list[Row]]":
    from seacage.service._rov._table import read_points

    if (path is None) == (not given):
        raise refusal("clearance: give a CSV file of points, or some with --point; one of them.")
    if path is not None:
        return read_points(path)
    rows = list["Row"]()
    for one in given:
        try:
            east, north, up = (float(part) for part in one.split(","))
        except ValueError as error:
            raise refusal(
                f'clearance: --point {one!r} is not three numbers. Give "EAST,NORTH,UP" in m.'
            ) from error
        rows.append((east, north, up))
    return "enu", rows


def _clearance_rows(answer: "schemas.ClearanceAnswer", out: Path | None) -> list[tuple[str, str]]:
    rows = [
        (f"Point {number}", _point_row(one, answer.below_m))
        for number, one in enumerate(answer.points[:20], start=1)
    ]
    if len(answer.points) > len(rows):
        rows.append(("…", f"{len(answer.points) - len(rows)} more; see them all with --json"))
    if answer.path:
        rows.append(("Path", _path_row(answer.path, answer.below_m)))
    return rows + _about_rows(answer, out)


def _point_row(point: "schemas.PointClearance", below_m: float) -> str:
    text = f"{point.distance_m:.2f} m {'inside' if point.inside else 'outside'}"
    if point.p_below is None:
        return text
    return (
        f"{text}; expected {point.expected_m:.2f} m ± {point.sigma_m:.2f} m; nearer than "
        f"{below_m:g} m with probability {point.p_below:.3f}"
    )


def _path_row(path: "schemas.PathAnswer", below_m: float) -> str:
    text = (
        f"{path.length_m:.1f} m; closest {path.closest.distance_m:.2f} m after {path.along_m:.1f} m"
    )
    if path.p_below is None:
        return text
    return (
        f"{text}; nearer than {below_m:g} m somewhere with probability "
        f"{path.p_below:.3f} ({path.p_least:.3f} to {path.p_most:.3f})"
    )


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
    says how far the net is, with the uncertainty.

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


def _write_way(
    out: Path, query: "schemas.InspectionQuery", answer: "schemas.InspectionAnswer", ask: "Ask"
) -> None:
    from seacage.service._rov._table import write_waypoints

    form = out.suffix.lower()
    if form == ".csv":
        write_waypoints(out, answer)
    elif form in {".mcap", ".geojson"}:
        out.write_bytes(ask(f"inspection{form}", query))
    else:
        raise refusal(f"{out}: a way is written as .csv, .mcap or .geojson.")


def _inspection_rows(answer: "schemas.InspectionAnswer", out: Path | None) -> list[tuple[str, str]]:
    known = [one.p_below for one in answer.waypoints if one.p_below is not None]
    likeliest = f"with {max(known):.3f} at most" if known else "with a probability not known"
    return [
        ("Waypoints", f"{len(answer.waypoints)} in {answer.parts} parts"),
        ("Left out", f"{answer.left_out} that could not keep off the net"),
        ("Too near", f"the net is nearer than {answer.below_m:g} m {likeliest}"),
        *_about_rows(answer, out),
    ]


def _about_rows(
    answer: "schemas.ClearanceAnswer | schemas.InspectionAnswer", out: Path | None
) -> list[tuple[str, str]]:
    """Say what an answer rests on, and where it was written."""
    learned = answer.shape_error
    error = f"learned from: {learned}" if learned else "not known, and so no probability"
    rows = [("Shape error", error), ("State", f"{answer.state_age_s:.0f} s old")]
    if answer.unlike:
        rows.append(("Unlike others", answer.unlike))
    if not answer.in_domain:
        rows.append(("Extrapolating", "the twin has not learned about such a current"))
    return rows if out is None else [*rows, ("Written", str(out))]
