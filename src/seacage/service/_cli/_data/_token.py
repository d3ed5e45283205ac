"""``seacage token``: who may ask what."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._cli._console import report, wants_json
from seacage.service._cli._options import DataFolder

if TYPE_CHECKING:
    from seacage.service._auth._token_store import Grant


def new(*, data: DataFolder = Path("var"), scope: str, name: str = "") -> None:
    """Make a token; it is printed once, and only its hash is kept.

    A running service knows it at once. The last line is the token and nothing else.

    Example: a token for a logger, and one for a person who may acknowledge alarms.
        seacage token new --data var --scope ingest
        seacage token new --data var --scope read,ack --name "Night shift"

    Options:
        scope: read, ingest, ack (or for one cage or site: ingest:ace), admin; by commas.
        name: Of whoever will hold it, as journals and logs name them.
    """
    from seacage.service._auth._token_store import Tokens

    tokens, scopes = Tokens(data), scope.split(",")
    token = tokens.mint(scopes, keep=True, name=name)
    _audit(data, "token new", tokens.grant(token))
    typer.echo(f"Keep it safe; it opens {scope} and cannot be shown again.", err=True)
    if wants_json():
        report({"token": token, "scope": scopes, "name": name})
    else:
        typer.echo(token)


def list_(*, data: DataFolder = Path("var")) -> None:
    """List the tokens: their ids, names, scopes and when they were made.

    Example:
        seacage token list --data var
    """
    from seacage.service._auth._token_store import Tokens

    grants = Tokens(data).all()
    tokens = [
        {"id": one.id, "name": one.name, "scope": list(one.scopes), "made": one.made}
        for one in grants
    ]
    rows = [(one.id, f"{one.who}: {','.join(one.scopes)} {one.made}") for one in grants]
    report({"tokens": tokens}, rows=rows)


def revoke(*, data: DataFolder = Path("var"), token: Annotated[str, typer.Argument()]) -> None:
    """Let a token open nothing from now on, in a running service too.

    Example:
        seacage token revoke --data var "Night shift"

    Options:
        token: Its name or id, as `seacage token list` says.
    """
    from seacage.service._auth._token_store import Tokens

    revoked = Tokens(data).revoke(token)
    _audit(data, "token revoke", revoked)
    report({"revoked": revoked.id}, rows=[("Revoked", revoked.who)])


def _audit(data: Path, did: str, grant: "Grant | None") -> None:
    from seacage.service._auth._audit import Audit

    about = "" if grant is None else grant.id
    Audit(data / "audit.jsonl").write(did, who="command line", about=about)
