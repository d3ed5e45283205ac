"""``seacage cage check``: what is wrong or odd in a cage's file, and its derived numbers."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._cli._console import Exit, exit_with, guard, report, wants_json
from seacage.service._cli._options import warn

if TYPE_CHECKING:
    from seacage.cage import Cage


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
