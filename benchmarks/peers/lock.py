"""Split a compiled lock in three: torch made for CUDA and all it needs, its CPU build, the rest.

Usage: lock.py COMPILED; `requirements.lock`, `torch-cuda.lock` and `torch-cpu.lock` are written
beside this file. The CPU build is no file of the public registry, so its hash stands here.
"""

import re
import sys
from pathlib import Path

CUDA = re.compile(r"(torch==|nvidia|cuda|triton)")
CPU_BUILD = "torch==2.13.0"
CPU_BUILD_SHA256 = {
    "Linux x86-64, CPython 3.11": "6746dbcbeb526eb61330b76b41ff1b4eb848951103a892eeb080dfa2b264667b"
}


def main(compiled: Path) -> None:
    entries = re.split(r"\n(?=[a-z])", compiled.read_text("utf-8").strip())
    cuda = [entry for entry in entries if CUDA.match(entry)]
    rest = [entry for entry in entries if not CUDA.match(entry)]
    assert any(entry.startswith(CPU_BUILD) for entry in cuda), "name the new CPU build's hashes"
    hashes = [f"--hash=sha256:{sha256}" for sha256 in CPU_BUILD_SHA256.values()]
    cpu = [" \\\n    ".join([f"{CPU_BUILD}+cpu", *hashes])]
    folder = Path(__file__).parent
    for name, chosen in (("requirements", rest), ("torch-cuda", cuda), ("torch-cpu", cpu)):
        (folder / f"{name}.lock").write_text("\n".join(chosen) + "\n", encoding="utf-8")


main(Path(sys.argv[1]))
