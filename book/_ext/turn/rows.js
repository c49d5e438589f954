// Things to turn in which a blow or a wall drives a row.

const FORMING = "The pulse is forming …";
const RINGING = 25; // the light bead whose swing is drawn

// Controls that several things have.
const BLOW = {name: "v", text: "velocity of the blow", low: 0.2, high: 2, step: 0.05, start: 1};
const RATIO = {
  name: "omega", text: "mass ratio ω", low: -1.7, high: 0, step: 0.01, start: 0.2733, value: x => 10 ** x,
};
const EXPONENT = {name: "k", text: "exponent k", low: 1.1, high: 4, step: 0.05, start: 1.5};
const LOAD = {name: "p0", text: "load: static compression p₀", low: 0, high: 0.5, step: 0.01, start: 0};

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

// What things have in common that are rows: at rest the pulse is past twenty contacts.
const ROW = {
  next: runRow,
  rest: ({lattice}) => lattice.arrivals.length > 24,
};

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
  if (!speed) return FORMING;
  const now = `Speed ${speed.toFixed(3)} sites per unit of time`;
  if (!beside) return `${now}. The pulse still changes its length: no theory is drawn.${grey}`;
  const error = signed(beside.speed / speed - 1);
  return `${now}; by the theory ${beside.speed.toFixed(3)} (${error}).${grey}`;
}

// A law by its name in the book, with functions that lwa writes.
function named(name) {
  if (name === "spheres") return power(1.5);
  const pushes = name === "hertz2"; // the others also pull
  const part = kind => delta => (pushes && delta <= 0 ? 0 : f[`${name}_${kind}`](delta));
  const end = name === "magnetic" ? 0.999 : 9; // magnets would touch at 1
  return {k: 1, force: part("force"), slope: part("slope"), energy: part("energy"), end};
}

const LAWS = {
  "spheres": "spheres", "magnets": "magnetic", "Toda": "exponential", "Hertz's next order": "hertz2",
};

// The theory's speed of a pulse of peak force F from rest, equal beads of a law.
function lawSpeed(law, F) {
  const B = root(delta => law.force(delta) - F, 0, law.end ?? 9);
  return Math.sqrt((2 * law.energy(B)) / (B * B));
}

// Four lattices of one mean mass and what each adds to a row of spheres: `reach` is the distance of
// the particles that the force joins, `speed` the theory's at the compression B of a site.
const HIDDEN = {mass: 0.3, spring: 60};
const LATTICES = [
  {
    name: "rubber between every second pair",
    make: v => row({omega: 1, laws: [power(1.5), spring(1)], v}),
    // F is the same in both contacts: p = (F^{2/3} + F)/2 and V^2 = 2 (pF - ∫ p dF)/p^2
    speed(F) {
      const p = (F ** (2 / 3) + F) / 2;
      const complementary = (0.6 * F ** (5 / 3) + F * F / 2) / 2;
      return Math.sqrt((2 * (p * F - complementary)) / (p * p));
    },
  },
  {
    name: `${HIDDEN.mass} of the mass on a spring inside each ball`,
    make(v) {
      const inside = Array(40).fill(HIDDEN.mass);
      const more = inside.map((_, i) => ({i, j: 40 + i, law: spring(HIDDEN.spring)}));
      return row({mass: [1 - HIDDEN.mass], inside, more, v});
    },
    speed: F => f.pulse_speed(F, 1.5, 1, 1, 1, 1),
  },
  {
    name: "a quarter of the stiffness between second neighbours",
    make(v) {
      const more = Array.from({length: 38}, (_, i) => ({i, j: i + 2, law: power(1.5, 0.25)}));
      return row({omega: 1, more, v});
    },
    // W = (p^{5/2} + (2p)^{5/2}/4)/(5/2); F here is the force of nearest neighbours, p^{3/2}
    speed(F) {
      const p = F ** (2 / 3);
      return Math.sqrt(0.8 * (1 + 2 ** 0.5) * Math.sqrt(p));
    },
  },
  {
    name: "marbles in close rows, struck across them",
    make: v => row({omega: 1, law: power(1.5, 2 * 0.75 ** 1.25), v}), // layers, small strains
    speed: F => f.pulse_speed(F, 1.5, 2 * 0.75 ** 1.25, 1, 1, 1),
  },
];

