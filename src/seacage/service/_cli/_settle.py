"""``seacage settle``: one sea state."""

from itertools import chain, repeat
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._cli import _options
from seacage.service._cli._console import report_case

if TYPE_CHECKING:
    from seacage.cage import Cage, Structure
    from seacage.dynamics import Response


def settle(
    *,
    sea: _options.SeaOptions,
    mean_waves: Annotated[bool, typer.Option("--mean-waves")] = False,
    cage: _options.CageName = "ace",
    law: _options.Law = "kristiansen-faltinsen",
    net: _options.LawOptions,
    mooring: _options.Mooring = "catenary",
    without: _options.Without = None,
    out: _options.OutFile = None,
) -> None:
    """Settle one sea state: shape and loads.

    The cage comes to rest in a current. An equilibrium knows no waves: with --hs say
    --mean-waves, which takes in their mean drag.

    Example: half a metre per second towards east.
        seacage settle --current-speed 0.5 --current-to 90

    Options:
        mean_waves: Take the waves in by their mean drag.
        out: Write the response as CF-NetCDF.
    """
    from seacage.conventions import extension_names
    from seacage.dynamics import LAWS, law_label
    from seacage.dynamics import settle as settled

    net.check_files(out)
    state, subject = sea.state(), _options.read_cage_or_structure(cage)
    parted = without or []
    warnings = [*subject.warnings, *_options.warn_of(mooring)]
    laws = (law,) if net.laws is None else (*LAWS, *extension_names("screen_laws"))
    response = settled(
        subject,
        [state] * len(laws) if net.laws else state,
        law=laws if net.laws else law,
        skin_friction=net.skin_friction,
        lift_factor=net.lift_factor,
        mooring=mooring,
        mean_waves=mean_waves,
        parted=parted,
    )
    _options.warn(response.warnings)
    warnings += response.warnings
    about: dict[str, object] = {"mooring": mooring, "warnings": warnings, **net.changes}
    about |= {"without": parted} if parted else {}
    if net.laws is not None:
        from seacage.service._cli._law_band import report_responses

        report_responses(subject, response, laws, about)
        return
    answer = _answer(subject, response) | about
    if out is not None:
        from seacage.service._export import write_response

        write_response(out, subject, state, law_label(law), response, net.changes)
        answer["written"] = str(out)
    report_case("settle", answer, response.result, _rows(subject, response))


def _answer(cage: "Cage | Structure", response: "Response") -> dict[str, object]:
    tension, force = response.bridle_tension / 1e3, response.net_force / 1e3
    depth = -response.node_position[:, 2]
    return {
        "cage": cage.name,
        "origin": "computed",
        "result": int(response.result),
        "residual_n": float(response.residual),
        "net_force_kn": force.round(3).tolist(),
        "volume_m3": round(float(response.volume), 1),
        "volume_fraction": round(float(response.volume_fraction), 4),
        "bridle_tension_kn": dict(zip(cage.bridle_names, tension.round(3).tolist(), strict=True)),
        "line_tension_kn": dict(
            zip(response.line_names, (response.line_tension / 1e3).round(3).tolist(), strict=True)
        ),
        "anchor_uplift_kn": (response.anchor_load[:, 2] / 1e3).round(3).tolist(),
        "depth_m": {one.name: round(float(depth[one.node]), 3) for one in cage.depth_sensors},
        "bottom_displacement_m": response.node_displacement[cage.bottom_node].round(3).tolist(),
    }


def _rows(cage: "Cage | Structure", response: "Response") -> list[tuple[str, str]]:
    east, north, up = response.net_force / 1e3
    bottom = -response.node_position[cage.bottom_node, 2]
    lift = response.node_displacement[cage.bottom_node, 2]
    rows = [
        ("Load on the net", f"{east:.1f} kN east, {north:.1f} kN north, {up:.1f} kN up"),
        ("Volume", f"{response.volume:.0f} m3, {response.volume_fraction:.1%} of still water"),
        ("Bottom", f"{bottom:.2f} m deep, {lift:+.2f} m against still water"),
        ("Residual", f"{response.residual:.2f} N at the worst node"),
    ]
    capacities = chain(cage.bridle_capacity, repeat(0.0))  # the bridles come first
    tensions = zip(response.line_names, response.line_tension, capacities, strict=False)
    rows += [
        (n, f"{load / 1e3:6.1f} kN" + (f", {load / most:.0%} of capacity" if most > 0.0 else ""))
        for n, load, most in tensions
    ]
    depth = -response.node_position[:, 2]
    return rows + [(one.name, f"{depth[one.node]:6.2f} m") for one in cage.depth_sensors]
