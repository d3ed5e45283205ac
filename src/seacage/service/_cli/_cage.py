"""``seacage cage``: a cage's file from its main dimensions, its derived numbers, its drawing."""

import math
import sys
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from seacage.service._cli._console import Exit, exit_with, refusal, report, wants_json
from seacage.service._cli._options import read_cage, warn

if TYPE_CHECKING:
    from seacage.cage import Cage

_ENDINGS = (".png", ".svg", ".pdf")
_RING_DISTANCE, _SPOKES = 3.0, 32  # of the mesh, about [m, -]
_MOST_RINGS = 40  # of the cylinder, and of the cone
_SCOPE = 3.0  # rope of an anchor line over the depth of the sea bed below the frame


@dataclass(frozen=True, slots=True, kw_only=True)
class DimensionOptions:
    """Main dimensions.

    Options:
        circumference: Of the collar, m. [default: 120]
        cylinder_depth: Of the cylinder's lower edge, m. [default: 15]
        tip_depth: Of the cone's tip, m. [default: 22]
        bridles: 4 to 24 by fours. [default: 8]
        frame_side: Of the square mooring frame, m. [default: 1.7 diameters of the collar]
        twine_diameter: Of the netting, m. [default: 0.00285]
        half_mesh: From twine to twine, m. [default: 0.0255]
        sinker_weight: Of the sinker tube in water, N/m. [default: 570]
        tip_weight: In the cone's tip, in water, N. [default: 980]
        water_depth: Still water to sea bed, m. [default: 60]
        latitude: Of the cage's centre, degrees, north positive.
        longitude: Of the cage's centre, degrees, east positive.
    """

    circumference: float | None = None
    cylinder_depth: float | None = None
    tip_depth: float | None = None
    bridles: int | None = None
    frame_side: float | None = None
    twine_diameter: float | None = None
    half_mesh: float | None = None
    sinker_weight: float | None = None
    tip_weight: float | None = None
    water_depth: float | None = None
    latitude: float | None = None
    longitude: float | None = None


def new(
    file: Annotated[Path, typer.Argument(dir_okay=False, metavar="FILE")],
    *,
    dimensions: DimensionOptions,
) -> None:
    """Write a cage's file from its main dimensions, with the meaning of each key beside it.

    What is not given is asked for on a terminal, and takes its default elsewhere. All else is
    the reference cage's in proportion, as the file says. A file that is there is kept.

    Example: a cage of 120 m in 60 m of water.
        seacage cage new mine.toml --circumference 120 --water-depth 60

    Options:
        file: The cage's file, ending in .toml.
    """
    from seacage.cage import cage_remarks
    from seacage.conventions import read_packaged_table

    if file.suffix != ".toml" or file.exists():
        why = "is there already and is kept" if file.exists() else "does not end in .toml"
        raise refusal(f"cage new: {file} {why}. Give another name.")
    texts = read_packaged_table(__package__ or "", "new_cage.toml")
    given = {name: value for name, value in asdict(dimensions).items() if value is not None}
    if sys.stdin.isatty() and not wants_json():
        given |= _answers(texts, given)
    chosen = texts["defaults"] | given
    cage = _cage(file.stem, chosen)
    head = texts["texts"]["head"].format(given=", ".join(f"{k} {v:g}" for k, v in chosen.items()))
    # An empty list would forbid the tables that a sensor is added by.
    body = cage.to_toml().replace("shackle = []\ndepth_sensor = []\n", "")
    text = f"{head}{body}{texts['texts']['sensors']}"
    file.write_text(text, "utf-8")
    warn(f"{file}:{one.line}: {one.sentence}" for one in cage_remarks(cage, text))
    following = [
        f"seacage cage check {file}",
        f"seacage cage draw {file} --out {file.with_suffix('.png')}",
        f"seacage settle --cage {file} --current-speed 0.5 --current-to 90",
    ]
    written = f"{file}: {cage.bridle_count} bridles, {cage.node_count} nodes"
    report(
        {"written": str(file), "cage": cage.name, "nodes": cage.node_count, "next": following},
        rows=[("Written", written), *(("Next", command) for command in following)],
    )


def _answers(texts: dict[str, Any], given: dict[str, Any]) -> dict[str, Any]:
    """Answers to questions for what is not given; without one the default is taken."""

    def number(text: str) -> float | int | None:
        try:
            return (int(text) if text.isdigit() else float(text)) if text.strip() else None
        except ValueError as error:
            raise typer.BadParameter(f"{text!r} is no number; the unit is left out.") from error

    answers = dict[str, Any]()
    for name, question in texts["questions"].items():
        known = given | answers
        if name not in given and not (name == "longitude" and known["latitude"] is None):
            answers[name] = typer.prompt(
                question, default=f"{texts['defaults'].get(name, '')}", value_proc=number
            )
    return {name: answer for name, answer in answers.items() if answer is not None}


