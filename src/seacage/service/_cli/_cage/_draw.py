"""``seacage cage draw``: a cage's drawing, with dimensions and names."""

from pathlib import Path
from typing import Annotated

import typer

from seacage.service._cli._console import guard, refusal, report
from seacage.service._cli._options import read_cage

_ENDINGS = (".png", ".svg", ".pdf")


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
