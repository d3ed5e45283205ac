"""The command line: one group per file, each imported only for what it needs."""

import typer

from seacage.service._commands._serve import serve
from seacage.service._console import EXIT_CODES

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

app.command("serve")(serve)


def main() -> None:
    """Run the command line."""
    app()
