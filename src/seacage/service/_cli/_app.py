"""The command line: a table of all commands, each importing what it needs when it is called."""

import os
from collections.abc import Callable
from typing import Annotated

import typer

from seacage.service._cli import (
    _cage,
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
from seacage.service._cli._console import EXIT_CODES, guard
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


def _add(group: typer.Typer, *commands: Callable[..., None], **context: bool) -> None:
    """Add commands by the names of their functions, with settings of their context."""
    for command in commands:
        name = command.__name__.strip("_").replace("_", "-")
        group.command(name, context_settings=context)(guard(command))


def _add_group(name: str, text: str, *commands: Callable[..., None]) -> typer.Typer:
    group = typer.Typer(help=text)
    _add(group, *commands)
    app.add_typer(group, name=name)
    return group


_add(app, _settle.settle, _simulate.simulate, _train.train, _score.if_parted, _score.score)
_add(app, _serve.serve, _replay.replay, _clearance.clearance, _clearance.inspect_path)
_add(app, _publish.publish, _backup.backup, _backup.restore, _doctor.doctor)
_add_group(
    "cage", "A cage's file: write one, check it, draw it.", _cage.new, _cage.check, _cage.draw
)
_campaigns = _add_group(
    "campaign",
    "Many simulations: run them here or on a cluster, see how far they are, export them.",
    _campaign.run,
    _campaign.status,
    _campaign.finish,
    _campaign.export,
    _campaign.import_,
)
# The job array's command passes on what `campaign run` takes.
_add(_campaigns, _campaign.slurm, ignore_unknown_options=True)
_add_group(
    "field",
    "Records of buoys and sensors: make, read and check them.",
    _field.virtual,
    _field.import_,
    _field.check,
)
_add_group(
    "study",
    "Whole experiments, from simulations to one HTML report.",
    _study.paper,
    _study.fidelity,
    _study.benchmarks,
    _study.bench,
)
_add_group("token", "Tokens of the service.", _token.new, _token.list_, _token.revoke)
_add_group("twin", "The twins that a service answers by.", _twin.replace)
_add_group(
    "archive",
    "Whole days of samples as Parquet files: write, read and check them.",
    _archive.write,
    _archive.read,
    _archive.check,
)
_add_group("config", "Settings of the service.", _config.check, _config.show)


def main() -> None:
    """Run the command line."""
    # Matrices of a few hundred rows, and processes side by side: threads of linear algebra
    # would cost more than they bring. Before NumPy is loaded, and only where nothing is said.
    for library in ("OMP", "OPENBLAS", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    app()