// A row of masses drawn evenly from 1 - spread to 1 + spread; `draw` numbers the rows.
function unequal(spread, draw, n = 90) {
  let state = draw * 7919;
  const mass = Array.from({length: n}, () => {
    state = (state * 48271) % 2147483647;
    return 1 + spread * ((2 * state) / 2147483647 - 1);
  });
  return row({n, mass});
}

// Mean loss of ln F at a bead whose mass is drawn like this, by the book's rule for single beads.
function meanLoss(spread) {
  const side = ({square, power}) => (square * spread ** 2) / 3 + (power * spread ** 2.5) / 3.5;
  return (side(lwaLosses.heavier) + side(lwaLosses.lighter)) / 2;
}


// Speed of sound in equal spheres under the static compression p0, sites per unit of time.
const soundSpeed = p0 => (p0 > 0 ? f.sound_speed(Math.pow(p0, 1.5), 1.5, 1, 1, 1, 1) : 0);

// Force at contact 32 of a plain row of equal balls after a blow of 1.
function row33() {
  const plain = row({omega: 1});
  plain.to(33);
  return plain.at(32, "force");
}

// Four strips, each with its beads and links as sketched, and bars of the force in the contacts.
function drawLattices({rows, tops}, pen) {
  const strip = pen.height / rows.length;
  rows.forEach((lattice, number) => {
    const bottom = (number + 1) * strip - 6;
    const site = pen.width / (lattice.n + 1);
    const x = i => (i + 0.75) * site;
    const r = Math.min(0.46 * site, 0.15 * strip);
    const middle = bottom - r - (number === 3 ? 0.8 * r : 0);
    const floor = middle - (number === 2 ? 2.2 : 1.8) * r;
    const high = floor - (number * strip + 22);
    lattice.contact.forEach((force, i) => {
      const height = Math.min(Math.max(force / tops[number], 0), 1) * high;
      pen.bar(x(i + 0.5) - 0.3 * site, floor - height, 0.6 * site, height, LATTICE);
    });
    for (let i = 0; i < lattice.n; i++) {
      if (number === 3) {
        // a packing: every second layer is half a marble higher
        for (const side of [-1, 1]) pen.disk(x(i), middle + (side + (i % 2 ? 0.5 : -0.5)) * r, 0.9 * r, HEAVY, pen.ink);
        continue;
      }
      pen.disk(x(i), middle, number === 0 ? 0.8 * r : r, HEAVY, pen.ink);
      if (number === 0 && i % 2 === 1 && i + 1 < lattice.n) {
        pen.bar(x(i) + 0.6 * r, middle - 0.4 * r, site - 1.2 * r, 0.8 * r, LIGHT);
      }
      if (number === 1) pen.disk(x(i) + r * 2 * (lattice.u[lattice.n + i] - lattice.u[i]), middle, 0.45 * r, LIGHT);
      if (number === 2 && i % 2 === 0 && i + 2 < lattice.n) {
        const arc = curve(t => middle - 1.05 * r - 0.7 * r * Math.sin(Math.PI * t), 0, 1, 12);
        pen.line(arc.map(([t, y]) => [x(i) + 2 * site * t, y]), LIGHT, 1.2);
      }
    }
    pen.text(LATTICES[number].name, 4, number * strip + 15);
  });
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
    ...ROW,
    draw(scene, pen) {
      const beside = theoryBeside(scene);
      const arch = beside && (x => beside.at(x, scene.lattice.time));
      drawRow(pen, scene.lattice, scene.top, {before: scene.before, arch, words: [BARS, LINE]});
    },
    tell: tellSpeeds,
  },

  // A light bead between heavy ones as a pulse passes, and what the swing costs the pulse.
  ring: {
    ask: "The light balls weigh 0.6 of the heavy ones. Thirty balls further on, how high is the pulse?",
    answers: ["as high as before", "more than a third lower", "nearly gone"],
    verdict() {
      const lattice = row({omega: 0.6, n: 60});
      lattice.to(43);
      const [before, after] = [12, 42].map(place => lattice.at(place, "force"));
      return {right: 1, text: `its force falls from ${before.toFixed(3)} to ${after.toFixed(3)}. The light balls keep the rest.`};
    },
    then: {omega: 0.6},
    label: "A struck row, the highest force of each contact, and below it the swing of one light bead over time",
    shape: 2.4,
    controls: [{...RATIO, low: -1.3, high: 0}],
    begin: (values, old) => ({...struckRow(values, null, one => row({...one, n: 64})), trace: [], old}),
    next(scene, ticks) {
      const going = runRow(scene, ticks);
      const {u} = scene.lattice;
      scene.trace.push([scene.lattice.time, u[RINGING] - (u[RINGING - 1] + u[RINGING + 1]) / 2]);
      return going;
    },
    rest: ({lattice}) => lattice.arrivals.length > 40,
    draw({lattice, top, trace, pace}, pen) {
      const whole = pen.height;
      pen.height = 0.6 * whole;
      drawRow(pen, lattice, top, {words: [BARS, TRAIL]});
      pen.height = whole;
      const span = 420 * pace;
      const start = Math.max(lattice.time - span, 0);
      const middle = 0.82 * whole;
      const size = Math.max(...trace.map(([, off]) => Math.abs(off)), 0.02);
      const points = trace
        .filter(([time]) => time >= start)
        .map(([time, off]) => [((time - start) / span) * pen.width, middle - (0.15 * whole * off) / size]);
      pen.line([[0, middle], [pen.width, middle]], GHOST, 1);
      if (points.length > 1) pen.line(points, LIGHT);
      pen.text(`swing of light bead ${RINGING} over time`, 2, 0.68 * whole);
    },
    tell({lattice}) {
      const last = lattice.front;
      if (last < 14) return FORMING;
      const [before, now] = [lattice.at(12, "force"), lattice.at(last, "force")];
      return `Force at contact 12: ${before.toFixed(3)}; at contact ${last}: ${now.toFixed(3)}, ${signed(now / before - 1)}.`;
    },
  },

  // A struck row under a load, and sound.
  load: {
    ask: "The row is pressed together before the same gentle blow. How does the pulse run?",
    answers: ["slower", "at the same speed", "faster"],
    verdict() {
      const [bare, pressed] = [0, 0.3].map(p0 => settledSpeed(row({omega: 1, v: 0.2, p0, n: 60})));
      return {right: 2, text: `${pressed.toFixed(3)} against ${bare.toFixed(3)} sites per unit of time; sound alone runs at ${soundSpeed(0.3).toFixed(3)}.`};
    },
    then: {p0: 0.3},
    label: "A row of equal beads under a load, bars of the dynamic force, and a mark that runs at the speed of sound",
    shape: 3,
    controls: [LOAD, {...BLOW, start: 0.2, low: 0.05}],
    begin: (values, old) => struckRow({omega: 1, ...values}, old, one => row({n: 60, ...one})),
    ...ROW,
    draw(scene, pen) {
      const beside = theoryBeside(scene);
      const {lattice} = scene;
      const arch = beside && (x => beside.at(x, lattice.time));
      const words = [BARS, LINE, ["sound", LIGHT]];
      const {x, base, below} = drawRow(pen, lattice, scene.top, {arch, before: scene.before, trail: false, words});
      const front = soundSpeed(scene.values.p0) * lattice.time;
      if (front > 0 && front < lattice.n) pen.line([[x(front), below], [x(front), base]], LIGHT);
    },
    tell(scene) {
      const sound = soundSpeed(scene.values.p0);
      const speed = scene.lattice.speed();
      const over = sound && speed ? ` Sound runs at ${sound.toFixed(3)}; the pulse is ${(speed / sound).toFixed(3)} times as fast.` : "";
      return tellSpeeds(scene) + over;
    },
  },

  // Other contact laws.
  law: {
    ask: "Magnets on a rail in place of balls. A gentle blow becomes twice as fast. How much faster is the pulse?",
    answers: ["about a seventh, as with spheres", "less", "more"],
    verdict() {
      const grown = name => {
        const [slow, fast] = [0.1, 0.2].map(v => settledSpeed(row({omega: 1, law: named(LAWS[name]), v})));
        return fast / slow;
      };
      const [spheres, magnets] = [grown("spheres"), grown("magnets")];
      return {right: magnets < spheres ? 1 : 2, text: `${magnets.toFixed(3)} times as fast with these magnets, ${spheres.toFixed(3)} times with spheres.`};
    },
    then: {v: 0.2},
    label: "A row of equal particles with a contact law of choice, bars of the force in each contact",
    shape: 3.2,
    controls: [
      {name: "law", text: "law", options: Object.keys(LAWS), start: "magnets"},
      {...BLOW, low: 0.05, high: 1.5, start: 0.1},
    ],
    begin(values, old) {
      const law = named(LAWS[values.law]);
      const clock = old?.values?.law === values.law ? {pace: old.pace} : null;
      return {...struckRow(values, clock, ({v}) => row({omega: 1, law, v})), law};
    },
    ...ROW,
    draw: ({lattice, top}, pen) => void drawRow(pen, lattice, top, {words: [BARS, TRAIL]}),
    tell({lattice, law}) {
      const speed = lattice.speed();
      if (!speed) return FORMING;
      const force = lattice.at(lattice.front, "force");
      const theory = lawSpeed(law, force);
      return `Peak force ${force.toFixed(3)}. Speed ${speed.toFixed(3)} sites per unit of time; by the theory ${theory.toFixed(3)} (${signed(theory / speed - 1)}).`;
    },
  },

  // Four lattices at once.
  lattices: {
    ask: "In the second row 0.3 of each ball's mass hangs on a spring inside it. How fast is its pulse, beside balls of the same mass without a spring and at the same force?",
    answers: ["faster", "as fast, within a hundredth", "slower"],
    verdict() {
      const hidden = LATTICES[1].make(1);
      const speed = settledSpeed(hidden);
      const plain = settledSpeed(row({omega: 1})) * (hidden.at(32, "force") / row33()) ** (1 / 6);
      return {right: 1, text: `${speed.toFixed(3)} against ${plain.toFixed(3)}: the speed knows the mass and the static law alone.`};
    },
    label: "Four rows: rubber between every second pair, a hidden mass in each ball, second neighbours, rows of marbles; a pulse runs down each",
    shape: 1.5,
    least: 400,
    controls: [BLOW],
    begin({v}) {
      const rows = LATTICES.map(({make}) => make(v));
      const probes = LATTICES.map(({make}) => make(v));
      probes.forEach(probe => probe.to(8));
      const tops = probes.map(probe => 1.4 * Math.max(...probe.arrivals.slice(1).map(a => a.force)));
      return {rows, tops, pace: (probes[3].arrivals[8].time - probes[3].arrivals[4].time) / 40};
    },
    next({rows, pace}, ticks) {
      rows.forEach(lattice => lattice.advance(pace * ticks));
      return rows.some(lattice => lattice.arrivals.length <= lattice.end);
    },
    rest: ({rows}) => rows.every(lattice => lattice.arrivals.length > 20),
    draw: drawLattices,
    tell({rows}) {
      if (!rows.every(lattice => lattice.speed(11))) return FORMING;
      const speeds = rows.map((lattice, i) => {
        const speed = lattice.speed(11);
        const theory = LATTICES[i].speed(lattice.at(lattice.front, "force"));
        return `${speed.toFixed(3)} (theory ${signed(theory / speed - 1)})`;
      });
      return `Speeds from above, in sites or layers per unit of time: ${speeds.join("; ")}.`;
    },
  },

  // A wall drives equal spheres: the plateau by the Riemann invariant, the front by the doubling rule.
  shock: {
    ask: "A wall pushes the row at a steady velocity. How fast do the balls at the very front move?",
    answers: ["as fast as the wall", "nearly twice as fast", "more slowly"],
    verdict() {
      const scene = things.shock.begin({v: 0.4, p0: 0.25});
      while (things.shock.next(scene, 1));
      return {right: 1, text: `${(scene.fastest / 0.4).toFixed(2)} times as fast as the wall after 110 balls.`};
    },
    label: "A row of beads that a wall drives from the left, bars of the dynamic force in each contact, and lines of the plateau and of the leading edge",
    shape: 3,
    controls: [
      {name: "v", text: "velocity of the wall", low: 0.05, high: 1, step: 0.05, start: 0.4},
      {...LOAD, high: 1, step: 0.05, start: 0.25},
    ],
    begin({v, p0}) {
      const energy = (p, k) => Math.pow(p, k + 1) / (k + 1);
      const k = 1.5;
      const whole = p => ((2 * Math.sqrt(k)) / (k + 1)) * Math.pow(p, (k + 1) / 2); // ∫ c dp
      const behind = root(p => whole(p) - whole(p0) - v, p0, 50);
      const left = b => energy(p0 + b, k) - energy(p0, k) - Math.pow(p0, k) * b - 2 * v * v;
      const B = root(left, 0, 50);
      const lattice = row({omega: 1, p0, v, n: 120, wall: true});
      const plateau = Math.pow(behind, k) - Math.pow(p0, k);
      return {lattice, v, plateau, edge: (2 * v) / B, fastest: 0};
    },
    next(scene, ticks) {
      const {lattice, edge} = scene;
      lattice.advance((0.12 * ticks) / edge, () => 0); // a site in about eight pictures
      const front = Math.floor(edge * lattice.time);
      for (let i = Math.max(front - 6, 1); i < Math.min(front + 6, lattice.n); i++) {
        if (front > 40) scene.fastest = Math.max(scene.fastest, lattice.w[i]);
      }
      return front < lattice.n - 8;
    },
    rest: ({lattice, edge}) => edge * lattice.time > 60,
    draw({lattice, plateau, edge}, pen) {
      const words = [BARS, ["plateau and leading edge by the theory", THEORY]];
      const {x, y, base, below} = drawRow(pen, lattice, 3.2 * plateau, {words});
      pen.line([[x(0), y(plateau)], [x(lattice.n), y(plateau)]], THEORY, 1);
      pen.line([[x(edge * lattice.time), below], [x(edge * lattice.time), base]], THEORY, 1);
    },
    tell({edge, fastest, v}) {
      const grows = fastest < 1.9 * v ? " The train still grows." : "";
      const seen = fastest ? `the leading balls have moved ${(fastest / v).toFixed(2)} times as fast as the wall.${grows}` : "the train is forming …";
      return `Leading edge by the doubling rule: ${edge.toFixed(3)} sites per unit of time; ${seen}`;
    },
  },

  // A row of unequal beads, and the book's rule for the mean loss.
  disorder: {
    ask: "The masses of the balls differ by up to a fifth. How much of the pulse's force is left sixty balls further on?",
    answers: ["about 99 %", "about 90 %", "about 50 %"],
    verdict() {
      const left = Array.from({length: 8}, (_, i) => {
        const lattice = unequal(0.2, i + 1);
        lattice.to(73);
        return lattice.at(72, "force") / lattice.at(12, "force");
      });
      const mean = left.reduce((sum, part) => sum + part, 0) / left.length;
      return {right: 1, text: `${percent(mean, 0)} in the mean of eight rows; the rule has ${percent(Math.exp(-60 * meanLoss(0.2)), 0)}.`};
    },
    then: {spread: 0.2},
    label: "A row of balls of unequal masses, bars of the force in each contact, and the force by the rule over the place",
    shape: 3,
    controls: [
      {name: "spread", text: "masses within ±", low: 0, high: 0.4, step: 0.05, start: 0.1, show: x => percent(x, 0)},
      {name: "draw", text: "row", low: 1, high: 20, step: 1, start: 1, show: n => n.toFixed(0)},
    ],
    begin: values => struckRow(values, null, ({spread, draw}) => unequal(spread, draw)),
    ...ROW,
    draw({lattice, top, values}, pen) {
      const words = [BARS, TRAIL, ["mean by the rule", THEORY]];
      const {x, y} = drawRow(pen, lattice, top, {words, light: HEAVY});
      if (lattice.arrivals.length < 14) return;
      const force = lattice.at(12, "force");
      const left = i => force * Math.exp(-meanLoss(values.spread) * (i - 12));
      pen.line(curve(left, 12, lattice.n - 1, 40).map(([i, part]) => [x(i), y(part)]), THEORY, 1.5, [6, 4]);
    },
    tell({lattice, values}) {
      const last = lattice.front;
      if (last < 20) return FORMING;
      const left = lattice.at(last, "force") / lattice.at(12, "force");
      const rule = Math.exp(-meanLoss(values.spread) * (last - 12));
      return `Between contacts 12 and ${last} the force has fallen to ${percent(left)}; by the rule, in the mean of many rows, to ${percent(rule)}.`;
    },
  },
});
