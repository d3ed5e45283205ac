"""The counts of what is hard to read."""

import ast

import pytest

from tools.house import Found, count_node


def kinds(text: str) -> list[str]:
    """What is counted of a few lines."""
    found, tree = Found(list), ast.parse(text)
    for owner in ast.walk(tree):
        for node in ast.iter_child_nodes(owner):
            count_node(node, owner, "here", found)
    return sorted(kind for kind, places in found.items() for _ in places)


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("last_told = 1", "names with a word of our own"),
        ("def f(lessons): pass", "names with a word of our own"),
        ("class ToldOnce: pass", "names with a word of our own"),
        ("x = 'what was taught'", "prose with a word of our own"),
        ("def turned(x) -> float: pass", "functions named by a participle"),
        ("class A:\n def kept(self) -> int: pass", "functions named by a participle"),
        ("class Herald: pass", "classes of the rename table"),
    ],
)
def test_each_kind_is_found(text: str, kind: str) -> None:
    assert kinds(text) == [kind]


@pytest.mark.parametrize(
    "text",
    [
        "class Cage:\n def rotated(self) -> 'Cage': pass",
        "class Cage:\n def rotated(self) -> Self: pass",
        "def feed(x): pass",
        "retold = household = 1",
    ],
)
def test_what_reads_well_is_not_counted(text: str) -> None:
    assert not kinds(text)
