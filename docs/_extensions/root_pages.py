"""Pages whose text is a file outside of docs/: the file is read in the place of the link to it."""

import os
import re
from pathlib import Path

from sphinx.application import Sphinx

from tools.changelog import section

STUB = re.compile(r"The text of this page is \[.+\]\((.+)\)\.\n")
LINK = re.compile(r"\[([^]\[]*)\]\((?![a-z]+:|#)([^)#]+)(#[^)]*)?\)")


def own_pages(docs: Path) -> dict[Path, Path]:
    """Page of each file outside of docs/ that has one."""
    stubs = ((path, STUB.fullmatch(path.read_text())) for path in docs.glob("*.md"))
    return {(docs / stub[1]).resolve(): path for path, stub in stubs if stub}


def read(app: Sphinx, name: str, text: list[str]) -> None:
    """Take the file's text for a page's, its links as they are from there."""
    docs, pages = Path(app.srcdir), own_pages(Path(app.srcdir))
    page = docs / f"{name}.md"
    source = next((file for file, own in pages.items() if own == page), page)
    if source != page:
        text[0] = source.read_text()
    if source.name == "CHANGELOG.md":
        text[0] += "\n" + section(docs.parent, "Not yet released")

    def moved(link: re.Match[str]) -> str:
        target = (source.parent / link[2]).resolve()
        if target.is_dir():
            return link[1]
        target = Path(os.path.relpath(pages.get(target, target), page.parent))
        return f"[{link[1]}]({target.as_posix()}{link[3] or ''})"

    text[0] = LINK.sub(moved, text[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Listen to what is read."""
    app.connect("source-read", read)
    return {"parallel_read_safe": True}
