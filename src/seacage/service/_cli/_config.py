"""``seacage config``: what a service would be told, and whether it can be so."""

import importlib.util
import os
import socket
import ssl
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ParamSpec, cast

import typer

from seacage.service._cli._console import Exit, Finding, refusal, report, report_findings

if TYPE_CHECKING:
    from seacage.service._publish._opcua_settings import OpcUaSettings
    from seacage.service._settings import Settings

P = ParamSpec("P")
Config = Annotated[
    Path | None, typer.Option(exists=True, dir_okay=False, help="The file of settings, TOML.")
]


def check(
    *, config: Config = None, reach: Annotated[bool, typer.Option("--reach")] = False
) -> None:
    """Check settings before a service starts with them: all that can be known now.

    Every setting is known and in range; certificates, twins and folders are there and whole;
    limits of alarms name alarms that there can be. Anything wrong ends with code 1.

    Example:
        seacage config check --config seacage.toml

    Options:
        reach: Also open the store and knock at the broker.
    """
    from seacage.service._settings import read_settings

    findings = list(_findings(read_settings(config), reach=reach))
    report_findings("config", findings, code=Exit.REFUSED)


def show(*, config: Config = None) -> None:
    """Show all settings as a service would take them: file, environment and defaults together.

    Secrets, and addresses that may hold one, are not shown.

    Example:
        seacage config show --config seacage.toml
    """
    from seacage.service._settings import read_settings

    settled = dict(_flat("", read_settings(config).model_dump(mode="json")))
    report(settled, rows=[(name, str(value)) for name, value in settled.items()])


def _flat(prefix: str, value: object) -> Iterator[tuple[str, object]]:
    if isinstance(value, list) and value and isinstance(value[0], dict):
        value = dict(enumerate(cast("list[object]", value)))
    if not isinstance(value, dict):
        yield prefix, _hidden(prefix, cast("object", value))
        return
    for key, item in cast("dict[object, object]", value).items():
        yield from _flat(f"{prefix}.{key}" if prefix else str(key), item)


def _hidden(name: str, value: object) -> object:
    from seacage.service._settings import without_password

    if name.endswith("secret") and value:
        return "…"
    return without_password(value) if isinstance(value, str) and "url" in name else value


def _findings(settings: "Settings", *, reach: bool) -> Iterator[Finding]:
    yield _try("address", _listens, settings)
    if settings.certificate and settings.key:
        yield _try("certificate", _check_certificate, settings)
    yield _try("data", _writable, settings.data)
    for one in settings.cages:
        yield _try(f"cage {one.name or one.twin}", _check_cage, settings, one.twin, one.name)
    if not settings.cages:
        yield Finding(what="cages", state="absent", message="none: the demonstration is served")
    yield _try("store", _check_store, settings, reach=reach)
    if settings.mqtt:
        yield _try("mqtt", _check_broker, settings, reach=reach)
    if settings.opcua:
        yield _try("opcua", _check_opcua, settings)
    for hook in settings.webhooks:
        yield _try("webhook", _check_webhooks, settings, hook.cages)


def _try(what: str, check: Callable[P, str], *args: P.args, **more: P.kwargs) -> Finding:
    from seacage.conventions import SeacageError

    try:
        return Finding(what=what, state="ok", message=check(*args, **more))
    except (SeacageError, OSError) as error:
        return Finding(what=what, state="wrong", message=str(error))


def _listens(settings: "Settings") -> str:
    settings.check_host()
    return f"{settings.host}:{settings.port}, {'HTTPS' if settings.certificate else 'HTTP'}"


def _check_certificate(section: "Settings | OpcUaSettings") -> str:
    certificate, key = section.certificate, section.key
    assert certificate
    try:
        ssl.create_default_context(ssl.Purpose.CLIENT_AUTH).load_cert_chain(certificate, key)
    except OSError as error:  # as SSLError is
        sentence = f"{certificate} and {key} are no PEM certificate and its key ({error})."
        raise refusal(sentence) from error
    return f"{certificate} and its key"


def _check_opcua(settings: "Settings") -> str:
    assert settings.opcua
    if importlib.util.find_spec("asyncua") is None:
        raise refusal("asyncua is not installed. Install seacage[opcua].")
    if settings.opcua.certificate:
        _check_certificate(settings.opcua)
    return f"{settings.opcua.host}:{settings.opcua.port}"


def _writable(folder: Path) -> str:
    there = next(one for one in (folder, *folder.absolute().parents) if one.exists())
    if not there.is_dir() or not os.access(there, os.W_OK | os.X_OK):
        raise refusal(f"{there} takes no files. Mend its rights, or name another as data.")
    return f"{folder} can be written"


def _check_cage(settings: "Settings", folder: Path, name: str | None) -> str:
    from seacage.service._assembly import policy_of
    from seacage.twin import Twin, read_key

    key = read_key(settings.twin_key) if settings.twin_key else None
    twin = Twin.read(folder, key=key)
    policy_of(settings, name or twin.cage.name, twin)
    return f"{folder} is whole: {twin.cage.node_count} nodes, {len(twin.sensor_names)} sensors"


def _check_store(settings: "Settings", *, reach: bool) -> str:
    from seacage.service._assembly import store_place
    from seacage.service._settings import without_password
    from seacage.service._store._store import open_store

    place = store_place(settings)
    for extra, package, wanted in (
        ("postgres", "psycopg", isinstance(place, str)),
        ("archive", "pyarrow", settings.store.archive is not None),
    ):
        if wanted and importlib.util.find_spec(package) is None:
            raise refusal(f"{package} is not installed. Install seacage[{extra}].")
    if reach:
        open_store(place).close()
    return f"{without_password(str(place))}{' opens' if reach else ''}"


def _check_broker(settings: "Settings", *, reach: bool) -> str:
    from seacage.service._mqtt._broker import Broker
    from seacage.service._mqtt._topics import Topics

    assert settings.mqtt
    Topics(settings.site)
    broker = Broker.parse(settings.mqtt.url, ca=settings.mqtt.ca)
    broker.client("seacage-config-check")  # reads the CA file
    if reach:
        socket.create_connection((broker.host, broker.port), timeout=5.0).close()
    return f"{broker}{' answers' if reach else ''}"


def _check_webhooks(settings: "Settings", cages: tuple[str, ...]) -> str:
    served = {cage.name for cage in settings.cages}
    unknown = [cage for cage in cages if None not in served and cage not in served]
    if unknown:
        raise refusal(f"No cage is called {unknown[0]!r}, whose alarms it would be told.")
    return "alarms of " + (", ".join(cages) or "all cages")
