"""The few pieces of HTML that a report is made of; all text is escaped on its way in."""

import base64
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib import resources
from typing import TYPE_CHECKING

from seacage.figures import svg_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_LOOKS = {"holds": "better", "reproduced": "better", "missed": "worse", "not reproduced": "worse"}


class Html(str):
    """Text that is HTML already."""

    __slots__ = ()


def text(content: str) -> Html:
    """Content as HTML: escaped unless it is HTML already."""
    return content if isinstance(content, Html) else Html(escape(content))


def tag(name: str, *content: str, look: str = "") -> Html:
    """One element around its content, with a class where it has a look."""
    attribute = f' class="{look}"' if look else ""
    inside = "".join(text(part) for part in content)
    return Html(f"<{name}{attribute}>{inside}</{name}>")


def table(head: Sequence[str], rows: Iterable[Sequence[str]], *, caption: str) -> Html:
    """A table whose first column names the rows."""
    heading = tag("thead", tag("tr", *(tag("th", cell) for cell in head)))
    body = [tag("tr", tag("th", row[0]), *(tag("td", cell) for cell in row[1:])) for row in rows]
    return tag(
        "div", tag("table", tag("caption", caption), heading, tag("tbody", *body)), look="wide"
    )


def facts(entries: Mapping[str, str]) -> Html:
    """Names and what they are, a line break for each line."""
    pairs = (
        tag("dt", name) + tag("dd", Html(text(value).replace("\n", "<br>")))
        for name, value in entries.items()
    )
    return tag("dl", *map(Html, pairs), look="facts")


def claims(entries: Iterable[tuple[str, str, str]]) -> Html:
    """Verdict, claim and finding of each claim, with the look of its verdict."""
    parts = (
        tag("dt", verdict, look=_LOOKS.get(verdict, "unproven"))
        + tag("dd", tag("strong", claim), " ", finding)
        for verdict, claim, finding in entries
    )
    return tag("dl", *map(Html, parts), look="claims")


def picture(figure: "Figure", *, caption: str, alternative: str, look: str = "") -> Html:
    """A figure as an embedded SVG image, which keeps its identifiers to itself."""
    content = base64.b64encode(svg_text(figure).encode()).decode()
    image = Html(f'<img src="data:image/svg+xml;base64,{content}" alt="{escape(alternative)}">')
    return tag("figure", image, tag("figcaption", caption), look=look)


def bar(share: float) -> Html:
    """A bar that is filled to a share."""
    return Html(f'<span class="bar"><i style="width:{100.0 * min(share, 1.0):.0f}%"></i></span>')


def page(title: str, *content: Html) -> str:
    """A whole document that needs nothing beside itself."""
    style = (resources.files("seacage.studies") / "report.css").read_text("utf-8")
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>\n{style}</style>\n</head>\n"
        f"<body>\n{tag('main', *content)}\n</body>\n</html>\n"
    )
