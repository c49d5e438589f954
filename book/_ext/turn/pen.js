// Drawing: a pen on a canvas, and what several pictures share. The program `stills.py` has a second
// pen with the same methods, which writes SVG.

const LATTICE = "#2C8FCB";
const THEORY = "#D55E00";
const HEAVY = "#5A6F8C"; // seen on white and on black
const LIGHT = "#E69F00";
const GHOST = "#909090AA";

// The page's own colour of text, for words and axes.
const ink = () =>
  getComputedStyle(document.documentElement).getPropertyValue("--pst-color-text-base") || "#333";

class Pen {
  // shape: width over height; least: of the height, so that on a phone a picture is less flat.
  constructor(canvas, {shape, least = 220}) {
    const ratio = window.devicePixelRatio || 1;
    this.width = canvas.clientWidth || 600;
    this.height = Math.round(Math.max(this.width / shape, least));
    canvas.width = this.width * ratio;
    canvas.height = this.height * ratio;
    canvas.style.height = `${this.height}px`;
    this.ink = ink();
    this.to = canvas.getContext("2d");
    this.to.scale(ratio, ratio);
  }

  disk(x, y, r, fill, edge = null) {
    this.to.beginPath();
    this.to.arc(x, y, Math.max(r, 0.5), 0, 2 * Math.PI);
    if (fill) {
      this.to.fillStyle = fill;
      this.to.fill();
    }
    if (edge) this.stroke(edge, 1);
  }

  // A bar from (x, y) to the right and down.
  bar(x, y, width, height, fill) {
    this.to.fillStyle = fill;
    this.to.fillRect(x, y, width, height);
  }

  line(points, style, width = 2, dash = []) {
    this.to.beginPath();
    points.forEach(([x, y]) => this.to.lineTo(x, y));
    this.to.setLineDash(dash);
    this.stroke(style, width);
    this.to.setLineDash([]);
  }

  stroke(style, width) {
    this.to.strokeStyle = style;
    this.to.lineWidth = width;
    this.to.stroke();
  }

  area(points, fill) {
    this.to.beginPath();
    points.forEach(([x, y]) => this.to.lineTo(x, y));
    this.to.fillStyle = fill;
    this.to.fill();
  }

  text(words, x, y, {fill = this.ink, align = "left", size = 13} = {}) {
    this.to.font = `${size}px system-ui, sans-serif`;
    this.to.textAlign = align;
    this.to.fillStyle = fill;
    this.to.fillText(words, x, y);
  }
}

// Points of a function over a stretch.
function curve(g, from, to, count = 240) {
  return Array.from({length: count + 1}, (_, i) => {
    const x = from + ((to - from) * i) / count;
    return [x, g(x)];
  });
}

// The pulse of spheres over its peak: the arch of a length.
const archOf = length => xi => (2 * Math.abs(xi) < length ? Math.cos((Math.PI * xi) / length) ** 6 : 0);

// Names of a picture's curves, each in its own colour, in the upper left corner.
function legend(pen, entries) {
  entries.forEach(([words, colour], line) => {
    const y = 14 + 17 * line;
    pen.bar(2, y - 8, 14, 6, colour);
    pen.text(words, 22, y);
  });
}

// Names of curves in a picture of a row.
const BARS = ["force in each contact", LATTICE];
const LINE = ["long-wave theory", THEORY];
const TRAIL = ["highest force so far", GHOST];

// A row of beads with bars of the dynamic force in its contacts.
//   top: force at the upper edge. from, to: beads at the left and right edge.
//   arch: dynamic force of the theory over the place, or null. before: a lattice drawn in grey.
//   trail: whether the highest force of each contact stays. words: of the legend.
// Returns the functions from beads and forces to the picture, and the height below the legend.
function drawRow(pen, lattice, top, {from = 0, to = lattice.n - 1, ...more} = {}) {
  const {arch = null, before = null, trail = true, words = [BARS], light = LIGHT} = more;
  const site = pen.width / (to - from + 2);
  const x = i => (i - from + 1) * site;
  const radius = Math.min(0.48 * site, 0.16 * pen.height);
  const base = pen.height - 2 * radius - 8;
  const y = force => base - (Math.min(Math.max(force, 0), top) / top) * (base - 8);
  const first = Math.max(0, Math.floor(from) - 1);
  const last = Math.min(lattice.n - 1, Math.ceil(to) + 1);
  const bars = (these, fill) => {
    for (let i = first; i < last; i++) {
      const upper = y(these.contact[i] - these.load);
      pen.bar(x(i + 0.5) - 0.3 * site, upper, 0.6 * site, base - upper, fill);
    }
  };
  if (before) bars(before, GHOST);
  bars(lattice, LATTICE);
  for (let i = first; trail && i < last; i++) {
    const most = lattice.trails[i]?.most;
    if (most) pen.bar(x(i + 0.5) - 0.3 * site, y(most) - 1, 0.6 * site, 2, GHOST);
  }
  if (arch) {
    const seen = curve(arch, from - 0.5, to + 0.5, 600).filter(([, force]) => force > 2e-3 * top);
    pen.line(seen.map(([place, force]) => [x(place), y(force)]), THEORY);
  }
  // Displacements are enlarged so that the strongest contact closes by a sixth of a site.
  let most = 0.02;
  for (let i = 0; i + 1 < lattice.n; i++) {
    most = Math.max(most, Math.abs(lattice.u[i] - lattice.u[i + 1]));
  }
  const moved = lattice.wall ? 0 : (0.17 * site) / most;
  const heaviest = Math.max(...lattice.mass.slice(0, lattice.n));
  for (let i = first; i <= last; i++) {
    const share = lattice.mass[i] / heaviest;
    const r = radius * (share < 1 ? Math.max(Math.cbrt(share), 0.3) : 1);
    const fill = share < 0.999 ? light : HEAVY;
    pen.disk(x(i) + moved * lattice.u[i], pen.height - radius - 4, r, fill, pen.ink);
  }
  legend(pen, words);
  return {x, y, base, below: 6 + 17 * words.length};
}
