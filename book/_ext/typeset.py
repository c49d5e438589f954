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
_UNIT = rf" (?=(?:{'|'.join(map(re.escape, UNITS))})(?!\w))"
APART = re.compile(rf"(?<=\d){_UNIT}")
FIRST = re.compile(rf"^{_UNIT}")
NO_BREAK = "\u00a0"
LITERAL = (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block, nodes.raw)


class Units(SphinxPostTransform):
    """Put a no-break space between a number and a unit."""

    default_priority = 900

    def run(self, **options: object) -> None:
        for parent in list(self.document.findall(nodes.Element)):
            if isinstance(parent, LITERAL):
                continue
            before: nodes.Node | None = None
            for place, child in enumerate(parent.children):
                if isinstance(child, nodes.Text):
                    joined = APART.sub(NO_BREAK, child)
                    # a formula in front of the text may end in the number
                    if isinstance(before, nodes.math):
                        joined = FIRST.sub(NO_BREAK, joined)
                    if joined != child:
                        parent[place] = nodes.Text(joined)
                before = child


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
