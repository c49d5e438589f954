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
      Object.assign(this, {omega, k, p0, v, time: 0, arrivals: [], trails: [], arch: null});
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
      const load = Math.pow(this.p0, this.k); // what presses on both ends
      for (let i = 0; i < N; i++) {
        const left = i ? this.contact[i - 1] : load;
        const right = i < N - 1 ? this.contact[i] : load;
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

    energy() {
      const n = this.k + 1;
      const load = Math.pow(this.p0, this.k);
      let sum = load * (this.u[N - 1] - this.u[0]);
      for (let i = 0; i < N; i++) sum += (this.mass[i] * this.w[i] ** 2) / 2;
      for (let i = 0; i < N - 1; i++) {
        const delta = Math.max(this.p0 + this.u[i] - this.u[i + 1], 0);
        sum += (Math.pow(delta, n) - Math.pow(this.p0, n)) / n;
      }
      return sum;
    }

    // The leading peak at each contact: its time and force, by a parabola through three steps. It
    // is known when the force has fallen below half of it.
    watch() {
      const load = Math.pow(this.p0, this.k);
      const first = this.arrivals.length;
      for (let i = first; i < Math.min(first + 9, N - 2); i++) {
        const trail = (this.trails[i] ||= {best: {time: 0, force: 0}});
        const now = [this.time, this.contact[i] - load];
        const {last, before} = trail;
        if (before && before[1] < last[1] && now[1] <= last[1] && last[1] > trail.best.force) {
          const curve = now[1] - 2 * last[1] + before[1];
          const slope = (now[1] - before[1]) / 2;
          const time = last[0] - (slope / curve) * (last[0] - before[0]);
          trail.best = {time, force: last[1] - (slope * slope) / (2 * curve)};
        }
        Object.assign(trail, {before: last, last: now});
      }
      const least = 0.4 * (first ? this.arrivals[first - 1].force : 0.02 * this.v);
      const {best, last} = this.trails[first] || {};
      if (!best || best.force < least || last[1] > best.force / 2) return;
      this.arrivals.push(best);
      if (this.arrivals.length === 13) this.arch = this.theory();
    }

    // The theory's wave at the mean peak force of two neighbouring contacts, from where they peak.
    theory() {
      const [a, b] = this.arrivals.slice(-2);
      const load = Math.pow(this.p0, this.k);
      const force = (a.force + b.force) / 2 + load;
      const values = [this.k, 1, 1, this.omega, 1];
      const speed = load > 0 ? f.loaded_speed(force, load, ...values) : f.pulse_speed(force, ...values);
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

  // Dynamic force of the theory's wave over xi, 0 at its middle; peak contact force F, load in it.
  function profile(k, p0, omega, F) {
    const B = Math.pow(F, 1 / k) - p0;
    if (p0 === 0) return xi => Math.pow(Math.max(f.profile(xi, B, k, 1, omega, 1), 0), k);
    // I F'(p0+v) v'^2 = v^2 [Q(B) - Q(v)], with v = B/cosh^2 s, so that the ends are far away
    const I = f.dispersion_I(1, omega, 1);
    const speed2 = f.rise_Q(B, p0, k);
    const table = [[0, B]];
    const h = 0.02;
    for (let s = h / 2, xi = 0; s < 8; s += h) {
      const v = B / Math.cosh(s) ** 2;
      const gap = Math.max(speed2 - f.rise_Q(v, p0, k), 1e-300);
      xi += 2 * h * Math.tanh(s) * Math.sqrt((I * Math.pow(p0 + v, k - 1)) / gap);
      table.push([xi, B / Math.cosh(s + h / 2) ** 2]);
    }
    return xi => {
      const x = Math.abs(xi);
      let j = table.findIndex(row => row[0] > x);
      if (j < 1) return 0;
      const [[x0, v0], [x1, v1]] = [table[j - 1], table[j]];
      const v = v0 + ((v1 - v0) * (x - x0)) / (x1 - x0);
      return Math.pow(p0 + v, k) - Math.pow(p0, k);
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
    const load = Math.pow(chain.p0, chain.k);
    const top = chain.scale || 1;
    const x = i => ((i + 1) / (N + 1)) * width;
    const base = height - 0.9 * x(0) - 6;
    const y = force => base - (force / top) * (base - 8);
    pen.fillStyle = "#56B4E9";
    chain.contact.forEach((force, i) => {
      const high = Math.min(Math.max(force - load, 0), top);
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
      if (!chain.arch) return (output.textContent = "The blow sorts itself out into a pulse …");
      const lattice = chain.speed();
      const theory = chain.arch.speed;
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

  // What a blow on spheres makes, from the page's table of struck chains on the lattice.
  function calculate({a, b, radiusA, radiusB, load, blow, kind}, trust) {
    const [one, two] = [f.materials[a], f.materials[b]];
    const ball = (radius, solid) => (4 / 3) * Math.PI * radius ** 3 * solid.density;
    const [m1, m2] = [ball(radiusA, one), ball(radiusB, two)];
    const A = f.hertz_A(one.E, one.nu, radiusA, two.E, two.nu, radiusB);
    const D = radiusA + radiusB;
    const omega = m2 / m1;
    const at = (key, x = Math.log(omega)) => {
      const rows = trust.map(row => [Math.log(row.omega), row[key]]);
      const j = Math.min(Math.max(rows.findIndex(row => row[0] >= x), 1), rows.length - 1);
      const [[x0, y0], [x1, y1]] = [rows[j - 1], rows[j]];
      const part = Math.min(Math.max((x - x0) / (x1 - x0), 0), 1);
      return y0 + part * (y1 - y0);
    };
    const F = kind === "force" ? blow : at("force") * A ** 0.4 * (m1 * blow ** 2) ** 0.6;
    const values = [1.5, A, m1, m2, D];
    const speed = load > 0 ? f.loaded_speed(F, load, ...values) : f.pulse_speed(F, ...values);
    const width = load > 0 ? NaN : f.pulse_time(F, ...values);
    const sound = load > 0 ? f.sound_speed(load, ...values) : 0;
    return {m1, m2, A, omega, F, speed, width, sound, errors: {speed: at("speed"), width: at("width"), decay: at("decay")}};
  }

  function calculatorIn(place) {
    const trust = JSON.parse(document.getElementById("lwa-trust").textContent);
    const fields = {};
    const form = element("div", {class: "lwa-panel"});
    const field = (name, text, input) => {
      fields[name] = input;
      form.append(element("label", {}, `${text} `, input));
      input.addEventListener("input", update);
    };
    const choice = (names, chosen) => element("select", {}, ...names.map(([value, text]) => element("option", value === chosen ? {value, selected: ""} : {value}, text)));
    const number = (value, step) => element("input", {type: "number", min: 0, value, step});
    const solids = Object.keys(f.materials).map(name => [name, name]);
    const output = element("output", {"aria-live": "polite"});
    const text = (name, tell) => output.append(element("div", {"data-name": name}, tell));
    field("a", "first bead (the striker)", choice(solids, "steel 316"));
    field("radiusA", "its radius in mm", number(2.38, 0.01));
    field("b", "second bead", choice(solids, "PTFE"));
    field("radiusB", "its radius in mm", number(2.38, 0.01));
    field("kind", "the blow is given as", choice([["velocity", "the striker's velocity in m/s"], ["force", "peak force in N, load included"]], "velocity"));
    field("blow", "its value", number(1.37, 0.01));
    field("load", "static load in N", number(0, 0.1));
    place.append(form, output);

    function update() {
      const given = Object.fromEntries(Object.entries(fields).map(([name, input]) => [name, input.type === "number" ? Number(input.value) : input.value]));
      given.radiusA *= 1e-3;
      given.radiusB *= 1e-3;
      output.replaceChildren();
      if (!(given.radiusA > 0 && given.radiusB > 0 && given.blow > 0 && given.load >= 0)) return text("refused", "Radii and the blow must be positive, the load not negative.");
      if (given.load > 0 && given.kind === "velocity") return text("refused", "Under a load give the peak force: the table of struck chains has none.");
      if (given.kind === "force" && given.blow <= given.load) return text("refused", "The peak force must exceed the load.");
      const found = calculate(given, trust);
      const percent = x => `${(100 * x).toFixed(1).replace("-", "−")} %`;
      text("force", `peak force of a contact: ${found.F.toPrecision(4)} N`);
      text("speed", `speed: ${found.speed.toPrecision(5)} m/s` + (found.sound ? ` (sound: ${found.sound.toPrecision(5)} m/s)` : ""));
      if (found.width) text("width", `FWHM of the force in time: ${(1e6 * found.width).toPrecision(4)} µs`);
      text("ratio", `mass ratio ω = ${found.omega.toPrecision(4)}, A = ${found.A.toPrecision(4)} N/m^1.5`);
      const {speed, width, decay} = found.errors;
      text("trust", `without a load, theory over lattice at this ratio: speed ${percent(speed)}, width ${percent(width)}; the force decays by ${percent(decay)} per bead`);
      const worst = Math.max(Math.abs(speed), Math.abs(width));
      const bar = element("div", {class: "lwa-trust", role: "img", "aria-label": `trust: ${worst < 0.06 ? "good" : worst < 0.12 ? "fair" : "poor"}`});
      bar.style.setProperty("--trust", `${Math.max(5, 100 - 400 * worst)}%`);
      output.append(bar);
    }
    update();
  }

  window.lwaTurn = {Chain, profile, calculate};
  document.querySelectorAll(".lwa-chain").forEach(chainIn);
  document.querySelectorAll(".lwa-calculator").forEach(calculatorIn);
})();
