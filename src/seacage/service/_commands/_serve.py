"""``seacage serve``: the live service."""

import socket
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._console import Json, guarded, progress_bar, tell

if TYPE_CHECKING:
    from seacage.service._api import Service
    from seacage.service._replay import Replay
    from seacage.service._settings import Settings
    from seacage.twin import Twin


@guarded
def serve(
    *,
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
    demo: Annotated[
        bool, typer.Option("--demo", help="Feed the demonstration: a buoy and virtual sensors.")
    ] = False,
    record: Annotated[
        Path | None,
        typer.Option(exists=True, dir_okay=False, help="A buoy's record to replay, over and over."),
    ] = None,
    speed: Annotated[
        float, typer.Option(min=0.1, max=10_000.0, help="Of a replay, against real time.")
    ] = 60.0,
    insecure_http: Annotated[
        bool,
        typer.Option("--insecure-http", help="Listen beyond this machine without encryption."),
    ] = False,
    as_json: Json = False,
) -> None:
    """Serve a cage live: its page and its interface.

    Without --twin the demonstration twin of cage ace is served, and made first if there is
    none, which takes a few minutes. Samples then come by HTTP; with --demo or --record they
    are replayed on the record's own clock, from the beginning again at the end.

    Example: watch a demonstration, a minute per second.
        seacage serve --data var --demo
    Example: let a logger send samples to your own twin.
        seacage token new --data var --scope ingest
        seacage serve --data var --twin twin
    """
    from seacage.conventions import InputError
    from seacage.service._logs import begin_logs

    if demo and twin:
        raise InputError("serve: --demo shows the demonstration's own twin. Leave --twin out.")
    settings = _settings(data=data, host=host, port=port, insecure_http=insecure_http or None)
    settings.check_host()
    begin_logs(settings.log)
    # The port first: minutes of preparation should not end at a port that is taken.
    with _listening(settings.host, settings.port) as listener:
        trained, replay = _prepared(settings.data, twin=twin, demo=demo, record=record)
        name = cage or trained.cage.name
        service = assembled(settings, name, trained, replay, speed)
        token = service.tokens.mint(["read"], keep=False)
        address = f"http://{settings.host}:{listener.getsockname()[1]}/"
        tell(
            {"address": address, "token": token, "cage": name},
            as_json=as_json,
            rows=_greeting(address, token, name, speed if replay else None),
        )
        _run(service, listener)


def _settings(**given: object) -> "Settings":
    """What was given on the command line, over the environment, over the defaults."""
    from pydantic import ValidationError

    from seacage.conventions import InputError
    from seacage.service._settings import Settings

    try:
        return Settings.model_validate({key: v for key, v in given.items() if v is not None})
    except ValidationError as error:
        first = error.errors()[0]
        raise InputError(
            f"serve: {'.'.join(map(str, first['loc']))} = {first['input']!r} does not do: "
            f"{first['msg']}. Mend the option or its variable SEACAGE_…"
        ) from error


def _listening(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family)
    except OSError as error:
        raise OSError(
            f"serve: cannot listen on {host}:{port} ({error.strerror}). "
            "Stop what listens there, or choose another with --port."
        ) from error


def _prepared(
    data: Path, *, twin: Path | None, demo: bool, record: Path | None
) -> tuple["Twin", "Replay | None"]:
    """Read or make the twin, and what feeds it."""
    from seacage.records import read_record
    from seacage.service._replay import replay_of
    from seacage.studies import prepare_demonstration
    from seacage.twin import Twin

    buoy = read_record(record) if record else None
    if twin is not None:
        return Twin.read(twin), replay_of(buoy) if buoy else None
    with progress_bar() as progress:
        made = prepare_demonstration(
            data / "demonstration", record=buoy if demo else None, progress=progress
        )
    if demo:
        return Twin.read(made.twin_folder), replay_of(made.buoy, made.field)
    return Twin.read(made.twin_folder), replay_of(buoy) if buoy else None


def assembled(
    settings: "Settings", name: str, twin: "Twin", replay: "Replay | None", speed: float
) -> "Service":
    from functools import partial

    from seacage.service._api import Service
    from seacage.service._clock import Clock, ReplayClock, WallClock
    from seacage.service._live import LiveCage
    from seacage.service._metrics import Metrics
    from seacage.service._store import Store
    from seacage.service._tokens import Tokens

    # What is replayed lies apart: it is forgotten at each start, what was measured never is.
    store = Store(settings.data / ("replay.sqlite" if replay else "samples.sqlite"))
    metrics, tokens, tick_s = Metrics(), Tokens(settings.data), settings.tick_s

    def live(clock: Clock) -> LiveCage:
        return LiveCage(
            name=name, twin=twin, store=store, clock=clock, metrics=metrics, tick_s=tick_s
        )

    if replay is None:
        cages = {name: live(WallClock())}
        return Service(cages=cages, store=store, tokens=tokens, metrics=metrics)
    clock = ReplayClock(replay.start, speed=speed)
    cage = live(clock)
    feeds = [partial(replay.feed, cage, clock)]
    return Service(cages={name: cage}, store=store, tokens=tokens, metrics=metrics, feeds=feeds)


def _greeting(address: str, token: str, name: str, speed: float | None) -> list[tuple[str, str]]:
    came = "samples by HTTP" if speed is None else f"a replay at {speed:g} × real time"
    return [
        ("Cage", f"{name}, fed by {came}"),
        ("Page", f"{address}#token={token}"),
        ("Token", f"{token}  (reads; good until this service stops)"),
        ("Stop", "Ctrl-C"),
    ]


def _run(service: "Service", listener: socket.socket) -> None:
    import uvicorn

    from seacage.service._api import create_app

    config = uvicorn.Config(
        create_app(service),
        ws="websockets-sansio",
        ws_max_size=4096,  # clients only send their token
        log_config=None,
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=3,
    )
    with suppress(KeyboardInterrupt):  # Ctrl-C is how a service is stopped
        uvicorn.Server(config).run(sockets=[listener])
