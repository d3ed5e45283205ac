"""``seacage serve``: the live service."""

import os
import socket
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._cli._console import Json, guard, progress_bar, report

if TYPE_CHECKING:
    from seacage.service._http._api import Service
    from seacage.service._live._replay import Replay
    from seacage.service._settings import Settings
    from seacage.twin import Twin


@guard
def serve(
    *,
    config: Annotated[
        Path | None,
        typer.Option(exists=True, dir_okay=False, help="Settings as TOML; options go before it."),
    ] = None,
    data: Annotated[
        Path | None, typer.Option(help="Folder for everything the service writes. [default: var]")
    ] = None,
    twin: Annotated[
        Path | None,
        typer.Option(
            exists=True, file_okay=False, help="A trained twin; the demonstration's if left out."
        ),
    ] = None,
    cage: Annotated[
        str | None, typer.Option(help="Name to serve the cage under. [default: the cage's own]")
    ] = None,
    host: Annotated[
        str | None, typer.Option(help="Address to listen on. [default: 127.0.0.1]")
    ] = None,
    port: Annotated[
        int | None, typer.Option(help="Port to listen on; 0 takes a free one. [default: 8000]")
    ] = None,
    site: Annotated[
        str | None, typer.Option(help="Where the cages lie, in topics and scopes. [default: site]")
    ] = None,
    store: Annotated[
        str | None,
        typer.Option(help="postgresql://user@host/name, or a file of SQLite. [default: in --data]"),
    ] = None,
    mqtt: Annotated[
        str | None, typer.Option(help="Broker that samples come by, as mqtt://host:1883.")
    ] = None,
    certificate: Annotated[
        Path | None, typer.Option(exists=True, dir_okay=False, help="PEM, to speak HTTPS.")
    ] = None,
    key: Annotated[
        Path | None, typer.Option(exists=True, dir_okay=False, help="PEM, of the certificate.")
    ] = None,
    demo: Annotated[
        bool, typer.Option("--demo", help="Feed the demonstration: a buoy and virtual sensors.")
    ] = False,
    record: Annotated[
        Path | None,
        typer.Option(exists=True, dir_okay=False, help="A buoy's record to replay, over and over."),
    ] = None,
    clock: Annotated[
        Literal["wall", "samples"] | None,
        typer.Option(
            help="The time at the cage: this machine's, or that of the newest sample, for a "
            "record that is published as if it were live. [default: wall]"
        ),
    ] = None,
    speed: Annotated[
        float | None,
        typer.Option(
            min=0.1,
            max=10_000.0,
            help="Of a replay, or of --clock samples between two of them, against real time. "
            "[default: 60 of a replay, else 1]",
        ),
    ] = None,
    insecure_http: Annotated[
        bool,
        typer.Option("--insecure-http", help="Listen beyond this machine without encryption."),
    ] = False,
    as_json: Json = False,
) -> None:
    """Serve cages live: their page and their interface.

    Without --twin the demonstration twin of cage ace is served, and made first if there is
    none, which takes a few minutes. Samples then come by HTTP, and by MQTT from a broker; with
    --demo or --record they are replayed on the record's own clock, from the beginning again at
    the end.

    Example: watch a demonstration, a minute per second.
        seacage serve --data var --demo
    Example: let a logger send samples to your own twin.
        seacage token new --data var --scope ingest
        seacage serve --data var --twin twin
    Example: show a record that is published at 100 times its pace.
        seacage serve --twin twin --mqtt mqtt://127.0.0.1:1883 --clock samples --speed 100
        seacage publish record.csv --to mqtt://127.0.0.1:1883 --speed 100
    Example: serve a farm as its file says.
        seacage serve --config seacage.toml
    """
    from seacage.conventions import InputError
    from seacage.service._assembly import assemble, server
    from seacage.service._logs import begin_logs
    from seacage.service._settings import read_settings

    settings = read_settings(
        config,
        data=data,
        site=site,
        host=host,
        port=port,
        certificate=certificate,
        key=key,
        insecure_http=insecure_http or None,
        clock=clock,
        speed=speed,
        store={"url": store} if store else None,
        mqtt={"url": mqtt} if mqtt else None,
        cages=[{"twin": twin, "name": cage}] if twin else None,
    )
    if demo and settings.cages:
        raise InputError("serve: --demo shows the demonstration's own twin. Leave --twin out.")
    settings.check_host()
    begin_logs(settings.log)
    os.umask(0o077)  # what a service writes is its owner's alone
    # The port first: minutes of preparation should not end at a port that is taken.
    with _listening(settings.host, settings.port) as listener:
        twins, replay = _prepare(settings, demo=demo, record=record)
        if cage and not settings.cages:
            twins = dict.fromkeys([cage], next(iter(twins.values())))
        pace = 60.0 if speed is None else speed
        service = assemble(settings, twins, replay=replay, speed=pace)
        greeting = _greeting(settings, service, listener, pace if replay else None)
        report(greeting.body, as_json=as_json, rows=greeting.rows)
        with suppress(KeyboardInterrupt):  # Ctrl-C is how a service is stopped
            server(service, settings).run(sockets=[listener])


