"""What every test shares: checked shapes, one thread each, and the programs it may need."""

import gc
import os
import shutil
import socket
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from fcntl import LOCK_EX, flock
from pathlib import Path

# Before NumPy is loaded: the tests run side by side, so each has one thread.
for library in ("OMP", "OPENBLAS", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

# Compiled once and kept, also where Python was told not to: without it each worker of each run
# compiles all modules anew, which takes longer than to run many a room's tests.
sys.dont_write_bytecode = False

import checking  # noqa: E402

# Before seacage is loaded: every annotated array is checked on the way in and out.
checking.install("seacage")

import hypothesis  # noqa: E402
import pytest  # noqa: E402

from collection import MARKS, shuffle  # noqa: E402
from outside import PROGRAMS, program, serving, wait_for  # noqa: E402

hypothesis.settings.register_profile("seacage", deadline=None)
hypothesis.settings.load_profile("seacage")


def skip_or_fail(need: str, why: str) -> None:
    """Skip for want of `need`, unless SEACAGE_REQUIRE names it: then it is a failure."""
    if need in os.environ.get("SEACAGE_REQUIRE", "").split(","):
        pytest.fail(f"SEACAGE_REQUIRE names {need}, but {why}", pytrace=False)
    pytest.skip(f"needs {need}: {why}")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark each test with the outside programs whose fixtures it asks for, and keep the marks."""
    for item in items:
        for name in PROGRAMS.keys() & getattr(item, "fixturenames", ()):
            item.add_marker(name)
    marks = {item.nodeid: {mark.name for mark in item.iter_markers()} for item in items}
    config.stash[MARKS] = marks
    if seed := os.environ.get("SEACAGE_ORDER"):
        shuffle(items, seed)


def pytest_collection_finish() -> None:
    """Spare the garbage collector what stays until the end: all modules, and all tests."""
    gc.collect()
    gc.freeze()


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Let no test start without the programs that its markers name."""
    for name in PROGRAMS:
        if item.get_closest_marker(name) and not program(name):
            skip_or_fail(name, "it is not installed; `make test-all` installs it")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Count what was skipped, by reason."""
    skipped = terminalreporter.stats.get("skipped", ())
    for reason, count in Counter(report.longrepr[2] for report in skipped).most_common():
        terminalreporter.write_line(f"{count} skipped: {reason.removeprefix('Skipped: ')}")


@pytest.fixture(scope="session")
def shared(pytestconfig: pytest.Config) -> Path:
    """The folder of real records and published numbers, SEACAGE_SHARED or ../shared."""
    beside = pytestconfig.rootpath.parent / "shared"
    folder = Path(os.environ.get("SEACAGE_SHARED", beside))
    if not folder.is_dir():
        skip_or_fail("shared", f"there is no folder {folder}; name it in SEACAGE_SHARED")
    return folder


@pytest.fixture(scope="session")
def node() -> Path | None:
    """Node, to run or to check a script."""
    return program("node")


@pytest.fixture(scope="session")
def chromium() -> Path | None:
    """Chromium, to open a page with `--headless`."""
    return program("chromium")


@pytest.fixture(scope="session")
def qemu() -> list[str | Path | None]:
    """How a program for 64-bit ARM is run: the emulator, and where Debian's C library for it is."""
    return [program("qemu"), "-L", "/usr/aarch64-linux-gnu"]


@pytest.fixture(scope="session")
def built_page(pytestconfig: pytest.Config) -> Path:
    """The page, where it was built; `make page` builds it."""
    folder = pytestconfig.rootpath / "src" / "seacage" / "service" / "page"
    if not (folder / "index.html").is_file():
        skip_or_fail("chromium", "the page is not built; run `make page`")
    return folder


@pytest.fixture(scope="session")
def wheel(pytestconfig: pytest.Config, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """This machine's wheel, as pip makes it: built once, by the first worker that asks."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "wheel"
    folder.mkdir(exist_ok=True)
    with (folder / "lock").open("w") as lock:
        flock(lock, LOCK_EX)
        if not list(folder.glob("*.whl")):
            build = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps"]
            subprocess.run([*build, "--wheel-dir", folder, pytestconfig.rootpath], check=True)
    return next(folder.glob("*.whl"))


@pytest.fixture(scope="session")
def mosquitto(tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    """A broker of our own; its port on 127.0.0.1."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    settings = tmp_path_factory.mktemp("mosquitto") / "mosquitto.conf"
    settings.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\n")
    with serving([program("mosquitto"), "-c", settings]):
        wait_for(lambda: socket.create_connection(("127.0.0.1", port), timeout=1).close())
        yield port


@pytest.fixture(scope="session")
def postgres() -> Iterator[str]:
    """A server of our own, on a Unix socket alone; the address that libpq understands."""
    server = program("postgres").resolve()  # its tools lie beside it
    with tempfile.TemporaryDirectory() as folder:
        # PostgreSQL refuses to run as root, so root hands it to its own user.
        owner = {"user": "postgres", "cwd": "/"} if os.geteuid() == 0 else {}
        if owner:
            shutil.chown(folder, "postgres")
        tables = Path(folder, "tables")
        make = [server.with_name("initdb"), "-D", tables, "-U", "seacage", "--no-sync"]
        subprocess.run([*make, "--auth=trust"], check=True, capture_output=True, **owner)
        with serving([server, "-D", tables, "-k", folder, "-c", "listen_addresses="], **owner):
            address = f"host={folder} user=seacage dbname=postgres"
            asks = [server.with_name("psql"), address, "-c", "select 1"]
            wait_for(lambda: subprocess.run(asks, check=True, capture_output=True))
            yield address
