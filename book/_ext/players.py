"""Matplotlib's players (`to_jshtml`) as the book shows them.

Their icons are the theme's own, so that no page asks the network for them; their frames have 64
colours, which makes them small; and where a visitor of the page has nothing against motion the
player that is tagged ``plays`` begins by itself.
"""

from __future__ import annotations

import base64
import io
import re

from PIL import Image
from sphinx.application import Sphinx

_FOREIGN = re.compile(r"<link rel=\"stylesheet\"\s+href=\"https://[^\"]*font-awesome[^\"]*\">")
_FRAME = re.compile(r"(?<=frames\[)(\d+\] = \"data:image/png;base64,)([^\"]*)(?=\")")
_START = """<script>
addEventListener("load", () => {
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) return;
  for (const play of document.querySelectorAll(".tag_plays .animation [title=Play]")) play.click();
});
</script>"""


def _fewer_colours(frame: re.Match[str]) -> str:
    with Image.open(io.BytesIO(base64.b64decode(frame[2].replace("\\", "")))) as image:
        small = io.BytesIO()
        image.convert("RGB").quantize(64).save(small, "PNG", optimize=True)
    return frame[1] + base64.b64encode(small.getvalue()).decode()


def process(app: Sphinx, page: str, template: str, context: dict, doctree: object) -> None:
    """Replace what a page has of a player's head."""
    body = context.get("body", "")
    if "anim-controls" in body:
        body = _FRAME.sub(_fewer_colours, body)
        context["body"] = _FOREIGN.sub("", body) + _START * ("tag_plays" in body)


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    app.connect("html-page-context", process)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
