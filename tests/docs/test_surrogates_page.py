"""The surrogates' page: its code runs as printed, and its printouts are those of its examples."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "surrogates.md").read_text("utf-8")
PRINTOUTS = re.findall(
    r"`(examples/\w+\.py)`(?:(?!```).)*?```text\n(.*?)```", PAGE, flags=re.DOTALL
)


def wording(text: str) -> str:
    """A printout without its numbers, whose last digits another machine may round otherwise."""
    return " ".join(re.sub(r"[-+.e\d]*\d", "#", text).split())


@pytest.mark.slow
def test_the_code_of_the_page_runs_in_its_order() -> None:
    blocks = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    assert len(blocks) > 5
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, "docs/surrogates.md", "exec"), names)


def test_the_page_prints_five_examples() -> None:
    assert len({example for example, _ in PRINTOUTS}) == 5


@pytest.mark.slow
@pytest.mark.parametrize(("example", "printed"), PRINTOUTS, ids=lambda one: one[:24])
def test_a_printout_is_worded_as_its_example_words_it(example: str, printed: str) -> None:
    run = subprocess.run(
        [sys.executable, str(ROOT / example)], capture_output=True, text=True, check=True
    )
    assert wording(run.stdout) == wording(printed)
