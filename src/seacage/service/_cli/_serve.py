"""``seacage serve``: the live service."""

import os
import socket
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._cli._console import progress_bar, refusal, report
from seacage.service._cli._options import InFile, InFolder

if TYPE_CHECKING:
    from seacage.service._http._api import Service
    from seacage.service._live._replay import Replay
    from seacage.service._settings import Settings
    from seacage.twin import Twin


def serve(
    *,
    config: InFile = None,
    data: Path | None = None,
    twin: InFolder = None,
    cage: str | None = None,
    host: str | None = None,
    port: int | None = None,
    site: str | None = None,
    store: str | None = None,
    mqtt: str | None = None,
    opcua_port: Annotated[int | None, typer.Option(min=1, max=65535)] = None,
    certificate: InFile = None,
    key: InFile = None,
    demo: Annotated[bool, typer.Option("--demo")] = False,
    record: InFile = None,
    clock: Literal["wall", "samples"] | None = None,
    speed: Annotated[float | None, typer.Option(min=0.1, max=10_000.0)] = None,
    insecure_http: Annotated[bool, typer.Option("--insecure-http")] = False,
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

    Options:
        config: Settings as TOML; options go before it.
        data: Folder for everything the service writes. [default: var]
        twin: A trained twin; the demonstration's if left out.
        cage: Name to serve the cage under. [default: the cage's own]
        host: Address to listen on. [default: 127.0.0.1]
        port: Port to listen on; 0 takes a free one. [default: 8000]
        site: Where the cages lie, in topics and scopes. [default: site]
        store: postgresql://user@host/name, or a file of SQLite. [default: in --data]
        mqtt: Broker that samples come by, as mqtt://host:1883.
        opcua_port: Port of an OPC UA server of states and alarms; without it there is none.
        certificate: PEM, to speak HTTPS.
        key: PEM, of the certificate.
        demo: Feed the demonstration: a buoy and virtual sensors.
        record: A buoy's record to replay, over and over.
        clock: The time at the cage: this machine's, or that of the newest sample, for a record that
            is published as if it were live. [default: wall]
        speed: Of a replay, or of --clock samples between two of them, against real time. [default:
            60 of a replay, else 1]
        insecure_http: Listen beyond this machine without encryption.
    """
    from seacage.service._assembly import assemble, server
    from seacage.service._logs import begin_logs
    from seacage.service._settings import read_settings
    from seacage.service._small_files import system_locks

    system_locks()  # before minutes of making a demonstration
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
        opcua={"port": opcua_port} if opcua_port else None,
        cages=[{"twin": twin, "name": cage}] if twin else None,
    )
    if demo and settings.cages:
        raise refusal("serve: --demo shows the demonstration's own twin. Leave --twin out.")
    settings.check_host()
    begin_logs(settings.log)
    os.umask(0o077)  # what a service writes is its owner's alone
    # The port first: minutes of preparation should not end at a port that is taken.
    if settings.opcua:
        _listening(settings.opcua.host, settings.opcua.port, "--opcua-port").close()
    with _listening(settings.host, settings.port, "--port") as listener:
        twins, replay = _prepare(settings, cage, demo=demo, record=record)
        pace = 60.0 if speed is None else speed
        service = assemble(settings, twins, replay=replay, speed=pace)
        _greet(settings, service, listener, pace if replay else None)
        with suppress(KeyboardInterrupt):  # Ctrl-C is how a service is stopped
            server(service, settings).run(sockets=[listener])


def _listening(host: str, port: int, option: str) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family)
    except OSError as error:
        raise OSError(
            f"serve: cannot listen on {host}:{port} ({error.strerror}). "
            f"Stop what listens there, or choose another with {option}."
        ) from error


def _prepare(
    settings: "Settings", cage: str | None, *, demo: bool, record: Path | None
) -> tuple[dict[str, "Twin"], "Replay | None"]:
    """Read or make the twins, and what feeds them."""
    from seacage.records import read_record
    from seacage.service._assembly import read_twins, twin_shelf
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
    if not demo and buoy is None:
        return dict([twin_shelf(settings).choose(cage, made.twin_folder)]), None
    twin = Twin.read(made.twin_folder)
    replay = replay_of(made.buoy, made.field) if demo or buoy is None else replay_of(buoy)
    return {cage or twin.cage.name: twin}, replay


def _greet(
    settings: "Settings", service: "Service", listener: socket.socket, speed: float | None
) -> None:
    scheme = "https" if settings.certificate else "http"
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    address = f"{scheme}://{host}:{listener.getsockname()[1]}/"
    # A replay is forgotten at the next start: who looks at it may try its alarms too.
    scopes = ["read"] if speed is None else ["read", "ack"]
    token, cages = service.tokens.mint(scopes, keep=False, name="this start"), list(service.cages)
    came = f"samples by HTTP{' and MQTT' if settings.mqtt else ''}"
    if speed is not None:
        came = f"a replay at {speed:g} × real time"
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
    report(body, rows=[*rows, ("Stop", "Ctrl-C")])
