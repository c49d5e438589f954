// Things to turn in the first part of the book: the pulse, its arch, the ansatz, a cell.

const tenth = x => 10 ** x;

// A slider of the blow's velocity, the mass ratio, the exponent or the load.
const BLOW = {name: "v", text: "velocity of the blow", low: 0.2, high: 2, step: 0.05, start: 1};
const RATIO = {
  name: "omega", text: "mass ratio ω", low: -1.7, high: 0, step: 0.01, start: 0.2733, value: tenth,
};
const PAPERS = "the paper's";
const EXPONENT = {name: "k", text: "exponent k", low: 1.1, high: 4, step: 0.05, start: 1.5};

// A struck row whose scale and clock stay while a slider moves; the row as it was before runs along.
// make: values -> lattice. last: contact at which the picture ends.
function struckRow(values, old, make, last) {
  const probe = make(values);
  probe.to(8, 4000);
  const peak = Math.max(...probe.arrivals.slice(1).map(arrival => arrival.force), 1e-6);
  const sites = probe.arrivals[8]?.time - probe.arrivals[4]?.time || 8;
  return {
    values: {...values}, lattice: make(values), last: last ?? probe.end,
    before: old?.before ? make(old.before) : null,
    top: Math.max(1.3 * peak, old?.top || 0),
    pace: old?.pace || sites / 40, // a site in ten pictures
  };
}

function runRow(scene, ticks) {
  for (const lattice of [scene.lattice, scene.before]) lattice?.advance(scene.pace * ticks);
  return scene.lattice.arrivals.length <= scene.last && scene.lattice.time < 4000 * scene.pace;
}

// Speed of the pulse behind a blow once it has formed, sites per unit of time.
function settledSpeed(lattice) {
  lattice.to(lattice.end);
  return lattice.speed();
}

// A struck row of two masses and the theory beside it, drawn where the pulse has formed.
function theoryBeside(scene) {
  if (scene.theory === undefined && scene.lattice.arrivals.length > 12) {
    const probe = row({...scene.values, n: 40});
    probe.to(31, 4000 * scene.pace);
    scene.theory = probe.formed ? theory(probe, {k: 1.5, p0: 0, ...scene.values}) : null;
  }
  return scene.theory;
}

function tellSpeeds(scene) {
  const beside = theoryBeside(scene);
  const speed = scene.lattice.speed();
  const other = scene.before?.speed();
  const grey = other ? ` Grey, before the change: ${other.toFixed(3)}.` : "";
  if (beside === undefined) return "The pulse is forming …";
  const now = speed ? `${speed.toFixed(3)} sites per unit of time` : "…";
  if (beside === null) return `Speed ${now}. The pulse still changes its length: no theory is drawn.${grey}`;
  const error = speed ? ` (${signed(beside.speed / speed - 1)})` : "";
  return `Speed ${now}; by the theory ${beside.speed.toFixed(3)}${error}.${grey}`;
}

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
    const beta = Math.PI / cellLength(several);
    const arch = xi => (Math.abs(beta * xi) < Math.PI / 2 ? Math.cos(beta * xi) ** 6 : 0);
    const points = curve(arch, -10, 10, 400).map(([xi, v]) => [middle + scale * xi, floor - height * v]);
    pen.line(points, style, 2, dash);
  }
  if (wide) pen.text("pulse; dashed: equal balls", middle, floor + 18, {align: "center"});
}

