// Things to turn that do not move by themselves: the arch, the ansatz, two observers, a cell, a sum.

const PAPERS = "the paper's";

// The true neighbour of a small wave of the paper's dimer, h cos(kappa (x + 1)), and the complex
// amplitude of the ansatz up to b_n, both over that of the heavy beads (`lwaAnsatz`: 1, b1 … b4).
function neighbour(terms, kappa) {
  const omega = lwaAnsatz.omega;
  const c = Math.cos(kappa);
  const h = (omega - 1 + Math.sqrt((1 - omega) ** 2 + 4 * omega * c * c)) / (2 * omega * c);
  let guess = [0, 0];
  lwaAnsatz.b.slice(0, terms + 1).forEach((b, n) => {
    const size = b * kappa ** n; // times i^n
    const [part, sign] = [n % 2, n % 4 < 2 ? 1 : -1];
    guess[part] += sign * size;
  });
  return {h, guess};
}

function guessError(terms, length) {
  const kappa = (2 * Math.PI) / length;
  const {h, guess} = neighbour(terms, kappa);
  return Math.hypot(guess[0] - h * Math.cos(kappa), guess[1] - h * Math.sin(kappa));
}

// Lengths of the pulse of spheres by the observers of the heavy and of the light beads.
function observed({omega, closure}) {
  if (closure !== PAPERS) return [1, 1].map(() => Math.PI / f.beta(1.5, 1, omega, 1));
  return [[1, omega], [omega, 1]].map(([m1, m2]) => Math.PI / f.paper_beta(1.5, m1, m2, 1));
}

// Mass below the place x of a cell of equal contacts, in units of the mean mass.
function massBelow(masses, x) {
  const mean = masses.reduce((sum, m) => sum + m, 0) / masses.length;
  return masses.slice(0, Math.ceil(x)).reduce((sum, m) => sum + m, 0) / mean;
}

// I/D^2, the variance of the mass below a place less the place: between two beads the difference
// falls evenly by one.
function cellVariance(masses) {
  const upper = masses.map((_, i) => massBelow(masses, i + 1) - i);
  const mean = upper.reduce((sum, a) => sum + a - 0.5, 0) / masses.length;
  const square = upper.reduce((sum, a) => sum + (a - 0.5 - mean) ** 2 + 1 / 12, 0);
  return square / masses.length;
}

// Length of the pulse of spheres in sites.
const cellLength = masses => (Math.PI / 0.5) * Math.sqrt(2 * 1.5 * 2.5 * cellVariance(masses));

// Left the staircase of the cell over its beads, right the pulse beside that of equal beads.
function drawCell({masses, bead}, pen) {
  const wide = pen.width > 460;
  const part = wide ? 0.5 : 1;
  const x = place => 26 + (place / 4) * (part * pen.width - 44);
  const low = wide ? pen.height - 40 : 0.56 * pen.height;
  const y = mass => low - (mass / 4) * (low - 30);
  const steps = [[x(0), y(0)]];
  masses.forEach((_, i) => {
    const above = massBelow(masses, i + 1);
    steps.push([x(i), y(above)], [x(i + 1), y(above)]);
  });
  pen.area([...steps, [x(4), y(4)], [x(0), y(0)]], LATTICE + "33");
  pen.line([[x(0), y(0)], [x(4), y(4)]], THEORY);
  pen.line(steps, LATTICE);
  masses.forEach((mass, i) => {
    const edge = i + 1 === bead ? THEORY : pen.ink;
    pen.disk(x(i + 0.5), low + 19, 8.5 * Math.cbrt(mass), HEAVY, edge);
  });
  legend(pen, [["mass up to a place", LATTICE], ["the place itself", THEORY]]);
  const left = wide ? 0.56 * pen.width : 10;
  const floor = wide ? pen.height - 26 : pen.height - 8;
  const height = wide ? pen.height - 80 : 0.26 * pen.height;
  const scale = ((wide ? 0.42 : 0.9) * pen.width) / 20; // pixels a site: the longest pulse has 20
  const middle = left + 10 * scale;
  for (const [several, style, dash] of [[[1, 1, 1, 1], pen.ink, [4, 4]], [masses, THEORY, []]]) {
    const points = curve(archOf(cellLength(several)), -10, 10, 400).map(([xi, v]) => [middle + scale * xi, floor - height * v]);
    pen.line(points, style, 2, dash);
  }
  if (wide) pen.text("pulse; dashed: equal balls", middle, floor + 18, {align: "center"});
}

