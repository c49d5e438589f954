// Something to turn: a struck chain of beads, and a calculator in SI units.
// Formulas come from lwaFormulas, which lwa writes; nothing else is loaded.
"use strict";
(() => {
  const N = 40; // beads
  const f = lwaFormulas;

  // A struck chain of beads of masses 1 and omega, contacts F = delta^k, spacing 1, under the static
  // compression p0; velocity Verlet with a fixed step.
  class Chain {
    constructor({omega = 0.2733, k = 1.5, p0 = 0, v = 1} = {}) {
      Object.assign(this, {omega, k, p0, v, load: Math.pow(p0, k), time: 0, arrivals: [], trails: [], arch: null});
      this.mass = Array.from({length: N}, (_, i) => (i % 2 ? omega : 1));
      this.u = new Float64Array(N); // displacements along the chain
      this.w = new Float64Array(N); // velocities
      this.w[0] = v;
      this.contact = new Float64Array(N - 1);
      this.fast = Math.max(Math.pow(v * v, 1 / (k + 1)) + p0, 1e-3); // a compression of the scene
      const stiff = k * Math.pow(this.fast, k - 1) * 2 * (1 + 1 / omega);
      this.step = 0.12 / Math.sqrt(stiff);
      this.forces();
    }

    forces() {
      for (let i = 0; i < N - 1; i++) {
        const delta = this.p0 + this.u[i] - this.u[i + 1];
        this.contact[i] = delta > 0 ? Math.pow(delta, this.k) : 0;
      }
    }

    kick(h) {
      for (let i = 0; i < N; i++) {
        const [left, right] = [this.contact[i - 1] ?? this.load, this.contact[i] ?? this.load];
        this.w[i] += (h * (left - right)) / this.mass[i];
      }
    }

    advance(duration) {
      const end = this.time + duration;
      while (this.time < end) {
        const h = Math.min(this.step, end - this.time);
        this.kick(h / 2);
        for (let i = 0; i < N; i++) this.u[i] += h * this.w[i];
        this.forces();
        this.kick(h / 2);
        this.time += h;
        this.watch();
      }
    }

    // The leading peak at each contact: its time and force, by a parabola through three steps, and
    // its width at half maximum. Both are known when the force has fallen below half of the peak.
    watch() {
      const first = this.arrivals.length;
      for (let i = first; i < Math.min(first + 9, N - 2); i++) {
        const trail = (this.trails[i] ||= {best: {time: 0, force: 0}, past: []});
        const now = [this.time, this.contact[i] - this.load];
        const {last, before} = trail;
        if (before && before[1] < last[1] && now[1] <= last[1] && last[1] > trail.best.force) {
          const curve = now[1] - 2 * last[1] + before[1];
          const slope = (now[1] - before[1]) / 2;
          const ahead = -slope / curve; // in steps
          trail.best = {time: last[0] + ahead * (last[0] - before[0]), force: last[1] + (slope * ahead) / 2};
        }
        Object.assign(trail, {before: last, last: now});
        trail.past.push(now);
      }
      const least = 0.4 * (first ? this.arrivals[first - 1].force : 0.02 * this.v);
      const {best, before, last, past} = this.trails[first] || {};
      if (!best || best.force < least || last[1] > best.force / 2) return;
      const half = best.force / 2;
      const crossing = ([t0, f0], [t1, f1]) => t0 + ((half - f0) / (f1 - f0)) * (t1 - t0);
      const up = Math.max(past.findIndex(row => row[1] > half), 1);
      this.arrivals.push({...best, width: crossing(before, last) - crossing(past[up - 1], past[up])});
      if (this.arrivals.length === 13) this.arch = this.theory();
    }

    // The theory's wave at the mean peak force of two neighbouring contacts, from where they peak.
    theory() {
      const [a, b] = this.arrivals.slice(-2);
      const force = (a.force + b.force) / 2 + this.load;
      const values = [this.k, 1, 1, this.omega, 1];
      const speed = this.load > 0 ? f.loaded_speed(force, this.load, ...values) : f.pulse_speed(force, ...values);
      return {force, speed, place: this.arrivals.length - 1, time: (a.time + b.time) / 2, profile: profile(this.k, this.p0, this.omega, force)};
    }

    // Speed of the lattice's pulse in sites per unit of time, between like contacts.
    speed() {
      const n = this.arrivals.length - 1;
      if (n < 18) return NaN;
      const last = n - (n % 2);
      return (last - 12) / (this.arrivals[last].time - this.arrivals[12].time);
    }
  }

  // Length in xi from the middle of the wave, where its strain has risen by B, to a rise v: the
  // quadrature of lwaFormulas.gradient with v = B/cosh^2 s, by the midpoint rule.
  function place(v, B, p0, k, omega) {
    const h = Math.acosh(Math.sqrt(B / v)) / 200;
    let sum = 0;
    for (let s = h / 2; s < 200 * h; s += h) {
      const here = B / Math.cosh(s) ** 2;
      sum += (2 * h * Math.tanh(s) * here) / f.gradient(here, B, p0, k, 1, omega);
    }
    return sum;
  }

  // Dynamic force of the theory's wave over xi, 0 at its middle; peak contact force F, load in it.
  function profile(k, p0, omega, F) {
    const B = Math.pow(F, 1 / k) - p0;
    if (p0 === 0) return xi => Math.pow(Math.max(f.profile(xi, B, k, 1, omega, 1), 0), k);
    const table = Array.from({length: 120}, (_, i) => {
      const v = B / Math.cosh(i / 24) ** 2;
      return [place(v, B, p0, k, omega), Math.pow(p0 + v, k) - Math.pow(p0, k)];
    });
    return xi => {
      const j = table.findIndex(row => row[0] > Math.abs(xi));
      if (j < 1) return 0;
      const [[x0, y0], [x1, y1]] = [table[j - 1], table[j]];
      return y0 + ((y1 - y0) * (Math.abs(xi) - x0)) / (x1 - x0);
    };
  }

  function element(name, attributes = {}, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  }

  const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name) || "#333";
  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;

  function show(canvas, chain) {
    const ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth || 600;
    const height = Math.max(150, width / 4.5);
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    const top = chain.scale || 1;
    const x = i => ((i + 1) / (N + 1)) * width;
    const base = height - 0.9 * x(0) - 6;
    const y = force => base - (force / top) * (base - 8);
    pen.fillStyle = "#56B4E9";
    chain.contact.forEach((force, i) => {
      const high = Math.min(Math.max(force - chain.load, 0), top);
      pen.fillRect(x(i + 0.5) - 0.3 * x(0), y(high), 0.6 * x(0), base - y(high));
    });
    if (chain.arch) {
      const {speed, place, time, profile: wave} = chain.arch;
      const middle = place + speed * (chain.time - time);
      pen.strokeStyle = "#D55E00";
      pen.lineWidth = 2;
      pen.beginPath();
      for (let i = -0.5; i < N - 0.5; i += 0.05) {
        const force = wave(i - middle);
        if (force > 2e-3 * top) pen.lineTo(x(i), y(force));
        else pen.moveTo(x(i), y(force));
      }
      pen.stroke();
    }
    const moved = 0.35 / Math.max(...chain.u.map((u, i) => Math.abs(u - (chain.u[i + 1] ?? u))), 0.02);
    for (let i = 0; i < N; i++) {
      const r = 0.48 * x(0) * Math.cbrt(chain.mass[i]) ** (chain.mass[i] < 1 ? 0.7 : 1);
      pen.beginPath();
      pen.arc(x(i) + 0.5 * moved * chain.u[i] * x(0), height - 0.5 * x(0) - 4, Math.max(r, 1.5), 0, 7);
      pen.fillStyle = i % 2 ? "#F2E6C9" : "#44546A";
      pen.fill();
      pen.strokeStyle = colour("--pst-color-text-base");
      pen.lineWidth = 0.6;
      pen.stroke();
    }
  }

  const SLIDERS = [
    ["omega", "mass ratio ω", -1.7, 0, 0.01, x => 10 ** x, Math.log10(0.2733)],
    ["k", "exponent k", 1.1, 3, 0.05, x => x, 1.5],
    ["p0", "load: static compression p₀", 0, 0.5, 0.01, x => x, 0],
    ["v", "velocity of the blow", 0.2, 2, 0.05, x => x, 1],
  ];

  function chainIn(place) {
    const canvas = element("canvas", {role: "img", "aria-label": "A row of forty beads, bars of the force in each contact, and the theory's wave as a line"});
    const output = element("output", {"aria-live": "polite"});
    const button = element("button", {type: "button"}, calm ? "Play" : "Pause");
    const panel = element("div", {class: "lwa-panel"}, button);
    const values = {};
    let chain, playing = !calm, due = 0;

    function restart() {
      chain = new Chain(values);
      const probe = new Chain(values);
      while (probe.arrivals.length < 6 && probe.time < 400) probe.advance(1);
      chain.scale = 1.3 * Math.max(...probe.arrivals.slice(1).map(a => a.force), 1e-6);
      chain.pace = (probe.arrivals[5]?.time - probe.arrivals[1]?.time || 8) / 40; // a site in ten frames
      if (!playing) settle();
    }

    function settle() {
      while (chain.arrivals.length < 30 && chain.time < 2000) chain.advance(chain.pace);
      report();
      show(canvas, chain);
    }

    function report() {
      if (!chain.arch) return (output.textContent = "The pulse is forming; the theory's line appears after thirteen contacts …");
      const [lattice, theory] = [chain.speed(), chain.arch.speed];
      const error = lattice ? `; theory ${(100 * (theory / lattice - 1)).toFixed(1)} %` : "";
      output.textContent = `Peak force ${chain.arch.force.toFixed(3)}. Speed: theory ${theory.toFixed(3)}, lattice ${lattice ? lattice.toFixed(3) : "…"} sites per unit of time${error}`;
    }

    function frame() {
      if (!playing) return;
      if (canvas.getBoundingClientRect().bottom > 0 && canvas.getBoundingClientRect().top < innerHeight) {
        chain.advance(chain.pace);
        show(canvas, chain);
        if (due++ % 20 === 0) report();
        if (chain.arrivals.length > N - 4) restart();
      }
      requestAnimationFrame(frame);
    }

    for (const [name, text, low, high, step, meaning, start] of SLIDERS) {
      values[name] = meaning(start);
      if ("plain" in place.dataset) continue;
      const value = element("span", {}, values[name].toPrecision(3));
      const slider = element("input", {type: "range", min: low, max: high, step, value: start, "aria-label": text});
      slider.addEventListener("input", () => {
        values[name] = meaning(Number(slider.value));
        value.textContent = values[name].toPrecision(3);
        slider.setAttribute("aria-valuetext", value.textContent);
        restart();
      });
      panel.append(element("label", {}, `${text}: `, value, slider));
    }
    button.addEventListener("click", () => {
      playing = !playing;
      button.textContent = playing ? "Pause" : "Play";
      if (playing) frame();
    });
    place.append(canvas, panel, output);
    restart();
    frame();
  }

  // The lattice's pulse behind a blow on spheres, m1 = A = D = v = 1, under the static compression
  // p0: dynamic force, width and decay at contacts 21 and 22, speed to 33 and 34.
  function struck(omega, p0) {
    const chain = new Chain({omega, k: 1.5, p0, v: 1});
    while (chain.arrivals.length < 34 && chain.time < 3000) chain.advance(1);
    const [a, b, c, d] = [20, 21, 32, 33].map(i => chain.arrivals[i] || {});
    const [force, width] = [(a.force + b.force) / 2, (a.width + b.width) / 2];
    const decay = Math.max(Math.log((2 * force) / (c.force + d.force)) / 12, 0);
    return {force, width, decay, speed: 24 / (c.time + d.time - a.time - b.time)};
  }

  // Peak force, speed and duration behind a blow on spheres in SI units, by theory and lattice. A
  // given force fixes the unit of length (m1 v^2/A)^(2/5), which the lattice's force depends on.
  function calculate({a, b, radiusA, radiusB, load, blow, kind}) {
    const [one, two] = [f.materials[a], f.materials[b]];
    const [m1, m2] = [[radiusA, one], [radiusB, two]].map(([R, solid]) => (4 / 3) * Math.PI * R ** 3 * solid.density);
    const A = f.hertz_A(one.E, one.nu, radiusA, two.E, two.nu, radiusB);
    const [D, omega, still] = [radiusA + radiusB, m2 / m1, Math.pow(load / A, 2 / 3)];
    if (kind === "drop") blow = Math.sqrt(2 * 9.81e-3 * blow);
    let unit = kind === "force" ? Math.pow((blow - load) / A, 2 / 3) : Math.pow((m1 * blow ** 2) / A, 0.4);
    let found = struck(omega, still / unit);
    for (let i = 0; kind === "force" && i < (load > 0 ? 6 : 2); i++) {
      unit = Math.pow((blow - load) / (A * found.force), 2 / 3);
      if (load > 0) found = struck(omega, still / unit);
    }
    const v = kind === "force" ? Math.sqrt((A * unit ** 2.5) / m1) : blow;
    const F = kind === "force" ? blow : load + A * unit ** 1.5 * found.force;
    const values = [1.5, A, m1, m2, D];
    const speed = load > 0 ? f.loaded_speed(F, load, ...values) : f.pulse_speed(F, ...values);
    const [p0, B] = [still / D, Math.pow(F / A, 2 / 3) / D - still / D];
    const half = Math.pow((F + load) / (2 * A), 2 / 3) / D - p0;
    const width = load > 0 ? (2 * D * place(half, B, p0, 1.5, omega)) / speed : f.pulse_time(F, ...values);
    const lattice = {speed: (found.speed * D * v) / unit, width: (found.width * unit) / v, decay: found.decay};
    return {m1, m2, A, omega, F, v, speed, width, sound: load > 0 ? f.sound_speed(load, ...values) : 0, lattice};
  }

  const percent = x => (x === null ? "refused" : `${(100 * x).toFixed(1).replace("-", "−")} %`);

  // Errors over the mass ratio, bright where small; the column next to omega is marked.
  function strip(trust, omega) {
    const light = Math.min(omega, 1 / omega);
    const far = row => Math.abs(Math.log(row.omega / light));
    const here = trust.reduce((best, row) => (far(row) < far(best) ? row : best));
    const names = Object.keys(here).slice(1); // the theories, and last the decay
    const told = names.map(name => `${name} ${percent(here[name])}`).join(", ");
    const usable = names.slice(0, -1).filter(name => here[name] !== null && Math.abs(here[name]) < 0.06);
    const best = usable.sort((a, b) => Math.abs(here[a]) - Math.abs(here[b]))[0];
    const text = `Width, theory divided by lattice, minus one, without a load, at ω = ${here.omega.toPrecision(2)}: ${told} per bead. Use ${best ? `the ${best}` : "the lattice"}.`;
    const grid = element("div", {class: "lwa-strip", role: "img", "aria-label": text});
    for (const name of names) {
      grid.append(element("span", {}, name));
      for (const row of trust) {
        const bad = row[name] === null ? 1 : Math.min(Math.abs(row[name]) * (name === "decay" ? 50 : 5), 1);
        const style = `background: color-mix(in srgb, #00204d ${100 * bad}%, #fde737)`;
        grid.append(element("i", row === here ? {style, class: "here"} : {style}));
      }
    }
    return [grid, element("div", {"data-name": "trust"}, text)];
  }

  function calculatorIn(place) {
    const trust = JSON.parse(document.getElementById("lwa-trust").textContent);
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
    const text = (name, tell) => output.append(element("div", {"data-name": name}, tell));
    const labels = Object.values(fields).map(([label, input]) => element("label", {}, `${label} `, input));
    const form = element("div", {class: "lwa-panel"}, ...labels);
    form.addEventListener("input", update);
    place.append(form, output);

    function update() {
      const value = (name, input) => (input.type === "number" ? input.value * (name.startsWith("radius") ? 1e-3 : 1) : input.value);
      const given = Object.fromEntries(Object.entries(fields).map(([name, [, input]]) => [name, value(name, input)]));
      output.replaceChildren();
      if (!(given.radiusA > 0 && given.radiusB > 0 && given.blow > 0 && given.load >= 0)) return text("refused", "Radii and the blow must be positive, the load not negative.");
      if (given.kind === "force" && given.blow <= given.load) return text("refused", "The peak force must exceed the load.");
      const {F, v, speed, width, sound, omega, A, lattice} = calculate(given);
      text("force", `peak force, mean of two neighbouring contacts: ${F.toPrecision(4)} N, after a blow with ${v.toPrecision(4)} m/s`);
      text("speed", `speed: ${speed.toPrecision(5)} m/s` + (sound ? ` (sound: ${sound.toPrecision(5)} m/s)` : ""));
      text("width", `FWHM of the dynamic force in time: ${(1e6 * width).toPrecision(4)} µs`);
      text("ratio", `mass ratio ω = ${omega.toPrecision(4)}, A = ${A.toPrecision(4)} N/m^1.5`);
      text("lattice", `forty beads integrated here: speed ${lattice.speed.toPrecision(4)} m/s (theory ${percent(speed / lattice.speed - 1)}), FWHM ${(1e6 * lattice.width).toPrecision(4)} µs (theory ${percent(width / lattice.width - 1)}); the force decays by ${percent(lattice.decay)} per bead`);
      output.append(...strip(trust, omega));
    }
    update();
  }

  window.lwaTurn = {Chain, profile, calculate};
  document.querySelectorAll(".lwa-chain").forEach(chainIn);
  document.querySelectorAll(".lwa-calculator").forEach(calculatorIn);
})();
