"""``seacage cage check`` and ``draw``: a cage's file, its derived numbers and its drawing."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._cli._console import Exit, exit_with, guard, refusal, report, wants_json
from seacage.service._cli._options import read_cage, warn

if TYPE_CHECKING:
    from seacage.cage import Cage

_ENDINGS = (".png", ".svg", ".pdf")


@guard
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


@guard
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
