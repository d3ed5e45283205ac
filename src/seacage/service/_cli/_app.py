"""The command line: one file per group, each importing what it needs when it is called."""

import os
from typing import Annotated

import typer

from seacage.service._cli import (
    _campaign,
    _clearance,
    _config,
    _doctor,
    _field,
    _publish,
    _replay,
    _score,
    _serve,
    _settle,
    _simulate,
    _study,
    _train,
)
from seacage.service._cli._cage import _check, _new
from seacage.service._cli._console import EXIT_CODES
from seacage.service._cli._data import _archive, _backup, _token, _twin

app = typer.Typer(
    name="seacage",
    help=(
        "A multifidelity digital twin of aquaculture net cages: simulate a cage, learn from the "
        "simulations and from its sensors, and watch its loads and shape live."
    ),
    epilog=EXIT_CODES,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _print_version(requested: bool) -> bool:  # noqa: FBT001
    if requested:
        from seacage import __version__

        typer.echo(f"seacage {__version__}")
        raise typer.Exit
    return requested


@app.callback()
def _options(
    *,
    version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Say the version."),
    ] = False,
) -> None:
    del version


_cage = typer.Typer(help="A cage's file: write one, check it, draw it.")
_cage.command()(_new.new)
_cage.command()(_check.check)
_cage.command()(_check.draw)

app.add_typer(_cage, name="cage")
app.command()(_settle.settle)
app.command()(_simulate.simulate)
app.add_typer(_campaign.group, name="campaign")
app.add_typer(_field.group, name="field")
app.command()(_train.train)
app.command("if-parted")(_score.if_parted)
app.command()(_score.score)
app.add_typer(_study.group, name="study")
app.command()(_serve.serve)
app.command()(_replay.replay)
app.command()(_clearance.clearance)
app.command("inspect-path")(_clearance.inspect_path)
app.command()(_publish.publish)
app.add_typer(_token.group, name="token")
app.add_typer(_twin.group, name="twin")
app.add_typer(_archive.group, name="archive")
app.add_typer(_config.group, name="config")
app.command()(_backup.backup)
app.command()(_backup.restore)
app.command()(_doctor.doctor)


def main() -> None:
    """Run the command line."""
    # Matrices of a few hundred rows, and processes side by side: threads of linear algebra
    # would cost more than they bring. Before NumPy is loaded, and only where nothing is said.
    for library in ("OMP", "OPENBLAS", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    app()