def _cage(name: str, given: dict[str, Any]) -> "Cage":
    """A cage of main dimensions; all else is the reference cage's, in proportion."""
    from seacage.cage import Cage
    from seacage.conventions import GRAVITY, WATER_DENSITY

    ace = replace(Cage.named("ace"), name=name, shackle=(), depth_sensor=())
    for key, value in given.items():
        if not math.isfinite(value):
            raise refusal(f"cage new: {key} = {value} is no finite number. Give one.")
    if given["bridles"] not in range(4, 25, 4):
        raise refusal(
            f"cage new: {given['bridles']} bridles do not share out over four corners. Give 4, 8, "
            "12, 16, 20 or 24; for another number edit bearings_deg of the file."
        )
    radius, each = given["circumference"] / (2.0 * math.pi), given["bridles"] // 4 + 1
    side: float = given.get("frame_side") or -(-3.4 * radius // 1.0)
    twine = {f"{key}_m": given[key] for key in ("twine_diameter", "half_mesh")}
    cloth = (given["twine_diameter"] / ace.netting.twine_diameter) ** 2
    cloth *= ace.netting.half_mesh / given["half_mesh"] if given["half_mesh"] else 1.0
    tube = given["sinker_weight"] / GRAVITY + WATER_DENSITY * ace.sinker_tube.displaced
    depth = min(ace.frame.depth, round(0.4 * given["water_depth"], 1))
    rope = _SCOPE * (given["water_depth"] - depth)
    chain = min(ace.bridles.chain_length, 0.3 * max(math.sqrt(0.5) * side - radius, 1.0))
    bearings = [
        round((90.0 - 90.0 * corner - 90.0 / each * number) % 360.0, 2)
        for corner in range(4)
        for number in range(1, each)
    ]
    place = {f"{key}_deg": given[key] for key in ("latitude", "longitude") if key in given}
    return ace.altered(
        site={"water_depth_m": given["water_depth"], **place},
        mesh=_mesh(given["cylinder_depth"], given["tip_depth"], 4 * each),
        collar={"radius_m": round(radius, 4), "brackets": max(round(radius * 2.4), 3)},
        netting={
            **twine,
            "mass_kg_m2": round(ace.netting.mass * cloth, 4),
            "displaced_kg_m2": round(ace.netting.displaced * cloth, 4),
        },
        sinker_tube={"weight_n_m": given["sinker_weight"], "mass_kg_m": round(tube, 1)},
        tip={"weight_n": given["tip_weight"]},
        frame={"side_m": side, "depth_m": depth},
        anchor_lines={"rope_length_m": float(round(max(rope, 0.0)))},
        bridles={
            "bearings_deg": bearings,
            "length_offset_m": [0.0] * len(bearings),
            "chain_length_m": round(chain, 2),
        },
    )


def _mesh(cylinder: float, tip: float, least: int) -> dict[str, Any]:
    """Rings about evenly over cylinder and cone, and spokes in multiples of the least number."""

    def rings(start: float, end: float) -> list[float]:
        count = min(max(round((end - start) / _RING_DISTANCE), 2), _MOST_RINGS)
        return [start, *(round(start + (end - start) * n / count, 2) for n in range(1, count))]

    return {
        "ring_depths_m": [*rings(0.0, cylinder), *rings(cylinder, tip)],
        "cylinder_depth_m": cylinder,
        "tip_depth_m": tip,
        "spokes": least * max(round(_SPOKES / least), 1),
    }


def check(
    file: Annotated[Path, typer.Argument(exists=True, dir_okay=False, metavar="FILE")],
) -> None:
    """Check a cage's file: every key and number, and whether the cage settles in still water.

    All that is wrong is named at once, by its line, and ends with code 2. Numbers that can be and
    are odd are warned of. Then come the derived numbers.

    Example:
        seacage cage check mine.toml

    Options:
        file: The cage's file.
    """
    from seacage.cage import Cage, cage_errors, cage_numbers, cage_remarks
    from seacage.conventions import read_text

    text = read_text(file)
    errors = [f"{file}:{e.line}: {e.sentence}" for e in cage_errors(text, source=str(file))]
    if errors:
        if wants_json():
            report({"ok": False, "errors": errors, "warnings": []})
        typer.echo("\n".join(errors), err=True)
        raise exit_with(f"cage check: {len(errors)} to correct, as above.", Exit.USAGE)
    cage = Cage.from_toml(text, source=str(file))
    odd = [f"{file}:{one.line}: {one.sentence}" for one in cage_remarks(cage, text)]
    odd += [f"{file}: {why}" for why in _still_water_faults(cage)]
    warn(odd)
    numbers = cage_numbers(cage)
    report(
        {"ok": True, "errors": [], "warnings": odd, "numbers": numbers},
        rows=[(name, f"{value:,.5g}") for name, value in numbers.items()],
    )


def _still_water_faults(cage: "Cage") -> list[str]:
    """Why the cage does not settle in still water; empty where it does."""
    from seacage.conventions import RESULTS, InputError, Result
    from seacage.dynamics import settle
    from seacage.ocean import SeaState

    try:
        result = settle(cage, SeaState(current_speed=0.0, current_to=0.0)).result
    except InputError as error:
        return [str(error)]
    return [f"in still water: {RESULTS[Result(int(result))]}"] if result else []


def draw(
    cage: Annotated[str, typer.Argument(metavar="FILE")],
    *,
    out: Annotated[Path, typer.Option("--out", "-o", dir_okay=False, metavar="PICTURE")],
) -> None:
    """Draw a cage from the side and from above, with its dimensions and the names of its parts.

    Lengths are in m, north is up, and the arrow is where the prevailing current goes.

    Example:
        seacage cage draw mine.toml --out mine.png

    Options:
        cage: The cage's file, or a cage that comes with seacage.
        out: The picture: its ending is .png, .svg or .pdf.
    """
    from seacage.figures import cage_drawing_figure, write_figure

    if out.suffix not in _ENDINGS:
        raise refusal(f"--out {out}: a drawing ends in {', '.join(_ENDINGS)}. Name it so.")
    drawn = read_cage(cage)
    write_figure(cage_drawing_figure(drawn), out)
    report({"written": str(out), "cage": drawn.name}, rows=[("Written", str(out))])
