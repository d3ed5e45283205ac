"""A new user, with nothing but the commands of `docs/first-steps.md` and an empty environment.

The page is read from top to bottom: files are saved and added to as it says, an example of another
page too, commands run in one shell after the other, a service runs until "Ctrl-C".
`SEACAGE_MINUTES=file` writes what each section took.
"""

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import httpx
import pytest

from outside import wait_for

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGE = (DOCS / "first-steps.md").read_text()
STEP = re.compile(
    r"^## (?P<section>[^\n]+)$"
    r"|Save the example of \[(?P<page>[\w.]+)\][^\n]+ as `(?P<example>[\w.]+)`"
    r"|(?P<how>Save this as|Add this to) `(?P<file>[\w.-]+)`[^\n]*\n\n```\w+\n(?P<text>.*?)```"
    r"|```console\n(?P<commands>.*?)```"
    r"|(?P<stop>Stop it with Ctrl-C)",
    re.MULTILINE | re.DOTALL,
)
SYSTEM = "/usr/local/bin:/usr/bin:/bin"


class NewUser:
    """Somebody who types what the page says, in a folder and an environment of their own."""

    def __init__(self, folder: Path, wheel: Path) -> None:
        self.folder, self._wheel = folder, wheel
        self._variables = folder.parent / "variables.sh"
        self._variables.touch()
        bin_ = folder / "env/bin"
        python = Path(sys.executable).resolve().parent  # the first python3 that they find
        self._environment = {"HOME": str(folder), "PATH": f"{bin_}:{python}:{SYSTEM}", "LANG": "C"}
        self._environment |= {key: os.environ[key] for key in os.environ if key.startswith("PIP_")}
        with socket.create_server(("127.0.0.1", 0)) as free:
            self._port = free.getsockname()[1]
        self._service: subprocess.Popen[str] | None = None
        self.page = httpx.Client()

    def run(self, command: str) -> None:
        command = command.replace("seacage[sim]", f"{self._wheel}[sim]")
        command = command.replace("127.0.0.1:8000", f"127.0.0.1:{self._port}")
        if command.startswith("seacage serve "):
            self._serve(f"exec {command} --port {self._port}")
            return
        keep = f". {self._variables}\nset -ae\n{command}\nexport -p > {self._variables}"
        done = subprocess.run(
            ["bash", "-c", keep], cwd=self.folder, env=self._environment, capture_output=True,
            text=True, check=False, timeout=900,
        )  # fmt: skip
        assert done.returncode == 0, f"$ {command}\n{done.stdout}\n{done.stderr}"
        assert "warning" not in done.stderr.lower(), f"$ {command}\n{done.stderr}"

    def _serve(self, command: str) -> None:
        self.stop()
        self._service = subprocess.Popen(
            ["bash", "-c", command], cwd=self.folder, env=self._environment,
            stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        assert self._service.stdout
        for line in self._service.stdout:
            if found := re.match(r"Page +(http://\S+?)/#token=(\S+)", line):
                address, token = found.groups()
                headers = {"Authorization": f"Bearer {token}"}
                self.page.close()
                self.page = httpx.Client(base_url=address, headers=headers)
            if line.startswith("Stop"):
                wait_for(self._ask_ready, seconds=60)
                return
        raise AssertionError(f"{command} ended with {self._service.wait()}")

    def _ask_ready(self) -> None:
        try:
            self.page.get("/readyz").raise_for_status()
        except httpx.HTTPError as error:
            raise OSError("not ready yet") from error

    def state(self) -> dict:
        return self.page.get("/api/v1/cages/mine/state").raise_for_status().json()

    def stop(self) -> None:
        if self._service is not None:
            self._service.send_signal(signal.SIGINT)
            assert self._service.wait(timeout=60) in {0, 130, -signal.SIGINT}
            self._service.stdout.close()
            self._service = None


@pytest.fixture
def user(tmp_path, wheel):
    if not shutil.which("curl"):
        pytest.skip("curl is not installed")
    (tmp_path / "home").mkdir()
    one = NewUser(tmp_path / "home", wheel)
    yield one
    one.stop()
    one.page.close()


def until_valid(user: NewUser) -> dict:
    def attempt() -> None:
        if not user.state()["valid"]:
            raise OSError("no valid answer yet")

    wait_for(attempt, seconds=60)
    return user.state()


# What is to be seen at the end of a section, by its title
def look_at_the_cage(user: NewUser, seen: dict) -> None:
    assert (user.folder / "mine.png").stat().st_size > 10_000


def look_at_the_twin(user: NewUser, seen: dict) -> None:
    assert (user.folder / "twin/model.json").exists()


def look_at_their_twin(user: NewUser, seen: dict) -> None:
    model = json.loads((user.folder / "their-twin/model.json").read_text())
    assert "Mine 1.0" in json.dumps(model)


def look_at_the_record(user: NewUser, seen: dict) -> None:
    assert (user.folder / "guess.toml").read_text().count('"?"')


def look_at_the_page(user: NewUser, seen: dict) -> None:
    state = until_valid(user)
    assert all(one["tension_kn"]["mean"] > 0.0 for one in state["bridles"])
    assert 0.3 < state["water"]["current_speed_m_s"] < 0.5
    seen["first"] = state["twin"]


def look_at_the_second_twin(user: NewUser, seen: dict) -> None:
    state = until_valid(user)
    assert state["twin"] != seen["first"]
    seen["second"] = state["twin"]


def look_elsewhere(user: NewUser, seen: dict) -> None:
    assert until_valid(user)["twin"] == seen["second"]
    lines = user.page.get("/api/v1/cages/mine/journal").json()["lines"]
    assert [one["why"] for one in lines if one["action"] == "replaced"] == ["36 cases"]
    page = user.page.get("/", follow_redirects=True)
    assert (page.status_code, "seacage" in page.text) == (200, True)


LOOKS = {
    "The cage": look_at_the_cage,
    "A twin": look_at_the_twin,
    "A twin of another simulator": look_at_their_twin,
    "Your record": look_at_the_record,
    "The live page": look_at_the_page,
    "Another twin": look_at_the_second_twin,
    "A backup, elsewhere": look_elsewhere,
}


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_the_page_leads_a_new_user_from_nothing_to_a_live_cage_and_its_backup(user):
    seen, minutes, title, began = {}, {}, "", time.monotonic()

    def end_section() -> None:
        if title in LOOKS:
            LOOKS[title](user, seen)
        minutes[title] = (time.monotonic() - began) / 60.0

    for step in STEP.finditer(PAGE):
        if step["section"]:
            end_section()
            title, began = step["section"], time.monotonic()
        elif step["page"]:
            (code,) = re.findall(
                r"```python\n(.*?)```", (DOCS / step["page"]).read_text(), re.DOTALL
            )
            (user.folder / step["example"]).write_text(code)
        elif step["file"]:
            with (user.folder / step["file"]).open("w" if "Save" in step["how"] else "a") as file:
                file.write(step["text"])
        elif step["commands"]:
            for command in step["commands"].strip().splitlines():
                user.run(command.removeprefix("$ "))
        else:
            user.stop()
    end_section()
    assert LOOKS.keys() <= minutes.keys()
    if path := os.environ.get("SEACAGE_MINUTES"):
        Path(path).write_text("".join(f"{one}: {spent:.2f}\n" for one, spent in minutes.items()))
