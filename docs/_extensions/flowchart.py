"""Flowcharts of Mermaid as trees of text: without a script, and found by the search."""

import re
from collections import defaultdict

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


class Flowchart(SphinxDirective):
    """A `flowchart` whose arrows all read `one["label"] --> other["label"]`."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Lay out the tree from the nodes that no arrow leads to."""
        text = "\n".join(self.content)
        labels = dict(re.findall(r'(\w+)\["([^"]+)"\]', text))
        arrows = re.findall(r"(\w+)(?:\[[^]]*\])? --> (\w+)", text)
        below = defaultdict[str, list[str]](list)
        for one, other in arrows:
            below[one].append(other)
        ends = {other for _, other in arrows}
        drawn = set[str]()

        def tree(names: list[str]) -> nodes.bullet_list:
            branch = nodes.bullet_list(classes=["flowchart"])
            for name in names:
                label = labels[name]
                item = nodes.list_item("", nodes.paragraph("", "", nodes.literal(label, label)))
                if name not in drawn and below[name]:
                    item += tree(below[name])
                drawn.add(name)
                branch += item
            return branch

        return [tree([name for name in labels if name not in ends])]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive, as which `conf.py` reads the fence `mermaid`."""
    app.add_directive("mermaid", Flowchart)
    return {"parallel_read_safe": True}