const sums = k => lwaSums.find(one => Math.abs(one.k - k) < 0.01);

Object.assign(things, {
  // The arch over the beads, at rest: equal beads, peak strain 1.
  arch: {
    ask: "The exponent of the contacts doubles from 3/2 to 3. What does the length of the pulse do?",
    answers: ["it grows", "it stays", "it shrinks"],
    verdict() {
      const [long, brief] = [1.5, 3].map(k => Math.PI / f.beta(k, 1, 1, 1));
      return {right: 2, text: `it shrinks from ${long.toFixed(2)} to ${brief.toFixed(2)} beads.`};
    },
    then: {k: 3},
    label: "One arch of a power of a cosine over a row of beads",
    shape: 3.6,
    ...QUIET,
    controls: [EXPONENT],
    draw({k}, pen) {
      const x = xi => (xi / 13 + 0.5) * pen.width;
      const y = v => pen.height - 34 - v * (pen.height - 70);
      const radius = Math.min(0.46 * (x(1) - x(0)), 13);
      for (let j = -6; j <= 6; j++) pen.disk(x(j), pen.height - 16, radius, HEAVY, pen.ink);
      const strain = xi => Math.max(f.profile(xi, 1, k, 1, 1, 1), 0);
      const points = curve(strain, -6.4, 6.4, 480).map(([xi, v]) => [x(xi), y(v)]);
      pen.area([...points, [x(6.4), y(0)], [x(-6.4), y(0)]], THEORY + "22");
      pen.line(points, THEORY);
      const half = f.fwhm_strain(k, 1, 1, 1) / 2;
      pen.line([[x(-half), y(0.5)], [x(half), y(0.5)]], pen.ink, 1, [4, 3]);
      pen.text("width at half height", x(half) + 6, y(0.5) + 4);
      legend(pen, [["strain by the theory", THEORY]]);
    },
    tell({k}) {
      const length = Math.PI / f.beta(k, 1, 1, 1);
      const width = f.fwhm_strain(k, 1, 1, 1);
      const power = short(2 / (k - 1));
      return `The strain is cos(βξ) to the power ${power}: ${length.toFixed(2)} beads long, ${width.toFixed(2)} at half height.`;
    },
  },

  // The ansatz, term by term, beside the neighbour of a small wave of the dimer.
  ansatz: {
    ask: "A wave is ten balls long. The light balls are placed by the heavy ones' u and its derivatives: how many of b₁ … b₄ does it take to be right within one percent?",
    answers: ["one", "two", "three", "four"],
    verdict() {
      const errors = [1, 2, 3, 4].map(terms => percent(guessError(terms, 10)));
      return {right: 3, text: `with one to four terms the error is ${errors.join(", ")}.`};
    },
    then: {terms: 4},
    label: "A wave of heavy and light beads; rings show where the ansatz places the light beads",
    shape: 2.8,
    ...QUIET,
    controls: [
      {name: "terms", text: "terms b₁ to", low: 0, high: 4, step: 1, start: 0, show: n => (n ? `b${"₁₂₃₄"[n - 1]}` : "none")},
      {name: "length", text: "wavelength in beads", low: 4.5, high: 40, step: 0.5, start: 10, show: x => x.toFixed(1)},
    ],
    draw({terms, length}, pen) {
      const kappa = (2 * Math.PI) / length;
      const x = place => ((place + 1) / 26) * pen.width;
      const y = u => 0.6 * pen.height - 0.26 * pen.height * u;
      const {h, guess} = neighbour(terms, kappa);
      pen.line(curve(u => Math.cos(kappa * u), -0.6, 24.6).map(([p, u]) => [x(p), y(u)]), HEAVY, 1);
      for (let j = 0; j <= 24; j += 2) pen.disk(x(j), y(Math.cos(kappa * j)), 9, HEAVY, pen.ink);
      for (let j = 0; j <= 22; j += 2) {
        pen.disk(x(j + 1), y(h * Math.cos(kappa * (j + 1))), 5.5, LIGHT, pen.ink);
        const [re, im] = guess;
        const guessed = re * Math.cos(kappa * j) - im * Math.sin(kappa * j);
        pen.disk(x(j + 1), y(Math.max(Math.min(guessed, 1.5), -1.5)), 8, null, THEORY);
      }
      legend(pen, [["heavy beads, displacement u upwards", HEAVY], ["light beads", LIGHT], ["light beads by the ansatz", THEORY]]);
    },
    tell({terms, length}) {
      return `The guess errs by ${short(100 * guessError(terms, length))}\u00a0% of the heavy beads' amplitude.`;
    },
  },

  // What the two observers predict, each following one kind of bead.
  observers: {
    ask: "One observer follows the steel balls, the other the PTFE balls of the same chain. Do both predict a pulse of the same length?",
    answers: ["yes", "the steel balls' is longer", "the PTFE balls' is longer"],
    verdict() {
      const [steel, light] = observed({omega: 0.2733, closure: PAPERS});
      return {right: 1, text: `${steel.toFixed(2)} sites against ${light.toFixed(2)}, with the paper's closure, for one and the same chain.`};
    },
    label: "A row of two kinds of bead and the pulses that two observers predict",
    shape: 3,
    ...QUIET,
    controls: [
      {...RATIO, low: -1.3, high: 1.3},
      {name: "closure", text: "closure", options: [PAPERS, "the full one, in the common field"], start: PAPERS},
    ],
    draw(values, pen) {
      const lengths = observed(values);
      const [x, y] = [xi => (xi / 15 + 0.5) * pen.width, v => pen.height - 36 - v * (pen.height - 84)];
      const unit = Math.min(0.47 * (x(1) - x(0)), 15) / Math.cbrt(Math.max(values.omega, 1));
      for (let j = -7; j <= 7; j++) {
        const light = Math.abs(j % 2) === 1;
        const r = light ? unit * Math.cbrt(values.omega) : unit;
        pen.disk(x(j), pen.height - 17, Math.max(r, 2.5), light ? LIGHT : HEAVY, pen.ink);
      }
      [HEAVY, LIGHT].forEach((colour, i) => {
        const points = curve(archOf(lengths[i]), -7.4, 7.4, 480).map(([xi, v]) => [x(xi), y(v)]);
        pen.line(points, colour, i ? 2 : 3.5, i ? [7, 5] : []);
      });
      legend(pen, [["seen from the grey balls", HEAVY], ["seen from the orange balls", LIGHT]]);
    },
    tell(values) {
      const [steel, light] = observed(values);
      const apart = Math.abs(steel / light - 1) < 1e-9 ? "The two agree" : `Their ratio is ${short(steel / light)}`;
      return `Length of the pulse: ${steel.toFixed(2)} and ${light.toFixed(2)} sites. ${apart}.`;
    },
  },

  // A cell of four beads whose masses the reader sets: staircase, variance, width.
  cell: {
    ask: "A row of equal balls. Every fourth ball is made four times as heavy. What does the length of the pulse do?",
    answers: ["it grows", "it stays", "it shrinks"],
    verdict() {
      const [one, two] = [[1, 1, 1, 1], [4, 1, 1, 1]].map(masses => cellLength(masses));
      return {right: 0, text: `it grows from ${one.toFixed(2)} to ${two.toFixed(2)} sites.`};
    },
    then: {mass: 4},
    label: "Staircase of the mass of a cell over its place, the line of slope one, and the pulse above it",
    shape: 2.4,
    ...QUIET,
    controls: [
      {name: "bead", text: "bead", low: 1, high: 4, step: 1, start: 1, show: n => n.toFixed(0)},
      {name: "mass", text: "its mass", low: 0.1, high: 6, step: 0.1, start: 1},
    ],
    begin({bead, mass}, old) {
      const masses = [...(old?.masses ?? [1, 1, 1, 1])];
      if (!old || old.bead === bead) masses[bead - 1] = mass;
      return {bead, masses, controls: {mass: masses[bead - 1]}};
    },
    touch({masses}, x, y) {
      if (x > 1) return {};
      const bead = Math.min(4, Math.floor(4 * x) + 1);
      const mass = Math.max(0.1, Math.round(60 * (1 - y)) / 10);
      masses[bead - 1] = mass;
      return {bead, mass};
    },
    draw: drawCell,
    tell({masses}) {
      const I = cellVariance(masses);
      return `Masses ${masses.map(short).join(", ")}: variance I = ${I.toFixed(4)} D² (equal beads 0.0833), length of the pulse ${cellLength(masses).toFixed(2)} sites.`;
    },
  },

  // Partial sums of the series of c^2 beside the lattice's own wave.
  sum: {
    ask: "The partial sums of the series for c² are taken to ever higher order, for spheres. What does their error do?",
    answers: ["it falls without end", "it falls, then it grows", "it grows from the start"],
    verdict() {
      const errors = lwaSums.find(({k}) => k === 1.5).errors;
      const best = errors.indexOf(Math.min(...errors));
      const [least, end] = [errors[best], errors.at(-1)].map(x => tens(x, 0));
      return {right: 1, text: `it falls to ${least} at order ${best} and is ${end} again at order ${errors.length - 1}.`};
    },
    then: {order: 12},
    label: "Errors of the partial sums over their order, on a logarithmic axis",
    shape: 2.6,
    ...QUIET,
    controls: [
      {name: "order", text: "order", low: 0, high: 60, step: 1, start: 2, show: n => n.toFixed(0)},
      {name: "k", text: "exponent k", low: 1.1, high: 2, step: 0.1, start: 1.5, show: k => k.toFixed(1)},
    ],
    draw({order, k}, pen) {
      const {errors} = sums(k);
      const x = n => 46 + (n / 61) * (pen.width - 56);
      const y = error => pen.height - 34 - ((Math.log10(Math.max(error, 1e-12)) + 12) / 14) * (pen.height - 66);
      for (let power = -12; power <= 0; power += 3) {
        pen.line([[x(0), y(10 ** power)], [pen.width - 10, y(10 ** power)]], GHOST, 0.6);
        pen.text(power ? tens(10 ** power) : "1", 40, y(10 ** power) + 4, {align: "right", size: 11});
      }
      errors.forEach((error, n) => {
        const shown = n <= order;
        if (error < 50) pen.disk(x(n), y(error), n === order ? 6 : 3, shown ? LATTICE : null, shown ? null : GHOST);
      });
      pen.line([[x(0), y(sums(k).summed)], [pen.width - 10, y(sums(k).summed)]], THEORY);
      pen.text("order of the last term", pen.width / 2, pen.height - 8, {align: "center"});
      legend(pen, [["error of the partial sum of c²", LATTICE], ["the same 61 terms by a Padé approximant", THEORY]]);
    },
    tell({order, k}) {
      const {errors, truth} = sums(k);
      const error = errors[order] < 1e-12 ? `less than ${tens(1e-12, 0)}` : tens(errors[order], 1);
      return `c² of the lattice ${truth.toFixed(9)}; the sum to order ${order} errs by ${error}.`;
    },
  },
});
