"""What one reader's long answers cost those who send samples, and the memory of the service.

`seacage serve` runs in a process of its own with 10,000 readings of a buoy. Its twin is a small
one, or that of `--twin`: the demonstration's, which `seacage serve` makes, has the full cage.
A logger sends nine samples ten times a second, first alone and then while one reader asks for
`history.nc?limit=10000` forty times at once; whoever is refused with 429 asks again when it was
told to, until all have theirs or two minutes are over.
"""

import os
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
import numpy as np
from _timing import ONCE

from seacage.service._auth._token_store import Tokens
from seacage.testing import stand_in_twin
from seacage.twin import Twin

ROWS, READERS = (60, 4) if ONCE else (10_000, 40)
ALONE_S = 1.0 if ONCE else 15.0
LONGEST_S = 120.0
STEP = timedelta(minutes=1)
URL = "/api/v1/cages/ace"


def served_twin(folder: Path) -> tuple[Path, Twin]:
    """Find the twin that `--twin` names, else make a small one."""
    if "--twin" in sys.argv:
        folder = Path(sys.argv[sys.argv.index("--twin") + 1])
        return folder, Twin.read(folder)
    twin = stand_in_twin()
    twin.write(folder)
    return folder, twin


def spoken(t: datetime, turn: int, sensors: tuple[str, ...]) -> list[dict[str, object]]:
    """What the buoy and the depth sensors say at a time."""
    water = {"current_speed_m_s": 0.5 + 0.3 * np.sin(turn / 200.0), "current_to_deg": 90.0}
    water |= {"hs_m": 1.0 + 0.2 * np.sin(turn / 100.0), "tp_s": 6.0, "wave_from_deg": 270.0}
    when = t.isoformat()
    depths = [
        {"stream": n, "t": when, "values": {"depth_m": 14.0 + 0.1 * np.sin(turn)}} for n in sensors
    ]
    return [{"stream": "buoy-1", "t": when, "values": water}, *depths]


def megabytes(pid: int) -> float:
    """Resident memory of a process."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def sending(client: httpx.Client, sensors: tuple[str, ...], over: threading.Event) -> list[float]:
    """Send samples ten times a second until something is over; what each request took [s]."""
    taken, turn = list[float](), 0
    while not over.is_set():
        began = time.monotonic()
        body = {"samples": spoken(datetime.now(UTC), turn, sensors)}
        client.post(f"{URL}/samples", json=body).raise_for_status()
        taken.append(time.monotonic() - began)
        turn += 1
        over.wait(max(0.0, 0.1 - taken[-1]))
    return taken


def read(client: httpx.Client, end: float, seen: Counter[int]) -> None:
    """Ask for a long answer until it comes."""
    while time.monotonic() < end:
        with client.stream("GET", f"{URL}/history.nc", params={"limit": ROWS}) as answer:
            for _ in answer.iter_raw():
                pass
        seen[answer.status_code] += 1
        if answer.status_code != 429:
            return
        time.sleep(float(answer.headers["Retry-After"]))


def loaded(pid: int, logger: httpx.Client, reader: httpx.Client, sensors: tuple[str, ...]) -> None:
    """Send alone, then beside the readers, and print what it took."""
    over, remembered, seen = threading.Event(), list[float](), Counter[int]()

    def remember() -> None:
        while not over.wait(0.05):
            remembered.append(megabytes(pid))

    with ThreadPoolExecutor(READERS + 2) as pool:
        alone = pool.submit(sending, logger, sensors, over)
        time.sleep(ALONE_S)
        over.set()
        print_times("alone", alone.result())
        over.clear()
        before, began = megabytes(pid), time.monotonic()
        beside, memory = pool.submit(sending, logger, sensors, over), pool.submit(remember)
        reads = [pool.submit(read, reader, began + LONGEST_S, seen) for _ in range(READERS)]
        for one in reads:
            one.result()
        took = time.monotonic() - began
        over.set()
        print_times("beside the reads", beside.result())
        memory.result()
    print(f"  answers        {dict(seen)} in {took:.0f} s")
    print(f"  memory         {before:.0f} MB before, {max(remembered) - before:+.0f} MB at most")


def print_times(what: str, seconds: list[float]) -> None:
    """Print what requests took."""
    half, late, worst = 1e3 * np.quantile(seconds, (0.5, 0.99, 1.0))
    print(f"  {what:<16} {half:.0f} ms half, {late:.0f} ms p99, {worst:.0f} ms at most")


def main(folder: Path) -> None:
    """Serve a cage and load it."""
    place, twin = served_twin(folder / "twin")
    sensors = tuple(one.name for one in twin.cage.depth_sensors)
    tokens = Tokens(folder)
    keys = [tokens.mint([scope], keep=True) for scope in ("ingest", "read")]
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    program = [str(Path(sys.executable).with_name("seacage")), "serve", "--twin", str(place)]
    program += ["--data", str(folder), "--cage", "ace", "--port", str(port)]
    limits = httpx.Limits(max_connections=None)
    with subprocess.Popen(program, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as served:
        try:
            logger, reader = (
                httpx.Client(
                    base_url=f"http://127.0.0.1:{port}",
                    headers={"Authorization": f"Bearer {key}"},
                    timeout=600.0,
                    limits=limits,
                )
                for key in keys
            )
            for _ in range(600):
                with suppress(httpx.ConnectError):
                    logger.get("/healthz")
                    break
                time.sleep(0.1)
            start = datetime.now(UTC) - ROWS * STEP
            for first in range(0, ROWS, 1000):
                past = [
                    spoken(start + k * STEP, k, ())[0]
                    for k in range(first, min(first + 1000, ROWS))
                ]
                logger.post(f"{URL}/samples", json={"samples": past}).raise_for_status()
            print(f"{READERS} reads of {ROWS} rows by one reader")
            loaded(served.pid, logger, reader, sensors)
        finally:
            served.terminate()


with tempfile.TemporaryDirectory() as place:
    main(Path(place))
