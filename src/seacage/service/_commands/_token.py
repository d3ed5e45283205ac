"""``seacage token``: who may ask what."""

from pathlib import Path
from typing import Annotated

import typer

from seacage.service._console import Json, guarded

group = typer.Typer(help="Tokens of the service.")


@group.command()
@guarded
def new(
    *,
    data: Annotated[Path, typer.Option(file_okay=False, help="The service's data folder.")] = Path(
        "var"
    ),
    scope: Annotated[
        str,
        typer.Option(help="read, ingest, ack (or for one cage: ingest:ace), admin; by commas."),
    ],
    as_json: Json = False,
) -> None:
    """Make a token; it is printed once, and only its hash is kept.

    A running service knows it at once. The last line is the token and nothing else.

    Example: a token for a logger.
        seacage token new --data var --scope ingest
    """
    import json

    from seacage.service._tokens import Tokens

    token = Tokens(data).mint(scope.split(","), keep=True)
    typer.echo(f"Keep it safe; it opens {scope} and cannot be shown again.", err=True)
    typer.echo(json.dumps({"token": token, "scope": scope.split(",")}) if as_json else token)
