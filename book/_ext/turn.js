// Things to turn: a struck chain, a chain that a wall drives, a breather, an arch, and a calculator.
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
    constructor({omega = 0.2733, k = 1.5, p0 = 0, v = 1, n = 40, wall = false, start = null} = {}) {
      Object.assign(this, {omega, k, p0, v, n, wall, load: Math.pow(p0, k), time: 0, arrivals: [], trails: [], arch: null});
      this.mass = Array.from({length: n}, (_, i) => (i % 2 ? omega : 1));
      this.u = new Float64Array(n); // displacements along the chain
      this.w = new Float64Array(n); // velocities
      this.w[0] = v;
      if (start) this.u.forEach((_, i) => (this.u[i] = start(i)));
      this.contact = new Float64Array(n - 1);
      const most = Math.max(Math.pow((wall ? 4 : 1) * v * v, 1 / (k + 1)) + p0, 1e-3); // a compression of the scene
      this.step = 0.12 / Math.sqrt(2 * k * Math.pow(most, k - 1) * (1 + 1 / omega));
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

  // The frame of a thing that moves: `begin(values, old)` starts a scene, `draw(scene, canvas)` shows
  // it, `next(scene)` advances it by one picture, false at its end, `tell(scene)` is the line below.
  function moving(home, label, sliders, {begin = values => ({...values}), draw, next = () => true, tell}) {
    const canvas = element("canvas", {role: "img", "aria-label": label});
    const output = element("output", {"aria-live": "polite"});
    const button = element("button", {type: "button"}, calm ? "Play" : "Pause");
    const panel = element("div", {class: "lwa-panel"}, button);
    const values = {};
    let scene, playing = !calm, due = 0;
    const restart = old => {
      scene = home.scene = begin(values, old);
      for (let i = 0; !playing && i < 240 && next(scene); i++);
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
      const slider = element("input", {type: "range", min: low, max: high, step, value: root(x => meaning(x) - given, low, high), "aria-label": text, "data-slider": name});
      slider.addEventListener("input", () => {
        values[name] = meaning(Number(slider.value));
        value.textContent = values[name].toPrecision(3);
        slider.setAttribute("aria-valuetext", value.textContent);
        restart({...scene, turned: true});
      });
      panel.append(element("label", {}, `${text}: `, value, slider));
    }
    button.addEventListener("click", () => {
      playing = !playing;
      button.textContent = playing ? "Pause" : "Play";
      if (playing) frame();
    });
    home.append(canvas, panel, output);
    home.next = () => next(scene);
    restart(null);
    frame();
  }

  // Scale and clock stay while a slider moves; the chain as it was before runs along in grey.
  function struckIn(home) {
    const sliders = [
      ["omega", "mass ratio ω", -1.7, 0, 0.01, x => 10 ** x, Math.log10(0.2733)],
      ["k", "exponent k", 1.1, 3, 0.05, same, 1.5],
      ["p0", "load: static compression p₀", 0, 0.5, 0.01, same, 0],
      ["v", "velocity of the blow", 0.2, 2, 0.05, same, 1],
    ];
    moving(home, "A row of forty beads, bars of the force in each contact, the pulse before the last change in grey, and the theory's wave as a line", sliders, {
      begin(values, old) {
        const chain = new Chain(values);
        const probe = new Chain(values);
        while (probe.arrivals.length < 6 && probe.time < 400) probe.advance(1);
        const peak = Math.max(...probe.arrivals.slice(1).map(a => a.force), 1e-6);
        const pace = (probe.arrivals[5]?.time - probe.arrivals[1]?.time || 8) / 40; // a site in ten pictures
        const before = old?.turned ? old.given : old?.before;
        const scale = Math.max(1.3 * peak, old?.scale || 0);
        return {given: {...values}, before, ghost: before ? new Chain(before) : null, chain, scale, pace: old?.pace || pace};
      },
      next({chain, ghost, pace}) {
        for (const each of [chain, ghost]) each?.advance(pace);
        return chain.arrivals.length < chain.n - 2 - AHEAD && chain.time < 4000 * pace;
      },
      draw: ({chain, ghost, scale}, canvas) => show(canvas, chain, scale, ghost),
      tell({chain, ghost}) {
        if (!chain.arch) return "The pulse is forming; the theory's line appears after thirteen contacts …";
        const [lattice, theory, other] = [chain.speed(), chain.arch.speed, ghost?.speed()];
        const error = lattice ? `; theory ${percent(theory / lattice - 1)}` : "";
        const grey = other ? `; in grey, before the change: ${other.toFixed(3)}` : "";
        return `Peak force ${chain.arch.force.toFixed(3)}. Speed: theory ${theory.toFixed(3)}, lattice ${lattice ? lattice.toFixed(3) : "…"} sites per unit of time${error}${grey}`;
      },
    });
  }

  // A wall drives equal spheres: the plateau by the Riemann invariant, the front by the doubling rule.
  function shockIn(home) {
    const sliders = [["v", "velocity of the wall", 0.05, 1, 0.05, same, 0.4], ["p0", "load: static compression p₀", 0, 1, 0.05, same, 0.25]];
    const energy = (p, k) => Math.pow(p, k + 1) / (k + 1);
    moving(home, "A row of beads that a wall drives from the left, bars of the force in each contact, and lines of the plateau and of the leading edge", sliders, {
      begin({v, p0}) {
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
      tell: ({chain, edge, fastest}) => `Lines: force on the plateau by the Riemann invariant, leading edge at ${edge.toFixed(3)} sites per unit of time by the doubling rule, whose beads move at twice the wall's velocity. ` +
        (fastest ? `Here the leading beads have reached ${(fastest / chain.v).toFixed(2)} times this velocity.` : "The train is forming …"),
    });
  }

  // A breather of a loaded dimer, started from its envelope; omega = 1/2, p0 = 1. Its frequency is
  // counted by the passages of the middle light bead through its place.
  function breatherIn(home) {
    const [k, omega, n] = [1.5, 0.5, 121];
    const bottom = Math.sqrt((2 * k) / omega); // F' = k at the compression 1
    moving(home, "Displacement of each bead of a loaded chain over its place, and the envelope of the theory", [["nu", "detuning 1 - f/f₀", 0.001, 0.015, 0.0005, same, 0.004]], {
      begin({nu}) {
        const [U, b] = [Math.sqrt((32 * nu) / (k * (k - 1))), Math.sqrt((8 * nu * (1 - omega)) / omega)];
        const cell = i => (i - 61) / 2; // bead 61 is the light bead in the middle
        const start = i => (i % 2 ? (Math.abs(cell(i)) % 2 ? -U : U) / Math.cosh(b * cell(i)) : 0);
        return {chain: new Chain({omega, k, p0: 1, v: 0, n, start}), U, b, nu, turns: [], last: U, cell};
      },
      next(scene) {
        const {chain} = scene;
        chain.advance(0.25 / bottom, () => {
          const [now, before] = [chain.u[61] - scene.mean, scene.last];
          if (before < 0 && now >= 0) scene.turns.push(chain.time);
          scene.last = now;
        });
        scene.mean = (chain.u[60] + chain.u[62]) / 2;
        return chain.time < 900;
      },
      draw({chain, U, b, cell}, canvas) {
        const [pen, width, height] = sheet(canvas);
        const [x, y] = [i => ((i + 1) / (n + 1)) * width, u => height / 2 - (u / (1.4 * U)) * (height / 2)];
        for (const sign of [1, -1]) line(pen, Array.from({length: n}, (_, i) => [x(i), y((sign * U) / Math.cosh(b * cell(i)))]), THEORY, 1);
        const drift = (chain.u[0] + chain.u[n - 1]) / 2;
        chain.u.forEach((u, i) => disk(pen, x(i), y(u - drift), i % 2 ? 3 : 2, i % 2 ? LATTICE : "#44546A"));
      },
      tell({turns, nu}) {
        const count = turns.length - 1;
        const rate = count > 4 ? (2 * Math.PI * count) / (turns[count] - turns[0]) / bottom : NaN;
        return `Frequency over that of the band's edge: envelope ${(1 - nu).toFixed(4)}, lattice ${rate ? rate.toFixed(4) : "…"}. No small wave of the chain has a frequency just below 1.`;
      },
    });
  }

  // The arch of the theory over the beads, at rest: equal beads, peak strain 1.
  function archIn(home) {
    moving(home, "One arch of a power of a cosine over a row of beads", [["k", "exponent k", 1.1, 4, 0.05, same, 1.5]], {
      draw({k}, canvas) {
        const [pen, width, height] = sheet(canvas, 6);
        const [x, y] = [xi => (xi / 14 + 0.5) * width, v => height - 26 - v * (height - 40)];
        for (let j = -7; j <= 7; j++) disk(pen, x(j), height - 12, Math.min(0.45 * (x(1) - x(0)), 10), "#44546A");
        line(pen, Array.from({length: 281}, (_, i) => i / 20 - 7).map(xi => [x(xi), y(Math.max(f.profile(xi, 1, k, 1, 1, 1), 0))]), THEORY);
      },
      tell: ({k}) => `The strain is cos^${(2 / (k - 1)).toFixed(1)}(βξ) with β = ${f.beta(k, 1, 1, 1).toFixed(3)}/D; half of its peak is exceeded over ${f.fwhm_strain(k, 1, 1, 1).toFixed(2)} D, and the arch ends after ${(Math.PI / f.beta(k, 1, 1, 1)).toFixed(1)} D.`,
    });
  }

  const percent = x => `${(100 * x).toFixed(1).replace("-", "−")} %`;
  // The pulse behind a blow on spheres, m1 = A = D = v = 1, at contacts 80 and 81: dynamic force of
  // the contact, forces of the two beads there, duration, speed, decay per site, growth of the
  // duration from contact 40 on. The force falls evenly in ln F, and the speed as its power 1/6.
  function struck(omega, p0) {
    const chain = new Chain({omega, k: 1.5, p0, v: 1, n: 100});
    for (const end = 400 * (1 + omega); chain.arrivals.length < 82 && chain.time < end; ) chain.advance(1);
    if (chain.arrivals.length < 82) return null;
    const [a, b, c, d] = [40, 41, 80, 81].map(i => chain.arrivals[i]);
    const decay = Math.log((a.force + b.force) / (c.force + d.force)) / 40;
    const z = p0 > 0 ? 0 : (40 * decay) / 6;
    const speed = (80 / (c.time + d.time - a.time - b.time)) * (z ? -Math.expm1(-z) / z : 1);
    return {force: (c.force + d.force) / 2, beads: [79, 80].map(i => chain.trails[i].bead), width: (c.width + d.width) / 2, speed, decay, growth: (c.width + d.width) / (a.width + b.width) - 1};
  }

  // Numbers of a blow on spheres in SI units, by the lattice and by each theory, at contact 80. A
  // given force fixes the unit of length, which the lattice's force depends on. lwaSeries: rows of
  // ln omega, width in sites and its error, NaN where the series refuses a value.
  function calculate({a, b, radiusA, radiusB, load, blow, kind}) {
    if (!(radiusA > 0 && radiusB > 0 && blow > 0 && load >= 0)) return {refused: "Radii and the blow must be positive, the load not negative."};
    if (kind === "force" && blow <= load) return {refused: "The peak force must exceed the load."};
    const [one, two] = [f.materials[a], f.materials[b]];
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
    const number = (value, step) => element("input", {type: "number", min: 0, value, step});
    const solids = Object.keys(f.materials).map(name => [name]);
    const blows = [["velocity", "the striker's velocity in m/s"], ["drop", "the striker's drop in mm"], ["force", "peak force in N, load included"]];
    const fields = {
      a: ["first bead (the striker)", choice(solids, "steel 316")],
      radiusA: ["its radius in mm", number(2.38, 0.01)],
      b: ["second bead", choice(solids, "PTFE")],
      radiusB: ["its radius in mm", number(2.38, 0.01)],
      kind: ["the blow is given as", choice(blows, "velocity")],
      blow: ["its value", number(1.37, 0.01)],
      load: ["static load in N", number(0, 0.1)],
    };
    const output = element("output", {"aria-live": "polite"});
    const text = (name, line) => output.append(element("div", {"data-name": name}, line));
    const form = element("div", {class: "lwa-panel"}, ...Object.values(fields).map(([label, input]) => element("label", {}, `${label} `, input)));
    form.addEventListener("input", update);
    home.append(form, output);

    function update() {
      const value = (name, input) => (input.type === "number" ? input.value * (name.startsWith("radius") ? 1e-3 : 1) : input.value);
      const given = Object.fromEntries(Object.entries(fields).map(([name, [, input]]) => [name, value(name, input)]));
      output.replaceChildren();
      const found = calculate(given);
      if (found.refused) return text("refused", found.refused);
      const {F, v, beads, omega, A, sound, lattice, theories, decay, growth, pressure} = found;
      text("force", `peak force of a contact (the mean of two neighbours): ${F.toPrecision(4)} N, after a blow with ${v.toPrecision(4)} m/s`);
      text("beads", `peak force in the beads there: ${beads[0].toPrecision(3)} N in a first bead, ${beads[1].toPrecision(3)} N in a second bead`);
      text("speed", `speed: ${lattice.speed.toPrecision(4)} m/s` + (sound ? ` (sound: ${sound.toPrecision(4)} m/s)` : ""));
      text("width", `FWHM of the dynamic force in time: ${(1e6 * lattice.width).toPrecision(4)} µs`);
      text("ratio", `mass ratio ω = ${omega.toPrecision(4)}, A = ${A.toPrecision(4)} N/m^1.5; the force falls by ${percent(-Math.expm1(-decay))} per bead`);
      if (Math.abs(growth) > 0.1) text("unsteady", `The pulse changes its duration by ${percent(growth)} between contacts 40 and 80: it is no solitary wave, and the theories do not describe it.`);
      else for (const [name, {speed, width, error, refused}] of Object.entries(theories)) {
        const fast = speed ? `speed ${speed.toPrecision(4)} m/s (${percent(speed / lattice.speed - 1)}), ` : "";
        text("theory", refused ? `${name}: ${refused}` : `${name}: ${fast}FWHM ${(1e6 * width).toPrecision(4)} µs (${percent(width / lattice.width - 1)}${error ? `, by its own estimate ± ${percent(error)}` : ""})`);
      }
      text("pressure", `Hertz's pressure reaches ${(1e-6 * pressure).toPrecision(3)} MPa: a material with a yield strength below ${(1e-6 * pressure / 1.6).toPrecision(3)} MPa begins to yield below its surface.`);
    }
    update();
  }

  window.lwaTurn = {Chain, calculate};
  for (const [name, make] of Object.entries({chain: struckIn, shock: shockIn, breather: breatherIn, arch: archIn, calculator: calculatorIn})) document.querySelectorAll(`.lwa-${name}`).forEach(make);
})();
