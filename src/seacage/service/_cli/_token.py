"""``seacage token``: who may ask what."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._cli._console import Json, guard, report

if TYPE_CHECKING:
    from seacage.service._auth._tokens import Grant

group = typer.Typer(help="Tokens of the service.")

Data = Annotated[Path, typer.Option(file_okay=False, help="The service's data folder.")]


@group.command()
@guard
def new(
    *,
    data: Data = Path("var"),
    scope: Annotated[
        str,
        typer.Option(
            help="read, ingest, ack (or for one cage or site: ingest:ace), admin; by commas."
        ),
    ],
    name: Annotated[
        str, typer.Option(help="Of whoever will hold it, as journals and logs name them.")
    ] = "",
    as_json: Json = False,
) -> None:
    """Make a token; it is printed once, and only its hash is kept.

    A running service knows it at once. The last line is the token and nothing else.

    Example: a token for a logger, and one for a person who may acknowledge alarms.
        seacage token new --data var --scope ingest
        seacage token new --data var --scope read,ack --name "Night shift"
    """
    import json

    from seacage.service._auth._tokens import Tokens

    tokens, scopes = Tokens(data), scope.split(",")
    token = tokens.mint(scopes, keep=True, name=name)
    _audit(data, "token new", tokens.grant(token))
    typer.echo(f"Keep it safe; it opens {scope} and cannot be shown again.", err=True)
    typer.echo(json.dumps({"token": token, "scope": scopes, "name": name}) if as_json else token)


@group.command("list")
@guard
def show(*, data: Data = Path("var"), as_json: Json = False) -> None:
    """List the tokens: their ids, names, scopes and when they were made.

    Example:
        seacage token list --data var
    """
    from seacage.service._auth._tokens import Tokens

    grants = Tokens(data).all()
    report(
        {
            "tokens": [
                {"id": one.id, "name": one.name, "scope": list(one.scopes), "made": one.made}
                for one in grants
            ]
        },
        as_json=as_json,
        rows=[(one.id, f"{one.who}: {','.join(one.scopes)} {one.made}") for one in grants],
    )


@group.command()
@guard
def revoke(
    *,
    data: Data = Path("var"),
    token: Annotated[str, typer.Argument(help="Its name or id, as `seacage token list` says.")],
    as_json: Json = False,
) -> None:
    """Let a token open nothing from now on, in a running service too.

    Example:
        seacage token revoke --data var "Night shift"
    """
    from seacage.service._auth._tokens import Tokens

    revoked = Tokens(data).revoke(token)
    _audit(data, "token revoke", revoked)
    report({"revoked": revoked.id}, as_json=as_json, rows=[("Revoked", revoked.who)])


def _audit(data: Path, did: str, grant: "Grant | None") -> None:
    from seacage.service._auth._audit import Audit

    about = "" if grant is None else grant.id
    Audit(data / "audit.jsonl").write(did, who="command line", about=about)
