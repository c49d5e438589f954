"""Matplotlib's players (`to_jshtml`) as the book shows them.

Their icons are the theme's own, so that no page asks the network for them, and where a visitor of
the page has nothing against motion the player that is tagged ``plays`` begins by itself.
"""

from __future__ import annotations

import re

from sphinx.application import Sphinx

_FOREIGN = re.compile(r"<link rel=\"stylesheet\"\s+href=\"https://[^\"]*font-awesome[^\"]*\">")
_START = """<script>
addEventListener("load", () => {
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) return;
  for (const play of document.querySelectorAll(".tag_plays .animation [title=Play]")) play.click();
});
</script>"""


def process(app: Sphinx, page: str, template: str, context: dict, doctree: object) -> None:
    """Replace what a page has of a player's head."""
    body = context.get("body", "")
    if "anim-controls" in body:
        context["body"] = _FOREIGN.sub("", body) + _START * ("tag_plays" in body)


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    app.connect("html-page-context", process)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
