"""The page's scripts are ES modules that a strict reader accepts."""

import subprocess
from pathlib import Path

import seacage


def test_node_reads_every_script_of_the_page(node: Path) -> None:
    scripts = sorted(Path(seacage.__file__).parent.glob("service/page/**/*.js"))
    assert scripts
    for script in scripts:
        read = [node, "--input-type=module", "--check"]
        told = subprocess.run(read, input=script.read_bytes(), capture_output=True, check=False)
        assert not told.returncode, f"{script.name}: {told.stderr.decode()}"