def _listening(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family)
    except OSError as error:
        raise OSError(
            f"serve: cannot listen on {host}:{port} ({error.strerror}). "
            "Stop what listens there, or choose another with --port."
        ) from error


def _prepare(
    settings: "Settings", *, demo: bool, record: Path | None
) -> tuple[dict[str, "Twin"], "Replay | None"]:
    """Read or make the twins, and what feeds them."""
    from seacage.records import read_record
    from seacage.service._assembly import read_twins
    from seacage.service._live._replay import replay_of
    from seacage.studies import prepare_demonstration
    from seacage.twin import Twin

    buoy = read_record(record) if record else None
    if settings.cages:
        return read_twins(settings), replay_of(buoy) if buoy else None
    with progress_bar() as progress:
        made = prepare_demonstration(
            settings.data / "demonstration", record=buoy if demo else None, progress=progress
        )
    twin = Twin.read(made.twin_folder)
    if demo:
        return {twin.cage.name: twin}, replay_of(made.buoy, made.field)
    return {twin.cage.name: twin}, replay_of(buoy) if buoy else None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Welcome:
    """What a start tells a program, and what it tells a person."""

    body: dict[str, object]
    rows: list[tuple[str, str]]


def _greeting(
    settings: "Settings", service: "Service", listener: socket.socket, speed: float | None
) -> _Welcome:
    scheme = "https" if settings.certificate else "http"
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    address = f"{scheme}://{host}:{listener.getsockname()[1]}/"
    # A replay is forgotten at the next start: who looks at it may try its alarms too.
    scopes = ["read"] if speed is None else ["read", "ack"]
    token, cages = service.tokens.mint(scopes, keep=False, name="this start"), list(service.cages)
    came = _sources(settings) if speed is None else f"a replay at {speed:g} × real time"
    body: dict[str, object] = {"address": address, "token": token, "cage": cages[0], "cages": cages}
    rows = [
        ("Cage" if len(cages) == 1 else "Cages", f"{', '.join(cages)}, fed by {came}"),
        ("Page", f"{address}#token={token}"),
        ("Token", f"{token}  ({', '.join(scopes)}; good until this service stops)"),
    ]
    if service.tokens.lacks_admin:
        admin = service.tokens.mint(["admin"], keep=True, name="first start")
        body["admin_token"] = admin
        rows.append(("Admin", f"{admin}  (opens everything; keep it, it is shown this once)"))
    return _Welcome(body=body, rows=[*rows, ("Stop", "Ctrl-C")])


def _sources(settings: "Settings") -> str:
    return "samples by HTTP and MQTT" if settings.mqtt else "samples by HTTP"
