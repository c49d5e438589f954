"""Still pictures of the things to turn, for readers without JavaScript and for paper.

The book's scripts run in Node.js with a pen that writes SVG in place of their pen on a canvas.

    python book/stills.py

draws `_static/stills/NAME.svg`.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

HERE = Path(__file__).parent
FOLDER = HERE / "_static" / "stills"

# What the scripts ask of a browser.
PAGE = """
const matchMedia = () => ({}), window = globalThis;
const document = {querySelectorAll: () => []};
"""

PEN = """
const round = x => Number(x.toFixed(1));
class Svg {
  constructor(shape) {
    this.width = 700;
    this.height = Math.round(this.width / shape);
    this.ink = "#333";
    this.parts = [];
  }
  put(name, attributes, words = "") {
    const text = Object.entries(attributes).map(([key, value]) =>
      `${key}="${typeof value === "number" ? round(value) : value}"`);
    this.parts.push(`<${name} ${text.join(" ")}>${words}</${name}>`);
  }
  disk(cx, cy, r, fill, edge) {
    this.put("circle", {cx, cy, r: Math.max(r, 0.5), fill: fill || "none", stroke: edge || "none"});
  }
  bar(x, y, width, height, fill) {
    if (height > 0.05) this.put("rect", {x, y, width, height, fill});
  }
  path(points) {
    return points.map(([x, y]) => `${round(x)},${round(y)}`).join(" ");
  }
  line(points, stroke, width = 2, dash = []) {
    const style = {fill: "none", stroke, "stroke-width": width, "stroke-dasharray": dash.join(" ")};
    this.put("polyline", {points: this.path(points), ...style});
  }
  area(points, fill) {
    this.put("polygon", {points: this.path(points), fill});
  }
  text(words, x, y, {fill = this.ink, align = "left", size = 13} = {}) {
    const anchor = {left: "start", center: "middle", right: "end"}[align];
    this.put("text", {x, y, fill, "font-size": size, "text-anchor": anchor}, words);
  }
  get written() {
    const size = `viewBox="0 0 ${this.width} ${this.height}"`;
    const head = `<svg xmlns="http://www.w3.org/2000/svg" ${size} font-family="sans-serif">`;
    return [head, ...this.parts, "</svg>", ""].join("\\n");
  }
}
"""

# Each thing at its start, four seconds on; the calculator's record.
DRAW = """
const drawn = {};
for (const [name, thing] of Object.entries(lwaTurn.things)) {
  const values = {};
  for (const control of thing.controls ?? []) values[control.name] = control.start;
  const scene = thing.begin(values, null);
  lwaTurn.toRest(thing, scene);
  const pen = new Svg(thing.shape);
  thing.draw(scene, pen);
  drawn[name] = pen.written;
}
const pen = new Svg(3);
lwaTurn.drawRecord(lwaTurn.calculate({
  a: "steel 316", b: "PTFE", radiusA: 2.38e-3, radiusB: 2.38e-3,
  load: 0, blow: 1.37, kind: "velocity",
}), pen);
drawn.calculator = pen.written;
console.log(JSON.stringify(drawn));
"""


def program() -> str:
    """The page's scripts with the constants of all pages."""
    sys.path += [str(HERE), str(HERE / "_ext")]  # the pages' own modules
    interactive, turned = map(import_module, ("interactive", "turned"))
    tags = (
        turned.sums(),
        turned.breathers(),
        turned.losses(),
        turned.closed_forms(),
    )
    constants = [re.sub(r"</?script>", "", tag) for tag in tags]
    return "\n".join([PAGE, interactive.formulas(), *constants, interactive.written()])


def main() -> None:
    """Draw all pictures."""
    source = program() + PEN + DRAW
    run = subprocess.run(
        ["node", "-"], input=source, capture_output=True, text=True, check=False
    )
    if run.returncode:
        raise SystemExit(run.stderr)
    FOLDER.mkdir(exist_ok=True)
    for name, text in json.loads(run.stdout).items():
        (FOLDER / f"{name}.svg").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
