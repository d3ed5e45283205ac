"""The page's scripts do what their own tests say."""

import subprocess
from pathlib import Path

import pytest


def test_the_tests_of_the_pages_scripts_pass(node: Path, pytestconfig: pytest.Config) -> None:
    web = pytestconfig.rootpath / "web"
    tests = sorted(web.glob("test/**/*.test.js"))
    assert tests
    result = subprocess.run(
        [node, "--test", *tests], cwd=web, capture_output=True, text=True, check=False
    )
    assert not result.returncode, result.stdout[-4000:]


def test_node_reads_every_script_of_the_page(node: Path, pytestconfig: pytest.Config) -> None:
    scripts = sorted((pytestconfig.rootpath / "web").glob("src/**/*.js"))
    assert scripts
    for script in scripts:
        read = [node, "--input-type=module", "--check"]
        result = subprocess.run(read, input=script.read_bytes(), capture_output=True, check=False)
        assert not result.returncode, f"{script.name}: {result.stderr.decode()}"