Object.assign(things, {
  // Forty equal steel balls, from a drop of five millimetres; the picture follows the pulse.
  hero: {
    label: "A row of equal steel balls. Bars of force run along it, and the long-wave theory as a line with them",
    shape: 2.8,
    begin() {
      const scene = struckRow({omega: 1}, null, values => row({...values, n: 44}));
      return {...scene, pace: scene.pace * 0.8, from: -1};
    },
    next(scene, ticks) {
      const going = runRow(scene, ticks);
      const ahead = scene.lattice.arrivals.length + AHEAD;
      scene.from += (Math.max(ahead - 12, -1) - scene.from) * Math.min(0.05 * ticks, 1);
      return going;
    },
    draw(scene, pen) {
      const beside = theoryBeside(scene);
      const arch = beside && (x => beside.at(x, scene.lattice.time));
      const view = {from: scene.from, to: scene.from + 17, words: [BARS, LINE, TRAIL], arch};
      drawRow(pen, scene.lattice, scene.top, view);
    },
    tell: () => "",
  },

  chain: {
    ask: "Steel and PTFE balls in turn. The blow becomes twice as fast. How much faster is the pulse?",
    answers: ["twice as fast", "about a seventh faster", "no faster"],
    verdict() {
      const [slow, fast] = [1, 2].map(v => settledSpeed(row({v})));
      const numbers = `${fast.toFixed(3)}/${slow.toFixed(3)} = ${(fast / slow).toFixed(3)}`;
      return {right: 1, text: `the pulse is ${numbers} times as fast.`};
    },
    then: {v: 2},
    label: "A row of forty beads, bars of the force in each contact, the pulse before the last change in grey, and the theory's wave as a line",
    shape: 3.2,
    controls: [BLOW, RATIO],
    begin: (values, old) => struckRow(values, old, row),
    next: runRow,
    draw(scene, pen) {
      const beside = theoryBeside(scene);
      const arch = beside && (x => beside.at(x, scene.lattice.time));
      drawRow(pen, scene.lattice, scene.top, {before: scene.before, arch, words: [BARS, LINE]});
    },
    tell: tellSpeeds,
  },

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
    quiet: true,
    controls: [EXPONENT],
    begin: values => values,
    next: () => true,
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
    quiet: true,
    controls: [
      {name: "terms", text: "terms b₁ to", low: 0, high: 4, step: 1, start: 0, show: n => (n ? `b${"₁₂₃₄"[n - 1]}` : "none")},
      {name: "length", text: "wavelength in beads", low: 4.5, high: 40, step: 0.5, start: 10, show: x => x.toFixed(1)},
    ],
    begin: values => values,
    next: () => true,
    draw({terms, length}, pen) {
      const kappa = (2 * Math.PI) / length;
      const x = place => ((place + 1) / 26) * pen.width;
      const y = u => 0.54 * pen.height - 0.26 * pen.height * u;
      const {h, guess} = neighbour(terms, kappa);
      pen.line(curve(u => Math.cos(kappa * u), -0.6, 24.6).map(([p, u]) => [x(p), y(u)]), HEAVY, 1);
      for (let j = 0; j <= 24; j += 2) pen.disk(x(j), y(Math.cos(kappa * j)), 9, HEAVY, pen.ink);
      for (let j = 0; j <= 22; j += 2) {
        pen.disk(x(j + 1), y(h * Math.cos(kappa * (j + 1))), 5.5, LIGHT, pen.ink);
        const [re, im] = guess;
        const guessed = re * Math.cos(kappa * j) - im * Math.sin(kappa * j);
        pen.disk(x(j + 1), y(Math.max(Math.min(guessed, 1.9), -1.9)), 8, null, THEORY);
      }
      legend(pen, [["heavy beads, displacement u upwards", HEAVY], ["light beads", LIGHT], ["light beads by the ansatz", THEORY]]);
    },
    tell({terms, length}) {
      return `The guess errs by ${percent(guessError(terms, length))} of the heavy beads' amplitude.`;
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
    quiet: true,
    controls: [
      {...RATIO, low: -1.3, high: 1.3},
      {name: "closure", text: "closure", options: [PAPERS, "the full one, in the common field"], start: PAPERS},
    ],
    begin: values => values,
    next: () => true,
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
        const beta = Math.PI / lengths[i];
        const arch = xi => (Math.abs(beta * xi) < Math.PI / 2 ? Math.cos(beta * xi) ** 6 : 0);
        const points = curve(arch, -7.4, 7.4, 480).map(([xi, v]) => [x(xi), y(v)]);
        pen.line(points, colour, i ? 2 : 3.5, i ? [7, 5] : []);
      });
      legend(pen, [["by the observer of these", HEAVY], ["by the observer of those", LIGHT]]);
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
    quiet: true,
    controls: [
      {name: "bead", text: "bead", low: 1, high: 4, step: 1, start: 1, show: n => n.toFixed(0)},
      {name: "mass", text: "its mass", low: 0.1, high: 6, step: 0.1, start: 1},
    ],
    begin({bead, mass}, old) {
      const masses = [...(old?.masses ?? [1, 1, 1, 1])];
      if (!old || old.bead === bead) masses[bead - 1] = mass;
      return {bead, masses, controls: {mass: masses[bead - 1]}};
    },
    next: () => true,
    touch({masses}, x, y) {
      if (x > 1) return {};
      const bead = Math.min(4, Math.floor(4 * x) + 1);
      masses[bead - 1] = Math.max(0.1, Math.round(60 * (1 - y)) / 10);
      return {bead};
    },
    draw: drawCell,
    tell({masses}) {
      const I = cellVariance(masses);
      return `Masses ${masses.map(short).join(", ")}: variance I = ${I.toFixed(4)} D² (equal beads 0.0833), length of the pulse ${cellLength(masses).toFixed(2)} sites.`;
    },
  },
});
