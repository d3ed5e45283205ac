"""``seacage doctor``: what is installed, what is reachable, what is wrong."""

import importlib.util
import platform
import shutil
import socket
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated, Literal

import typer

from seacage.service._cli._console import Exit, Finding, report_findings
from seacage.service._cli._options import DataFolder

_LOOK_S = 20.0
_EXTRAS = {
    "sim": ("xarray", "zarr", "h5netcdf", "dask", "matplotlib"),
    "gcn": ("jax", "optax"),
    "postgres": ("psycopg",),
    "archive": ("pyarrow",),
    "ros": ("rosbags",),
    "opcua": ("asyncua",),
    "adcp": ("mhkit",),
    "bench": ("sklearn",),
}
Found = tuple[Literal["ok", "absent", "wrong"], str]  # state and message of a ``Finding``


def doctor(
    *,
    data: DataFolder = Path("var"),
    store: str | None = None,
    port: Annotated[int, typer.Option(min=1, max=65535)] = 8000,
) -> None:
    """Say what is installed and what is wrong.

    An extra that is not installed is no fault. Anything wrong ends the command with code 3.

    Example:
        seacage doctor

    Options:
        store: postgresql://user@host/name, or a file. [default: that in --data]
        port: The service's port.
    """
    machine = f"{platform.system()} {platform.machine()}"
    found: dict[str, Found] = {
        "Python": ("ok", f"{platform.python_version()} on {machine}"),
        "Physics kernel": _physics(),
        "Store": _store(),
        "Stored rows": _rows(store or str(data / "samples.sqlite")),
        "Disk": _disk(data),
        "Tokens": _tokens(data),
        f"Port {port}": _port(port),
        "Demonstration": _demonstration(data),
        **{f"Extra {name}": _extra(name) for name in _EXTRAS},
        **dict(_extensions()),
    }
    findings = [Finding(what=what, state=one[0], message=one[1]) for what, one in found.items()]
    report_findings("doctor", findings, code=Exit.FAILED)


def _physics() -> Found:
    """Settle a small cage: the kernel loads, runs and converges."""
    from seacage.cage import Cage
    from seacage.conventions import SeacageError
    from seacage.dynamics import settle
    from seacage.ocean import SeaState

    cage = Cage.named("ace").altered(mesh={"spokes": 8})
    try:
        response = settle(cage, SeaState(current_speed=0.5, current_to=0.0))
    except (SeacageError, OSError) as error:
        return "wrong", f"{error} Install seacage anew."
    fine = int(response.result) == 0
    return "ok" if fine else "wrong", f"a small cage settles to {float(response.residual):.2g} N"


def _store() -> Found:
    import sqlite3

    fine = sqlite3.sqlite_version_info >= (3, 37)
    message = f"SQLite {sqlite3.sqlite_version}" + ("" if fine else "; 3.37 or later is needed")
    return "ok" if fine else "wrong", message


def _rows(place: str) -> Found:
    """Verify the stored rows, as many as can be in some seconds."""
    from seacage.service._store._integrity._verify import verify_for
    from seacage.service._store._store import StoreError, look_into

    if "://" not in place and not Path(place).exists():
        return "absent", f"no store in {place}"
    try:
        with look_into(place) as session:
            message, wrong = verify_for(session, seconds=_LOOK_S), session.damage.message
            if session.checksums is not None:
                message += f"; data_checksums of the server are {session.checksums}"
    except StoreError as error:
        return "wrong", str(error)
    return "wrong" if wrong else "ok", wrong or message


def _disk(data: Path) -> Found:
    place = next(one for one in (data, *data.resolve().parents) if one.exists())
    free = shutil.disk_usage(place).free / 1e9
    message = f"{free:.0f} GB free for {data}" + ("; free some" if free < 1.0 else "")
    return "wrong" if free < 1.0 else "ok", message


def _tokens(data: Path) -> Found:
    from seacage.service._auth._token_store import Tokens

    tokens = Tokens(data)
    count = len(tokens.all())
    return "wrong" if tokens.damage else "ok", tokens.damage or f"{count} in {data}"


def _port(port: int) -> Found:
    with socket.socket() as probe:
        taken = probe.connect_ex(("127.0.0.1", port)) == 0
    there = "something listens there: a service, or choose another with --port"
    return "ok", there if taken else "free"


def _demonstration(data: Path) -> Found:
    there = (data / "demonstration").is_dir()
    message = f"in {data}" if there else f"none in {data}; `seacage serve --demo` makes one"
    return "ok" if there else "absent", message


def _extra(name: str) -> Found:
    missing = [one for one in _EXTRAS[name] if importlib.util.find_spec(one) is None]
    if missing:
        return "absent", f"without {', '.join(missing)}: pip install 'seacage[{name}]'"
    return "ok", ", ".join(f"{one} {_version(one)}" for one in _EXTRAS[name])


def _extensions() -> Iterator[tuple[str, Found]]:
    """What other packages add, each loaded."""
    from seacage.conventions import EXTENSION_GROUPS, InputError, extension_names, load_extension

    for group in EXTENSION_GROUPS:
        for name in extension_names(group):
            what = f"{group.replace('_', ' ').removesuffix('s').capitalize()} {name}"
            try:
                yield what, ("ok", load_extension(group, name, object).source)
            except InputError as error:
                yield what, ("wrong", str(error))


def _version(package: str) -> str:
    try:
        return version({"sklearn": "scikit-learn"}.get(package, package))
    except PackageNotFoundError:
        return "?"
