"""`seacage serve` as a process that tests kill and start again."""

import json
import os
import socket
import subprocess
import sys
from contextlib import contextmanager

import httpx

from outside import wait_for

SEACAGE = [sys.executable, "-c", "from seacage.service import main; main()"]


class Service:
    """`seacage serve` on a port that stays the same; its admin token outlives it."""

    def __init__(self, folder, *words):
        with socket.create_server(("127.0.0.1", 0)) as free:
            self._port = free.getsockname()[1]
        command = [*SEACAGE, "serve", "--data", folder / "data", "--port", self._port, "--json"]
        self._command = [str(word) for word in (*command, *words)]
        self._log = (folder / "log").open("ab")
        self._process = None
        self.client = httpx.Client(base_url=f"http://127.0.0.1:{self._port}/api/v1/cages/ace/")

    def start(self):
        threads = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
        self._process = subprocess.Popen(
            self._command, stdout=subprocess.PIPE, stderr=self._log, env=os.environ | threads
        )
        answer = json.loads(self._process.stdout.readline())
        if "admin_token" in answer:
            self.client.headers["Authorization"] = f"Bearer {answer['admin_token']}"
        wait_for(self._ask_ready, seconds=60)

    def _ask_ready(self):
        try:
            httpx.get(f"http://127.0.0.1:{self._port}/readyz").raise_for_status()
        except httpx.HTTPError as error:
            raise OSError("not yet") from error

    def kill(self):
        self._process.kill()
        self._process.wait()
        self._process.stdout.close()

    def close(self):
        self.client.close()
        if self._process is not None:
            self.kill()
        self._log.close()

    def until(self, call, accept):
        """What is asked, once it is as it should be."""

        def attempt():
            if not accept(self.client.get(call).raise_for_status().json()):
                raise OSError("not yet")

        wait_for(attempt, seconds=60)
        return self.client.get(call).json()


@contextmanager
def served(*what):
    one = Service(*what)
    try:
        one.start()
        yield one
    finally:
        one.close()
