"""Programs beside seacage that a benchmark starts for itself, or says that it lacks."""

import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit

SEACAGE = (sys.executable, "-c", "from seacage.service import main; main()")


def lacking(url: str) -> str | None:
    """Why there is no broker or no server to measure with; None where there are both."""
    if why := lacking_broker():
        return why
    try:
        import psycopg
    except ImportError:
        return "psycopg is not installed"
    try:
        psycopg.connect(url, connect_timeout=3).close()
    except psycopg.OperationalError as error:
        return f"no PostgreSQL answers ({str(error).splitlines()[0]}); name one with --postgres URL"
    return None


def lacking_broker() -> str | None:
    """Why there is no broker to measure with; None where there is one."""
    return None if _mosquitto() else "Mosquitto is not installed"


@contextmanager
def broker() -> Generator[str]:
    """Run a broker of our own on a free port; its address."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    with tempfile.TemporaryDirectory() as folder:
        settings = Path(folder, "mosquitto.conf")
        # As it comes it drops what a slow reader has not taken: beyond 1,000 messages.
        settings.write_text(
            f"listener {port} 127.0.0.1\nallow_anonymous true\nmax_queued_messages 0\n"
        )
        with _running([str(_mosquitto()), "-c", str(settings)]) as process:
            _until_open(port, process)
            yield f"mqtt://127.0.0.1:{port}"


@contextmanager
def database(url: str) -> Generator[str]:
    """Make a database of our own on a server, and drop it; its URL."""
    import psycopg

    name = f"seacage_benchmark_{os.getpid()}"
    with psycopg.connect(url, autocommit=True) as owner:
        owner.execute(f"CREATE DATABASE {name}".encode())
        try:
            yield urlsplit(url)._replace(path=f"/{name}").geturl()
        finally:
            owner.execute(f"DROP DATABASE {name} WITH (FORCE)".encode())


@contextmanager
def service(words: Sequence[object]) -> Generator[dict[str, str]]:
    """Run `seacage serve` on a free port; what it said at its start, and its number."""
    command = [*SEACAGE, "serve", "--port", "0", "--json", *map(str, words)]
    with _running(command, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        text = process.stdout.readline()
        assert text, "the service did not start"
        yield json.loads(text) | {"pid": str(process.pid)}


@contextmanager
def _running(
    command: Sequence[str], *, stdout: int = subprocess.DEVNULL
) -> Generator[subprocess.Popen[bytes]]:
    threads = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
    silent = subprocess.DEVNULL
    with subprocess.Popen(
        command, stdout=stdout, stderr=silent, env=os.environ | threads
    ) as process:
        try:
            yield process
        finally:
            process.terminate()


def _until_open(port: int, process: subprocess.Popen[bytes]) -> None:
    while process.poll() is None:
        try:
            socket.create_connection(("127.0.0.1", port), timeout=1).close()
        except OSError:
            time.sleep(0.05)
        else:
            return
    raise OSError("The broker did not start.")


def _mosquitto() -> str | None:
    return shutil.which("mosquitto", path=f"{os.environ.get('PATH', '')}:/usr/sbin")
