"""Typesetting of the pages: numbers beside their units, and names of folded cells.

A cell that is folded whole is the solution of an exercise; of others the code is folded.
"""

from __future__ import annotations

import re

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms.post_transforms import SphinxPostTransform

UNITS = (
    "%", "percent", "mm", "cm", "m/s", "m", "µm", "nm", "N", "kN", "GPa", "MPa", "µs", "ms", "s",
    "kHz", "Hz", "kg", "g", "J", "MB", "sites", "beads", "balls", "loads", "orders", "ratios",
)  # fmt: skip
APART = re.compile(rf"(?<=\d) (?=(?:{'|'.join(map(re.escape, UNITS))})(?!\w))")
LITERAL = (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block, nodes.raw)


class Units(SphinxPostTransform):
    """Put a no-break space between a number and a unit."""

    default_priority = 900

    def run(self, **options: object) -> None:
        for text in list(self.document.findall(nodes.Text)):
            parent = text.parent
            joined = APART.sub("\u00a0", text)
            # a formula in front of the text may end in the number
            if isinstance(previous(text), nodes.math):
                joined = re.sub(
                    APART.pattern.replace(r"(?<=\d)", "^"), "\u00a0", joined
                )
            if joined != text and not isinstance(parent, LITERAL):
                parent.replace(text, nodes.Text(joined))


def previous(node: nodes.Node) -> nodes.Node | None:
    """The node before a node in its parent."""
    before = None
    for child in node.parent.children:
        if child is node:
            return before
        before = child
    return None


class Solutions(SphinxPostTransform):
    """Name folded solutions."""

    default_priority = 198  # before MyST-NB folds the cells

    def run(self, **options: object) -> None:
        for cell in self.document.findall(nodes.container):
            if cell.get("hide_mode") == "all":
                cell["prompt_show"] = "Solution"
                cell["prompt_hide"] = "Hide the solution"


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    app.add_post_transform(Units)
    app.add_post_transform(Solutions)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
