// Things to turn in which beads swing under a load: a light bead, a breather.

// Count the upward passages of a swinging bead through the middle of its neighbours.
function swing(scene, time) {
  const {lattice, middle, bottom} = scene;
  lattice.advance(time / bottom, () => {
    const now = lattice.u[middle] - (lattice.u[middle - 1] + lattice.u[middle + 1]) / 2;
    if (scene.last < 0 && now >= 0) {
      scene.turns.push(lattice.time - (lattice.step * now) / (now - scene.last));
    }
    scene.last = now;
  });
  return bottom * lattice.time;
}

// The counted frequency in units of that of a small swing; NaN before two turns.
function rate({turns, bottom}) {
  const count = turns.length - 1;
  return count < 2 ? NaN : (2 * Math.PI * count) / (turns[count] - turns[0]) / bottom;
}

const toFour = x => (Number.isNaN(x) ? "…" : x.toFixed(4));

Object.assign(things, {
  // One light bead between two heavy ones that a load presses together, of small mass: its heavy
  // neighbours do not follow the swing, but they make room for its mean force.
  light: {
    ask: "A light ball swings between two heavy ones that a load presses together. It swings twice as far. What does its frequency do?",
    answers: ["it rises", "it stays", "it falls"],
    verdict() {
      const [small, large] = [0.4, 0.8].map(a => {
        const scene = things.light.begin({a, k: 1.5});
        while (things.light.next(scene, 1));
        return rate(scene);
      });
      return {right: 2, text: `it falls from ${small.toFixed(4)} to ${large.toFixed(4)} of that of a small swing.`};
    },
    then: {a: 0.8},
    label: "A light bead between two heavy ones, and bars of the force in both contacts",
    shape: 3,
    controls: [
      {name: "a", text: "amplitude over the static compression", low: 0.1, high: 0.8, step: 0.05, start: 0.4},
      {...EXPONENT, high: 3},
    ],
    begin({a, k}) {
      const omega = 1e-4;
      const turn = Array.from({length: 64}, (_, i) => Math.cos(((i + 0.5) * Math.PI) / 64));
      const mean = x => turn.reduce((sum, c) => sum + Math.pow(Math.max(1 - x + a * c, 0), k), 0) / 64;
      const room = root(x => 1 - mean(x), 0, 1);
      const start = i => (i - 1) * room + (i === 1 ? a : 0);
      const lattice = row({omega, k, p0: 1, v: 0, n: 3, start, fine: 4});
      return {lattice, a, k, room, middle: 1, bottom: Math.sqrt((2 * k) / omega), turns: [], last: a};
    },
    next: (scene, ticks) => swing(scene, 0.08 * ticks) < 220,
    rest: ({turns}) => turns.length > 4,
    draw({lattice, k}, pen) {
      const {width, height} = pen;
      const unit = Math.min(height, 0.47 * width); // of the balls and the bars, side by side
      const heavy = 0.33 * unit;
      const small = 0.14 * unit;
      const side = Math.min(1.75 * unit, 0.46 * width);
      const place = i => width / 2 + (i - 1) * (heavy + small) + 0.3 * small * lattice.u[i];
      const fills = [HEAVY, LIGHT, HEAVY];
      fills.forEach((fill, i) => pen.disk(place(i), height / 2, i === 1 ? small : heavy, fill, pen.ink));
      const y = force => height - 6 - (force / 2 ** k) * (height - 40);
      const bar = 0.15 * unit;
      [width / 2 - side, width / 2 + side - bar].forEach((x, i) => {
        pen.bar(x, y(lattice.contact[i]), bar, y(0) - y(lattice.contact[i]), LATTICE);
        pen.line([[x, y(1)], [x + bar, y(1)]], THEORY);
      });
      legend(pen, [["force in the contact", LATTICE], ["the load", THEORY]]);
    },
    tell(scene) {
      const {a, k, room} = scene;
      const second = (1 - (k * (k - 1) * a * a) / 16).toFixed(4);
      return `Frequency over that of a small swing: ${toFour(rate(scene))}; to second order in the amplitude ${second}. Each contact has expanded by ${room.toFixed(3)} of its static compression: its mean force stays the load, and it is softer.`;
    },
  },

  // A breather of a loaded dimer, an orbit that Newton's method found (`lwaBreathers`).
  breather: {
    ask: "The light balls of a breather swing more strongly. What does their frequency do?",
    answers: ["it rises", "it stays", "it falls"],
    verdict() {
      const [weak, strong] = [lwaBreathers[1], lwaBreathers.at(-1)];
      const part = ({nu}) => (1 - nu).toFixed(4);
      return {right: 2, text: `from ${part(weak)} to ${part(strong)} of the band's edge, deeper in the gap, as their amplitude grows from ${weak.amplitude.toFixed(3)} to ${strong.amplitude.toFixed(3)}.`};
    },
    then: {number: 5},
    label: "Displacement of each bead of a loaded chain over its place, and the envelope of the theory",
    shape: 3,
    controls: [{
      name: "number", text: "detuning 1 − f/f₀", low: 1, high: 5, step: 1, start: 2,
      show: n => lwaBreathers[n - 1].nu.toFixed(4),
    }],
    begin({number}) {
      const {nu, start, U, b} = lwaBreathers[number - 1];
      const [k, omega] = [1.5, 0.5];
      const n = start.length;
      const middle = (n - 1) / 2; // a light bead
      const envelope = i => U / Math.cosh((b * (i - middle)) / 2);
      const lasting = i => (((k - 1) * U * U) / (2 * b)) * Math.tanh((b * (i - middle)) / 2);
      const lattice = row({mass: middle % 2 ? [1, omega] : [omega, 1], k, p0: 1, v: 0, n, start: i => start[i], fine: 6});
      const bottom = Math.sqrt((2 * k) / omega); // F' = k at the compression 1
      return {lattice, middle, bottom, U, nu, envelope, lasting, turns: [], last: start[middle]};
    },
    next: (scene, ticks) => swing(scene, 0.25 * ticks) < 2200,
    draw({lattice, U, middle, envelope, lasting}, pen) {
      const x = i => ((i + 1) / (lattice.n + 1)) * pen.width;
      const y = u => pen.height / 2 + 12 - (u / (1.7 * U)) * (pen.height / 2 - 14);
      for (const sign of [1, -1]) {
        const upper = i => y(lasting(i) + sign * envelope(i));
        pen.line(curve(upper, 0, lattice.n - 1).map(([i, height]) => [x(i), height]), THEORY, 1);
      }
      const drift = (lattice.u[0] + lattice.u[lattice.n - 1]) / 2;
      lattice.u.forEach((u, i) => {
        const light = (i - middle) % 2 === 0;
        pen.disk(x(i), y(u - drift), light ? 3.5 : 2.5, light ? LIGHT : HEAVY);
      });
      legend(pen, [["light balls", LIGHT], ["heavy balls", HEAVY], ["envelope by the theory", THEORY]]);
    },
    tell: scene => `Frequency over that of the band's edge: orbit ${(1 - scene.nu).toFixed(4)}, counted here ${toFour(rate(scene))}. No small wave of the chain has a frequency just below 1.`,
  },
});
