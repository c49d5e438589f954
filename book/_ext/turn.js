// Things to turn: a struck chain, a chain that a wall drives, a breather, a light bead between two
// heavy ones, an arch, and a calculator. Each asks its reader before it shows.
// Formulas come from lwaFormulas, which lwa writes; nothing else is loaded.
"use strict";
(() => {
  const f = lwaFormulas;

  const AHEAD = 4;
  // The first pulse of a record of rows [time, force], as lwa-validate finds it: the highest hump of
  // the first stretch above half of the record's maximum, until the force is as high again. The peak
  // is that of a parabola through three rows; a pulse that does not fall to its half has no width.
  function leading(rows) {
    const after = (start, test) => {
      const found = rows.findIndex((row, i) => i >= start && test(row[1]));
      return found < 0 ? rows.length : found;
    };
    const most = (from, to) => rows.slice(from, to).reduce((high, row) => Math.max(high, row[1]), 0);
    const half = most(0) / 2;
    const start = after(0, force => force > half), fallen = after(start, force => force <= half);
    const hump = most(start, fallen), end = after(fallen, force => force >= hump), peak = most(0, end);
    const top = after(0, force => force === peak);
    const [before, now, next] = [top - 1, top, top + 1].map(i => rows[Math.min(Math.max(i, 0), rows.length - 1)]);
    const slope = (next[1] - before[1]) / 2;
    const ahead = slope / (2 * now[1] - next[1] - before[1] || 1); // in steps
    const [time, force] = [now[0] + ahead * (now[0] - before[0]), now[1] + (slope * ahead) / 2];
    const up = rows.slice(0, top).findLastIndex(row => row[1] <= force / 2), down = after(top, f => f <= force / 2);
    const crossing = ([t0, f0], [t1, f1]) => t0 + ((force / 2 - f0) / (f1 - f0)) * (t1 - t0);
    return {time, force, width: down < end ? crossing(rows[down - 1], rows[down]) - (up < 0 ? rows[0][0] : crossing(rows[up], rows[up + 1])) : NaN};
  }

  // A chain of n beads of masses 1 and omega, contacts F = delta^k, spacing 1, under the static
  // compression p0; bead 0 starts at v, and as a wall it keeps v. Velocity Verlet, fixed step.
  class Chain {
    constructor({omega = 0.2733, k = 1.5, p0 = 0, v = 1, n = 40, wall = false, start = null, fine = 1} = {}) {
      Object.assign(this, {omega, k, p0, v, n, wall, load: Math.pow(p0, k), time: 0, arrivals: [], trails: [], arch: null});
      this.mass = Array.from({length: n}, (_, i) => (i % 2 ? omega : 1));
      this.u = new Float64Array(n); // displacements along the chain
      this.w = new Float64Array(n); // velocities
      this.w[0] = v;
      if (start) this.u.forEach((_, i) => (this.u[i] = start(i)));
      this.contact = new Float64Array(n - 1);
      const most = Math.max(Math.pow((wall ? 4 : 1) * v * v, 1 / (k + 1)) + p0, 1e-3); // a compression of the scene
      this.step = 0.12 / fine / Math.sqrt(2 * k * Math.pow(most, k - 1) * (1 + 1 / omega));
      this.forces();
    }

    forces() {
      for (let i = 0; i < this.n - 1; i++) {
        const delta = this.p0 + this.u[i] - this.u[i + 1];
        this.contact[i] = delta > 0 ? Math.pow(delta, this.k) : 0;
      }
    }

    kick(h) {
      for (let i = this.wall ? 1 : 0; i < this.n; i++) {
        const [left, right] = [this.contact[i - 1] ?? this.load, this.contact[i] ?? this.load];
        this.w[i] += (h * (left - right)) / this.mass[i];
      }
    }

    advance(duration, watch = () => this.watch()) {
      const steps = Math.ceil(duration / this.step);
      const h = duration / steps;
      for (let i = 0; i < steps; i++) {
        this.kick(h / 2);
        for (let j = 0; j < this.n; j++) this.u[j] += h * this.w[j];
        this.forces();
        this.kick(h / 2);
        this.time += h;
        watch();
      }
    }

    // The dynamic force of each contact, until the pulse has left the contact AHEAD of it: an
    // earlier hump of the same pulse is then known to be less than half, or more.
    watch() {
      const first = this.arrivals.length;
      const least = first > 1 ? 0.2 * this.arrivals[first - 1].force : 0.008 * this.v;
      for (let i = first; i < this.n - 2; i++) {
        const force = this.contact[i] - this.load;
        if (!this.trails[i] && force < least / 20) break; // ahead of the front
        const trail = (this.trails[i] ||= {most: 0, bead: 0, past: []});
        trail.most = Math.max(trail.most, force);
        trail.bead = Math.max(trail.bead, (this.contact[i] + this.contact[i + 1]) / 2); // of bead i + 1
        trail.past.push([this.time, force]);
      }
      const {most, past} = this.trails[first + AHEAD] || {most: 0};
      if (most < least || past.at(-1)[1] > 0.9 * most) return;
      this.arrivals.push(leading(this.trails[first].past));
      if (this.arrivals.length === 13) this.arch = this.theory();
    }

    // The theory's wave at the mean peak force of the contacts 11 and 12, from bead 12 between them on.
    theory() {
      const [a, b] = this.arrivals.slice(-2);
      const force = (a.force + b.force) / 2 + this.load;
      const values = [this.k, 1, 1, this.omega, 1];
      const speed = this.load > 0 ? f.loaded_speed(force, this.load, ...values) : f.pulse_speed(force, ...values);
      const wave = profile(this.k, this.p0, this.omega, force);
      return {force, speed, at: x => wave(x - 12 - speed * (this.time - (a.time + b.time) / 2))};
    }

    // Speed of the lattice's pulse in sites per unit of time, between like contacts.
    speed() {
      const last = 2 * Math.floor((this.arrivals.length - 1) / 2);
      return last < 18 ? NaN : (last - 12) / (this.arrivals[last].time - this.arrivals[12].time);
    }
  }

  // Row of a table at x, linear between its rows, which are sorted by their first number.
  function between(rows, x) {
    const after = rows.findIndex(row => row[0] >= x);
    if (after < 1) return rows[0][0] === x ? rows[0] : null;
    const [low, high] = [rows[after - 1], rows[after]];
    return low.map((value, i) => value + ((x - low[0]) / (high[0] - low[0])) * (high[i] - value));
  }

  // Rows [xi, v] of a wave under load from its middle on, v the rise of the strain, B at the middle:
  // the quadrature of lwaFormulas.gradient with v = B/cosh^2 s, by the midpoint rule.
  function flank(B, p0, k, omega) {
    const [rows, h] = [[[0, B]], 0.005];
    for (let s = h / 2; s < 5; s += h) {
      const v = B / Math.cosh(s) ** 2;
      const xi = rows.at(-1)[0] + (2 * h * Math.tanh(s) * v) / f.gradient(v, B, p0, k, 1, omega);
      rows.push([xi, B / Math.cosh(s + h / 2) ** 2]);
    }
    return rows;
  }

  // Dynamic force of the theory's wave over xi, 0 at its middle; peak contact force F, load in it.
  function profile(k, p0, omega, F) {
    const B = Math.pow(F, 1 / k) - p0;
    if (p0 === 0) return xi => Math.pow(Math.max(f.profile(xi, B, k, 1, omega, 1), 0), k);
    const rows = flank(B, p0, k, omega);
    return xi => Math.pow(p0 + (between(rows, Math.abs(xi))?.[1] ?? 0), k) - Math.pow(p0, k);
  }

  function root(g, low, high) { // of a function that rises
    for (let i = 0; i < 60; i++) [low, high] = g((low + high) / 2) < 0 ? [(low + high) / 2, high] : [low, (low + high) / 2];
    return low;
  }

  function element(name, attributes = {}, ...children) {
    const made = document.createElement(name);
    for (const pair of Object.entries(attributes)) made.setAttribute(...pair);
    made.append(...children);
    return made;
  }

  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const LATTICE = "#56B4E9", THEORY = "#D55E00", GHOST = "#9a9a9a";
  const same = x => x;

  // A canvas cleared for drawing: pen, width and height in CSS pixels.
  function sheet(canvas, shape = 4.5) {
    const [ratio, width] = [window.devicePixelRatio || 1, canvas.clientWidth || 600];
    const height = Math.max(150, width / shape);
    Object.assign(canvas, {width: width * ratio, height: height * ratio});
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    return [pen, width, height];
  }

  function disk(pen, x, y, r, style) {
    pen.beginPath();
    pen.arc(x, y, r, 0, 7);
    pen.fillStyle = style;
    pen.fill();
  }

  function line(pen, points, style, width = 2) {
    Object.assign(pen, {strokeStyle: style, lineWidth: width});
    pen.beginPath();
    points.forEach(([x, y]) => pen.lineTo(x, y));
    pen.stroke();
  }

  // Bars of the dynamic force of each contact up to `top`, the ghost's behind them; the theory's line
  // and the beads. Returns the coordinates for more.
  function show(canvas, chain, top, ghost) {
    const [pen, width, height] = sheet(canvas);
    const x = i => ((i + 1) / (chain.n + 1)) * width;
    const base = height - 0.9 * x(0) - 6;
    const y = force => base - (Math.min(Math.max(force, 0), top) / top) * (base - 8);
    const bars = (these, style) => {
      pen.fillStyle = style;
      these.contact.forEach((force, i) => pen.fillRect(x(i + 0.5) - 0.3 * x(0), y(force - these.load), 0.6 * x(0), base - y(force - these.load)));
    };
    if (ghost) bars(ghost, GHOST + "66");
    bars(chain, LATTICE);
    if (chain.arch) {
      const places = Array.from({length: 20 * chain.n}, (_, i) => i / 20 - 0.5).filter(i => chain.arch.at(i) > 2e-3 * top);
      line(pen, places.map(i => [x(i), y(chain.arch.at(i))]), THEORY);
    }
    const moved = chain.wall ? 0 : 0.17 / Math.max(...chain.u.map((u, i) => Math.abs(u - (chain.u[i + 1] ?? u))), 0.02);
    const edge = getComputedStyle(document.documentElement).getPropertyValue("--pst-color-text-base") || "#333";
    for (let i = 0; i < chain.n; i++) {
      const r = 0.48 * x(0) * Math.cbrt(chain.mass[i]) ** (chain.mass[i] < 1 ? 0.7 : 1);
      disk(pen, x(i) + moved * chain.u[i] * x(0), height - 0.5 * x(0) - 4, Math.max(r, 1.5), i % 2 && chain.omega !== 1 ? "#F2E6C9" : "#44546A");
      Object.assign(pen, {strokeStyle: edge, lineWidth: 0.6});
      pen.stroke();
    }
    return {pen, x, y, base};
  }

  // The question of a thing to turn: what follows is hidden until the reader has answered.
  function question(home, {ask, answers}, shown) {
    const text = element("p", {class: "lwa-question"}, home.dataset.ask || ask);
    const row = element("div", {class: "lwa-answers"});
    for (const answer of (home.dataset.answers || answers).split("|")) {
      const button = element("button", {type: "button"}, answer);
      row.append(button);
      button.addEventListener("click", () => {
        row.replaceWith(element("p", {class: "lwa-answer"}, `You say: ${answer}. See for yourself.`));
        shown();
      });
    }
    home.append(text, row);
  }

  // The frame of a thing that moves: `begin(values, old)` starts a scene, `draw(scene, canvas)` shows
  // it, `next(scene)` advances it by one picture, false at its end, `tell(scene)` is the line below.
  // `then` are values that the sliders take when the question is answered.
  function moving(home, thing) {
    const {label, sliders, then = {}, begin, draw, next, tell} = thing;
    const canvas = element("canvas", {role: "img", "aria-label": label});
    const output = element("output", {"aria-live": "polite"});
    const button = element("button", {type: "button"}, calm ? "Play" : "Pause");
    const panel = element("div", {class: "lwa-panel"}, ...(thing.still ? [] : [button]));
    const shown = element("div", {}, canvas, panel, output);
    const values = {}, inputs = {};
    let scene, settled, playing = false, due = 0;
    const restart = old => {
      scene = home.scene = begin(values, old);
      for (let i = 0; !playing && i < (calm ? 340 : 240) && next(scene); i++);
      draw(scene, canvas);
      output.textContent = tell(scene);
    };
    function frame() {
      if (!playing) return;
      const {top, bottom} = canvas.getBoundingClientRect();
      if (bottom > 0 && top < innerHeight) {
        if (!next(scene)) restart(scene);
        draw(scene, canvas);
        if (due++ % 20 === 0) output.textContent = tell(scene);
      }
      requestAnimationFrame(frame);
    }
    for (const [name, text, low, high, step, meaning, start] of sliders) {
      const given = (values[name] = name in home.dataset ? Number(home.dataset[name]) : meaning(start));
      if ("plain" in home.dataset) continue;
      const value = element("span", {}, given.toPrecision(3));
      const place = x => root(y => meaning(y) - x, low, high);
      const slider = element("input", {type: "range", min: low, max: high, step, value: place(given), "aria-label": text, "data-slider": name});
      inputs[name] = x => {
        values[name] = x;
        value.textContent = x.toPrecision(3);
        slider.setAttribute("aria-valuetext", value.textContent);
        restart({...scene, before: settled}); // as it was when the hand came to the slider
      };
      slider.addEventListener("input", () => inputs[name](meaning(Number(slider.value))));
      slider.addEventListener("change", () => (settled = {...values}));
      inputs[name].set = x => (slider.value = place(x));
      panel.append(element("label", {}, `${text}: `, value, slider));
    }
    const play = on => {
      playing = on;
      button.textContent = playing ? "Pause" : "Play";
      if (playing) frame();
    };
    button.addEventListener("click", () => play(!playing));
    settled = {...values};
    home.next = () => next(scene);
    if ("plain" in home.dataset) home.append(shown);
    else {
      question(home, thing, () => {
        shown.hidden = false;
        for (const [name, x] of "omega" in home.dataset ? [] : Object.entries(then)) {
          inputs[name].set(x);
          inputs[name](x);
        }
        settled = {...values};
        restart(scene);
        play(!calm && !thing.still);
      });
      shown.hidden = true;
      home.append(shown);
    }
    restart(null);
    if ("plain" in home.dataset) play(!calm && !thing.still);
  }

  const things = {
    // Scale and clock stay while a slider moves; the chain as it was before runs along in grey.
    chain: {
      ask: "The blow becomes twice as fast. How much faster is the pulse?",
      answers: "twice as fast|about a seventh faster|no faster",
      then: {v: 2},
      label: "A row of forty beads, bars of the dynamic force in each contact, the pulse before the last change in grey, and the theory's wave as a line",
      sliders: [
        ["omega", "mass ratio ω", -1.7, 0, 0.01, x => 10 ** x, Math.log10(0.2733)],
        ["k", "exponent k", 1.1, 3, 0.05, same, 1.5],
        ["p0", "load: static compression p₀", 0, 0.5, 0.01, same, 0],
        ["v", "velocity of the blow", 0.2, 2, 0.05, same, 1],
      ],
      begin(values, old) {
        const chain = new Chain(values);
        const probe = new Chain(values);
        while (probe.arrivals.length < 6 && probe.time < 400) probe.advance(1);
        const peak = Math.max(...probe.arrivals.slice(1).map(a => a.force), 1e-6);
        const pace = (probe.arrivals[5]?.time - probe.arrivals[1]?.time || 8) / 40; // a site in ten pictures
        const before = old?.before;
        const scale = Math.max(1.3 * peak, old?.scale || 0);
        return {before, ghost: before ? new Chain(before) : null, chain, scale, pace: old?.pace || pace};
      },
      next({chain, ghost, pace}) {
        for (const each of [chain, ghost]) each?.advance(pace);
        return chain.arrivals.length < chain.n - 2 - AHEAD && chain.time < 4000 * pace;
      },
      draw: ({chain, ghost, scale}, canvas) => show(canvas, chain, scale, ghost),
      tell({chain, ghost}) {
        if (!chain.arch) return "The pulse is forming; the theory's line appears after thirteen contacts …";
        const [lattice, theory, other] = [chain.speed(), chain.arch.speed, ghost?.speed()];
        const error = lattice ? `; theory ${off(theory / lattice - 1)}` : "";
        const grey = other ? `; in grey, before the change: ${other.toFixed(3)}` : "";
        return `Peak of the dynamic force ${(chain.arch.force - chain.load).toFixed(3)}. Speed: theory ${theory.toFixed(3)}, lattice ${lattice ? lattice.toFixed(3) : "…"} sites per unit of time${error}${grey}`;
      },
    },

    // A wall drives equal spheres: the plateau by the Riemann invariant, the front by the doubling rule.
    shock: {
      ask: "A wall pushes the row at a steady velocity. How fast do the beads at the very front move?",
      answers: "as fast as the wall|nearly twice as fast|more slowly",
      label: "A row of beads that a wall drives from the left, bars of the dynamic force in each contact, and lines of the plateau and of the leading edge",
      sliders: [["v", "velocity of the wall", 0.05, 1, 0.05, same, 0.4], ["p0", "load: static compression p₀", 0, 1, 0.05, same, 0.25]],
      begin({v, p0}) {
        const energy = (p, k) => Math.pow(p, k + 1) / (k + 1);
        const [k, n] = [1.5, 120];
        const whole = p => ((2 * Math.sqrt(k)) / (k + 1)) * Math.pow(p, (k + 1) / 2); // ∫ c dp
        const behind = root(p => whole(p) - whole(p0) - v, p0, 50);
        const B = root(b => energy(p0 + b, k) - energy(p0, k) - Math.pow(p0, k) * b - 2 * v * v, 0, 50);
        return {chain: new Chain({omega: 1, k, p0, v, n, wall: true}), plateau: Math.pow(behind, k) - Math.pow(p0, k), edge: (2 * v) / B, fastest: 0};
      },
      next(scene) {
        const {chain, edge} = scene;
        chain.advance(0.12 / edge, same); // a site in about eight pictures
        const front = Math.floor(edge * chain.time);
        for (let i = Math.max(front - 6, 1); i < Math.min(front + 6, chain.n); i++) scene.fastest = front > 40 ? Math.max(scene.fastest, chain.w[i]) : 0;
        return front < chain.n - 8;
      },
      draw({chain, plateau, edge}, canvas) {
        const {pen, x, y, base} = show(canvas, chain, 3.2 * plateau);
        line(pen, [[x(0), y(plateau)], [x(chain.n), y(plateau)]], THEORY, 1);
        line(pen, [[x(edge * chain.time), 8], [x(edge * chain.time), base]], THEORY, 1);
      },
      tell: ({chain, edge, fastest}) => `Lines: dynamic force on the plateau by the Riemann invariant, leading edge at ${edge.toFixed(3)} sites per unit of time by the doubling rule, whose beads move at twice the wall's velocity. ` +
        (fastest ? `Here the leading beads have reached ${(fastest / chain.v).toFixed(2)} times this velocity${fastest < 1.9 * chain.v ? ", and the train still grows" : ""}.` : "The train is forming …"),
    },

    // A breather of a loaded dimer, started from its envelope; omega = 1/2, p0 = 1. A contact that
    // swings by U cos Ωt keeps its mean force if it expands by (k - 1)U²/4: the lasting displacement.
    breather: {
      ask: "The light beads swing more strongly. What does their frequency do?",
      answers: "it rises|it stays|it falls",
      then: {nu: 0.005},
      label: "Displacement of each bead of a loaded chain over its place, and the envelope of the theory",
      sliders: [["nu", "detuning 1 − f/f₀", 0.001, 0.005, 0.0005, same, 0.0015]],
      begin({nu}) {
        const [k, omega, n, middle] = [1.5, 0.5, 121, 61]; // a light bead in the middle
        const [U, b] = [Math.sqrt((32 * nu) / (k * (k - 1))), Math.sqrt((8 * nu * (1 - omega)) / omega)];
        const envelope = i => U / Math.cosh((b * (i - middle)) / 2);
        const lasting = i => (((k - 1) * U * U) / (2 * b)) * Math.tanh((b * (i - middle)) / 2);
        const start = i => lasting(i) + (i % 2 ? envelope(i) * ((i - middle) % 4 ? -1 : 1) : 0);
        const bottom = Math.sqrt((2 * k) / omega); // F' = k at the compression 1
        return {chain: new Chain({omega, k, p0: 1, v: 0, n, start, fine: 3}), middle, bottom, U, nu, envelope, lasting, turns: [], last: U};
      },
      next: scene => swing(scene, 0.25) < 2200,
      draw({chain, U, envelope, lasting}, canvas) {
        const [pen, width, height] = sheet(canvas);
        const [x, y] = [i => ((i + 1) / (chain.n + 1)) * width, u => height / 2 - (u / (1.6 * U)) * (height / 2)];
        for (const sign of [1, -1]) line(pen, Array.from(chain.u, (_, i) => [x(i), y(lasting(i) + sign * envelope(i))]), THEORY, 1);
        const drift = (chain.u[0] + chain.u[chain.n - 1]) / 2;
        chain.u.forEach((u, i) => disk(pen, x(i), y(u - drift), i % 2 ? 3 : 2, i % 2 ? LATTICE : "#44546A"));
      },
      tell: scene => `Frequency over that of the band's edge: envelope ${(1 - scene.nu).toFixed(4)}, lattice ${rate(scene)}. No small wave of the chain has a frequency just below 1. The beads on both sides stay apart by the rise of the lines.`,
    },

    // One light bead between two heavy ones that a load presses together, of small mass: its heavy
    // neighbours do not follow the swing, but they make room for its mean force.
    light: {
      ask: "A light bead swings between two heavy ones that a load presses together. It swings twice as far. How does its frequency change?",
      answers: "it rises|it stays|it falls",
      then: {a: 0.8},
      label: "A light bead between two heavy ones, and bars of the force in both contacts",
      sliders: [["a", "amplitude over the static compression", 0.1, 0.8, 0.05, same, 0.4], ["k", "exponent k", 1.1, 3, 0.05, same, 1.5]],
      begin({a, k}) {
        const omega = 1e-4, turn = Array.from({length: 64}, (_, i) => Math.cos(((i + 0.5) * Math.PI) / 64));
        const room = root(x => 1 - turn.reduce((sum, c) => sum + Math.pow(Math.max(1 - x + a * c, 0), k), 0) / 64, 0, 1);
        const start = i => (i - 1) * room + (i === 1 ? a : 0);
        const chain = new Chain({omega, k, p0: 1, v: 0, n: 3, start, fine: 4});
        return {chain, a, k, room, middle: 1, bottom: Math.sqrt((2 * k) / omega), turns: [], last: a};
      },
      next: scene => swing(scene, 0.08) < 220,
      draw({chain, k}, canvas) {
        const [pen, width, height] = sheet(canvas);
        const [heavy, small] = [0.36 * height, 0.15 * height];
        const side = Math.min(1.9 * height, 0.45 * width);
        const place = i => width / 2 + (i - 1) * (heavy + small) + 0.3 * small * chain.u[i];
        [0, 2, 1].forEach(i => disk(pen, place(i), height / 2, i === 1 ? small : heavy, i === 1 ? "#E69F00" : "#44546A"));
        const y = force => height - 6 - (force / 2 ** k) * (height - 12);
        pen.fillStyle = LATTICE;
        chain.contact.forEach((force, i) => pen.fillRect(width / 2 + (i ? side - 0.15 * height : -side), y(force), 0.15 * height, y(0) - y(force)));
        for (const x of [-side, side - 0.15 * height]) line(pen, [0, 0.15].map(part => [width / 2 + x + part * height, y(1)]), THEORY, 1);
      },
      tell(scene) {
        const {a, k, room} = scene, second = part => (1 - part * (k - 1) * a * a / 16).toFixed(4);
        return `Frequency over that of a small swing: counted ${rate(scene)}, to second order ${second(k)}; between neighbours held still it would be ${second(2 - k)}. Bars: both forces; line: the load. Each contact has expanded by ${room.toFixed(3)} of its static compression, so that its mean force stays the load, and is softer.`;
      },
    },

    // The arch of the theory over the beads, at rest: equal beads, peak strain 1.
    arch: {
      ask: "The exponent of the contacts doubles from 3/2 to 3. What does the length of the pulse do?",
      answers: "it grows|it stays|it shrinks",
      still: true,
      then: {k: 3},
      label: "One arch of a power of a cosine over a row of beads",
      sliders: [["k", "exponent k", 1.1, 4, 0.05, same, 1.5]],
      begin: values => ({...values}),
      next: () => true,
      draw({k}, canvas) {
        const [pen, width, height] = sheet(canvas, 6);
        const [x, y] = [xi => (xi / 22 + 0.5) * width, v => height - 26 - v * (height - 40)];
        for (let j = -10; j <= 10; j++) disk(pen, x(j), height - 12, Math.min(0.45 * (x(1) - x(0)), 10), "#44546A");
        line(pen, Array.from({length: 441}, (_, i) => i / 20 - 11).map(xi => [x(xi), y(Math.max(f.profile(xi, 1, k, 1, 1, 1), 0))]), THEORY);
      },
      tell: ({k}) => `The strain is cos^${(2 / (k - 1)).toFixed(1)}(βξ) with β = ${f.beta(k, 1, 1, 1).toFixed(3)}/D; half of its peak is exceeded over ${f.fwhm_strain(k, 1, 1, 1).toFixed(2)} D, and the arch ends after ${(Math.PI / f.beta(k, 1, 1, 1)).toFixed(1)} D.`,
    },
  };

  // One picture of a swinging bead: its upward passages between its neighbours are counted.
  function swing(scene, part) {
    const {chain, middle, bottom} = scene;
    chain.advance(part / bottom, () => {
      const now = chain.u[middle] - (chain.u[middle - 1] + chain.u[middle + 1]) / 2;
      if (scene.last < 0 && now >= 0) scene.turns.push(chain.time - (chain.step * now) / (now - scene.last));
      scene.last = now;
    });
    return bottom * chain.time;
  }

  function rate({turns, bottom}) {
    const count = turns.length - 1;
    return count > 1 ? ((2 * Math.PI * count) / (turns[count] - turns[0]) / bottom).toFixed(4) : "…";
  }

  const percent = x => `${(100 * x).toFixed(1).replace("-", "−")} %`;
  const off = x => (x > 0 ? "+" : "") + percent(x);
  // The pulse behind a blow on spheres, m1 = A = D = v = 1, at contacts 80 and 81: dynamic force of
  // the contact, forces of the two beads there, duration, speed, decay per site, growth of the
  // duration from contact 40 on. The force falls evenly in ln F, and the speed as its power 1/6, under
  // a load as the theory's speed, where the pulse is steady enough for the theory.
  const UNSTEADY = 0.1;
  function struck(omega, p0) {
    const chain = new Chain({omega, k: 1.5, p0, v: 1, n: 100});
    for (const end = 400 * (1 + omega); chain.arrivals.length < 82 && chain.time < end; ) chain.advance(1);
    if (chain.arrivals.length < 82) return null;
    const [a, b, c, d] = [40, 41, 80, 81].map(i => chain.arrivals[i]);
    const [force, growth] = [(c.force + d.force) / 2, (c.width + d.width) / (a.width + b.width) - 1];
    const decay = Math.log((a.force + b.force) / (2 * force)) / 40;
    const theory = part => f.loaded_speed(chain.load + part * force, chain.load, 1.5, 1, 1, omega, 1);
    const power = p0 === 0 ? 1 / 6 : Math.abs(growth) > UNSTEADY ? 0 : Math.log(theory(1.01) / theory(1)) / Math.log(1.01);
    const z = 40 * decay * power;
    const speed = (80 / (c.time + d.time - a.time - b.time)) * (z ? -Math.expm1(-z) / z : 1);
    return {force, beads: [79, 80].map(i => chain.trails[i].bead), width: (c.width + d.width) / 2, speed, decay, growth};
  }

  // Numbers of a blow on spheres in SI units, by the lattice and by each theory, at contact 80. A
  // given force fixes the unit of length, which the lattice's force depends on. lwaSeries: rows of
  // ln omega, width in sites and its error, NaN where the series refuses a value. A material is a name of
  // the table or {E, nu, density}.
  function calculate({a, b, radiusA, radiusB, load, blow, kind}) {
    if (!(radiusA > 0 && radiusB > 0 && blow > 0 && load >= 0)) return {refused: "Radii and the blow must be positive numbers, the load a number that is not negative."};
    if (kind === "force" && blow <= load) return {refused: "The peak force must exceed the load."};
    const [one, two] = [a, b].map(solid => f.materials[solid] ?? solid);
    if (![one, two].every(({E, nu, density}) => E > 0 && nu > -1 && nu <= 0.5 && density > 0)) return {refused: "Young's modulus and density must be positive numbers, Poisson's ratio a number from −1 to 0.5."};
    const [m1, m2] = [[radiusA, one], [radiusB, two]].map(([R, solid]) => (4 / 3) * Math.PI * R ** 3 * solid.density);
    const A = f.hertz_A(one.E, one.nu, radiusA, two.E, two.nu, radiusB);
    const [D, omega, still] = [radiusA + radiusB, m2 / m1, Math.pow(load / A, 2 / 3)];
    if (omega < 0.01 || omega > 100) return {refused: `The mass ratio is ${omega.toPrecision(3)}: the page integrates ratios from 0.01 to 100.`};
    if (kind === "drop") blow = Math.sqrt(2 * 9.81e-3 * blow);
    let unit = kind === "force" ? Math.pow((blow - load) / A, 2 / 3) : Math.pow((m1 * blow ** 2) / A, 0.4);
    let found = struck(omega, still / unit);
    for (let i = 0; found && kind === "force" && i < (load > 0 ? 6 : 2); i++) {
      unit = Math.pow((blow - load) / (A * found.force), 2 / 3);
      if (load > 0) found = struck(omega, still / unit);
    }
    if (!found) return {refused: "No pulse passes eighty contacts: the blow is too weak, or the striker too light."};
    const v = kind === "force" ? Math.sqrt((A * unit ** 2.5) / m1) : blow;
    const newton = A * unit ** 1.5;
    const F = kind === "force" ? blow : load + newton * found.force;
    const values = [1.5, A, m1, m2, D];
    const lattice = {speed: (found.speed * D * v) / unit, width: (found.width * unit) / v};
    const theories = {};
    if (load > 0) {
      const speed = f.loaded_speed(F, load, ...values);
      const [p0, whole, half] = [load, F, (F + load) / 2].map(force => Math.pow(force / A, 2 / 3) / D);
      const falling = flank(whole - p0, p0, 1.5, omega).map(([xi, v]) => [-v, xi]);
      theories["canonical wave"] = {speed, width: (2 * D * between(falling, p0 - half)[1]) / speed};
    } else {
      theories["canonical wave"] = {speed: f.pulse_speed(F, ...values), width: f.pulse_time(F, ...values)};
      theories["paper's closure"] = {speed: f.paper_speed(F, ...values), width: f.paper_time(F, ...values)};
      const row = between(lwaSeries, Math.log(Math.min(omega, 1 / omega))) ?? [];
      theories["series in k − 1"] = row[1] ? {width: (row[1] * D) / lattice.speed, error: row[2] / row[1]} : {refused: "refuses a value at this mass ratio"};
    }
    const pressure = (1.5 * Math.cbrt(F * A * A) * D) / (Math.PI * radiusA * radiusB); // in the middle of the contact
    const beads = found.beads.map(force => newton * force);
    return {m1, m2, A, omega, F, v, beads, decay: found.decay, growth: found.growth, pressure, sound: load > 0 ? f.sound_speed(load, ...values) : 0, lattice, theories};
  }

  function calculatorIn(home) {
    const choice = (names, chosen) => element("select", {}, ...names.map(([value, text = value]) => element("option", value === chosen ? {value, selected: ""} : {value}, text)));
    const number = value => element("input", {type: "text", inputmode: "decimal", value});
    const read = text => (/^\s*[-+]?(\d+([.,]\d*)?|[.,]\d+)(e[-+]?\d+)?\s*$/i.test(text) ? Number(text.replace(",", ".")) : NaN);
    const solids = [...Object.keys(f.materials).map(name => [name]), ["own", "another: E, ν and density"]];
    const own = bead => Object.entries({E: [193, "E in GPa"], nu: [0.3, "Poisson's ratio ν"], density: [7900, "density in kg/m³"]})
      .map(([name, [value, label]]) => [`${name} ${bead}`, [`${bead === "a" ? "first" : "second"} bead: ${label}`, number(value)]]);
    const blows = [["velocity", "the striker's velocity in m/s"], ["drop", "the striker's drop in mm"], ["force", "peak force in N, load included"]];
    const fields = {
      a: ["first bead (the striker)", choice(solids, "steel 316")],
      ...Object.fromEntries(own("a")),
      radiusA: ["its radius in mm", number(2.38)],
      b: ["second bead", choice(solids, "PTFE")],
      ...Object.fromEntries(own("b")),
      radiusB: ["its radius in mm", number(2.38)],
      kind: ["the blow is given as", choice(blows, "velocity")],
      blow: ["its value", number(1.37)],
      load: ["static load in N", number(0)],
    };
    const output = element("output", {"aria-live": "polite"});
    const text = (name, line) => output.append(element("div", {"data-name": name}, line));
    const form = element("div", {class: "lwa-panel"}, ...Object.values(fields).map(([label, input]) => element("label", {}, `${label} `, input)));
    for (const [name, [, input]] of Object.entries(fields)) input.name = name;
    form.addEventListener("input", update);
    const shown = element("div", {}, form, output);
    question(home, {ask: "Steel and PTFE balls of 4.76 mm lie in a row; the first is struck at 1.37 m/s. Sound runs at 4,900 m/s in a bar of this steel, at 820 m/s in PTFE and at 340 m/s in air. How fast does the pulse run?", answers: "faster than sound in PTFE|between PTFE and air|slower than sound in air"}, () => (shown.hidden = false));
    shown.hidden = true;
    home.append(shown);

    function update() {
      const given = Object.fromEntries(Object.entries(fields).map(([name, [, input]]) => [name, input.type === "text" ? read(input.value) : input.value]));
      for (const bead of ["a", "b"]) {
        for (const [name] of own(bead)) fields[name][1].parentElement.hidden = given[bead] !== "own";
        if (given[bead] === "own") given[bead] = {E: 1e9 * given[`E ${bead}`], nu: given[`nu ${bead}`], density: given[`density ${bead}`]};
      }
      given.radiusA *= 1e-3;
      given.radiusB *= 1e-3;
      output.replaceChildren();
      const found = calculate(given);
      if (found.refused) return text("refused", found.refused);
      const {F, v, beads, omega, A, sound, lattice, theories, decay, growth, pressure} = found;
      text("force", `peak force of a contact (the mean of two neighbours): ${F.toPrecision(4)} N, after a blow with ${v.toPrecision(4)} m/s`);
      text("beads", `peak force in the beads there: ${beads[0].toPrecision(3)} N in a first bead, ${beads[1].toPrecision(3)} N in a second bead`);
      text("speed", `speed: ${lattice.speed.toPrecision(4)} m/s` + (sound ? ` (sound: ${sound.toPrecision(4)} m/s)` : ""));
      text("width", `FWHM of the dynamic force in time: ${(1e6 * lattice.width).toPrecision(4)} µs`);
      text("ratio", `mass ratio ω = ${omega.toPrecision(4)}, A = ${A.toPrecision(4)} N/m^1.5; the force falls by ${percent(-Math.expm1(-decay))} per bead`);
      if (Math.abs(growth) > UNSTEADY) text("unsteady", `The pulse changes its duration by ${percent(growth)} between contacts 40 and 80: it is no solitary wave, and the theories do not describe it.`);
      else for (const [name, {speed, width, error, refused}] of Object.entries(theories)) {
        const fast = speed ? `speed ${speed.toPrecision(4)} m/s (${off(speed / lattice.speed - 1)}), ` : "";
        text("theory", refused ? `${name}: ${refused}` : `${name}: ${fast}FWHM ${(1e6 * width).toPrecision(4)} µs (${off(width / lattice.width - 1)}${error ? `, by its own estimate ± ${percent(error)}` : ""})`);
      }
      text("pressure", `Hertz's pressure reaches ${(1e-6 * pressure).toPrecision(3)} MPa: a material with a yield strength below ${(1e-6 * pressure / 1.6).toPrecision(3)} MPa begins to yield below its surface.`);
    }
    update();
  }

  window.lwaTurn = {Chain, calculate, things};
  document.querySelectorAll(".lwa-calculator").forEach(calculatorIn);
  for (const [name, thing] of Object.entries(things)) document.querySelectorAll(`.lwa-${name}`).forEach(home => moving(home, thing));
})();
