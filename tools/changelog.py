"""Gathers the fragments of changes/ into a section of CHANGELOG.md.

`python tools/changelog.py` prints the section of the next release; `tools/release.py` puts it in.
"""

import re
from datetime import date
from pathlib import Path

ROOT = Path(__file__).parents[1]
TITLES = {
    "removal": "Gone",
    "physics": "Numbers that come out differently",
    "feature": "New",
    "fix": "Mended",
    "doc": "Explained better",
}
"""Heading of each type of fragment, in the order of a release: what to act on comes first."""


def fragments(root: Path) -> list[tuple[int, str, Path]]:
    """Issue, type and file of each fragment; a file that is none is an error."""
    found = list[tuple[int, str, Path]]()
    for path in sorted((root / "changes").iterdir()):
        if path.name == "README.md":
            continue
        name = re.fullmatch(r"(\d+)\.(\w+)\.md", path.name)
        if name is None or name[2] not in TITLES:
            kinds = ", ".join(TITLES)
            raise ValueError(
                f"{path}: a fragment is named <issue>.<type>.md, its type one of {kinds}."
            )
        found.append((int(name[1]), name[2], path))
    return sorted(found)


def section(root: Path, title: str) -> str:
    """A release's part of the changelog: each line of a fragment is an entry with its issue."""
    parts = [f"## {title}"]
    for kind, heading in TITLES.items():
        entries = [
            f"- {line.replace('](../', '](')} (#{issue})"
            for issue, own, path in fragments(root)
            if own == kind
            for line in path.read_text().splitlines()
            if line.strip()
        ]
        if entries:
            parts += [f"### {heading}", "\n".join(entries)]
    return "\n\n".join(parts) + "\n"


def gather(root: Path, version: str, day: date) -> None:
    """Put the release's section before the older ones and take the fragments away."""
    changelog = root / "CHANGELOG.md"
    head, *older = re.split(r"(?m)^(?=## )", changelog.read_text(), maxsplit=1)
    new = section(root, f"{version} ({day:%Y-%m-%d})")
    changelog.write_text("\n".join([head.rstrip() + "\n", new, *older]))
    for _, _, path in fragments(root):
        path.unlink()


if __name__ == "__main__":
    print(section(ROOT, "Next release"))
