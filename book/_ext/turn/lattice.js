// A lattice of particles that push each other along a line, integrated in the browser, and what is
// read off its motion. Units are those of the page: a bead's mass, a contact's stiffness, D = 1.

// How many contacts a pulse must be ahead before a contact's record is read: an earlier hump of the
// same pulse is then known to be less than half of the highest one, or more.
const AHEAD = 4;

// The pulse has formed where its duration changes by less than this between contacts 12 and 30.
const STEADY = 0.03;

// A contact that pushes with A delta^k and never pulls.
function power(k, A = 1) {
  return {
    k,
    force: delta => (delta > 0 ? A * Math.pow(delta, k) : 0),
    slope: delta => (delta > 0 ? A * k * Math.pow(delta, k - 1) : 0),
    energy: delta => (delta > 0 ? (A * Math.pow(delta, k + 1)) / (k + 1) : 0),
  };
}

// A spring, which also pulls.
function spring(K) {
  return {k: 1, force: delta => K * delta, slope: () => K, energy: delta => (K * delta * delta) / 2};
}

// The argument at which a rising function is 0, by halving.
function root(g, low, high) {
  for (let i = 0; i < 60; i++) {
    const middle = (low + high) / 2;
    if (g(middle) < 0) low = middle;
    else high = middle;
  }
  return low;
}

// mass: of each particle. links: {i, j, law}; the first ones are the contacts of neighbours in their
// order, at each of which force and arrival of the pulse are read. The contacts are compressed by p0
// at rest, and the load goes on at both ends. Particle 0 starts with the velocity v, and keeps it as
// a wall. Velocity Verlet, with a fixed step: `fine` times shorter than needed for a picture.
class Lattice {
  constructor({mass, links, contacts, p0 = 0, v = 1, wall = false, start = () => 0, fine = 1}) {
    Object.assign(this, {mass, links, p0, v, wall});
    this.n = contacts + 1;
    this.load = links[0].law.force(p0);
    this.u = Float64Array.from(mass, (_, i) => start(i)); // displacements along the row
    this.w = new Float64Array(mass.length); // velocities
    this.w[0] = v;
    this.push = new Float64Array(mass.length); // force on each particle
    this.contact = new Float64Array(contacts);
    this.time = 0;
    this.arrivals = [];
    this.trails = [];
    this.step = 0.12 / fine / Math.sqrt(this.fastest());
    this.forces();
  }

  // Twice the squared frequency of the lightest particle at the highest compression of a blow.
  fastest() {
    const blow = ((this.wall ? 4 : 1) * this.mass[0] * this.v * this.v) / 2;
    const stiff = new Float64Array(this.mass.length);
    for (const {i, j, law} of this.links) {
      const gained = delta => law.energy(this.p0 + delta) - law.energy(this.p0) - blow;
      const rise = root(gained, 0, (law.end ?? 9) - this.p0);
      const slope = law.slope(this.p0 + Math.max(rise, 1e-3));
      stiff[i] += slope;
      stiff[j] += slope;
    }
    return Math.max(...stiff.map((slope, i) => slope / this.mass[i]));
  }

  forces() {
    this.push.fill(0);
    this.push[0] = this.load;
    this.push[this.n - 1] -= this.load;
    this.links.forEach(({i, j, law}, number) => {
      const still = i < this.n && j < this.n ? this.p0 * (j - i) : 0;
      const force = law.force(still + this.u[i] - this.u[j]);
      this.push[i] -= force;
      this.push[j] += force;
      if (number < this.contact.length) this.contact[number] = force;
    });
  }

  kick(h) {
    for (let i = this.wall ? 1 : 0; i < this.mass.length; i++) {
      this.w[i] += (h * this.push[i]) / this.mass[i];
    }
  }

  advance(duration, watch = () => this.watch()) {
    const steps = Math.ceil(duration / this.step);
    const h = duration / steps;
    for (let step = 0; step < steps; step++) {
      this.kick(h / 2);
      for (let i = 0; i < this.u.length; i++) this.u[i] += h * this.w[i];
      this.forces();
      this.kick(h / 2);
      this.time += h;
      watch();
    }
  }

  // Record the dynamic force of each contact until its pulse is read.
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
  }

  // The last contact at which a pulse is read.
  get end() {
    return this.n - 3 - AHEAD;
  }

  // The last contact at which, as at its next, the pulse has been read.
  get front() {
    return this.arrivals.length - 2;
  }

  // Run until the pulse has been read at contact `last`, or until it is late.
  to(last, late = 1e4) {
    while (this.arrivals.length <= last && this.time < late) this.advance(1);
    return this.arrivals.length > last;
  }

  // A number of the arrivals at contacts `place` and `place` + 1, the two of a cell: their mean.
  at(place, name) {
    return (this.arrivals[place][name] + this.arrivals[place + 1][name]) / 2;
  }

  // Sites per unit of time from contact 12 to the last one of its kind; NaN until it has run 6 sites.
  speed(from = 12) {
    const last = from + 2 * Math.floor((this.arrivals.length - 1 - from) / 2);
    if (last < from + 6) return NaN;
    return (last - from) / (this.arrivals[last].time - this.arrivals[from].time);
  }

  // Whether the pulse has formed: by contact 30 its duration has stayed as it was at contact 11.
  get formed() {
    if (this.arrivals.length < 32) return false;
    return Math.abs(this.at(30, "width") / this.at(11, "width") - 1) < STEADY;
  }
}

// A row of n beads of masses 1 and omega, or any, and of contact laws, in turn. Further masses are
// `inside`, further links `more`.
function row({omega = 0.2733, k = 1.5, law = power(k), n = 40, inside = [], more = [], ...rest} = {}) {
  const {mass = [1, omega], laws = [law], ...blow} = rest;
  const masses = Array.from({length: n}, (_, i) => mass[i % mass.length]);
  const contacts = masses.slice(1).map((_, i) => ({i, j: i + 1, law: laws[i % laws.length]}));
  return new Lattice({mass: [...masses, ...inside], links: [...contacts, ...more], contacts: n - 1, ...blow});
}

// The first pulse of a record of rows [time, force], as lwa-validate finds it: from where the force
// exceeds half of the record's maximum to where it first falls below half of its highest value so
// far. The peak is that of a parabola through three rows; a pulse that has not fallen has no width.
function leading(rows) {
  const most = rows.reduce((high, row) => Math.max(high, row[1]), 0);
  const start = rows.findIndex(row => row[1] > most / 2);
  let peak = 0;
  rows.findIndex((row, i) => {
    if (i >= start) peak = Math.max(peak, row[1]);
    return row[1] < peak / 2;
  });
  const top = rows.findIndex(row => row[1] === peak);
  const inside = i => rows[Math.min(Math.max(i, 0), rows.length - 1)];
  const [before, now, next] = [inside(top - 1), inside(top), inside(top + 1)];
  const slope = (next[1] - before[1]) / 2;
  const ahead = slope / (2 * now[1] - next[1] - before[1] || 1); // in steps
  const time = now[0] + ahead * (now[0] - before[0]);
  const force = now[1] + (slope * ahead) / 2;
  const up = rows.slice(0, top).findLastIndex(row => row[1] <= force / 2);
  const down = rows.findIndex((row, i) => i > top && row[1] <= force / 2);
  const crossing = ([t0, f0], [t1, f1]) => t0 + ((force / 2 - f0) / (f1 - f0)) * (t1 - t0);
  const rise = up < 0 ? rows[0][0] : crossing(rows[up], rows[up + 1]);
  const fall = down < 0 ? NaN : crossing(rows[down - 1], rows[down]);
  return {time, force, rise, width: fall - rise};
}

// Row of a table at x, linear between its rows, which are sorted by their first number.
function between(rows, x) {
  const after = rows.findIndex(row => row[0] >= x);
  if (after < 1) return rows[0][0] === x ? rows[0] : null;
  const [low, high] = [rows[after - 1], rows[after]];
  return low.map((value, i) => value + ((x - low[0]) / (high[0] - low[0])) * (high[i] - value));
}

// Rows [xi, v] of the theory's wave under load from its middle on, v the rise of the strain, B at the
// middle: the quadrature of lwaFormulas.gradient with v = B/cosh^2 s, by the midpoint rule.
function flank(B, p0, k, omega) {
  const rows = [[0, B]];
  const h = 0.005;
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

// The theory's wave in a row, at the mean peak force of contacts 11 and 12, from bead 12 on: its
// speed, and its dynamic force over place and time.
function theory(lattice, {k, omega, p0}) {
  const force = lattice.at(11, "force") + lattice.load;
  const passed = lattice.at(11, "time");
  const values = [k, 1, 1, omega, 1];
  const loaded = () => f.loaded_speed(force, lattice.load, ...values);
  const speed = p0 > 0 ? loaded() : f.pulse_speed(force, ...values);
  const wave = profile(k, p0, omega, force);
  return {force, speed, at: (x, time) => wave(x - 12 - speed * (time - passed))};
}
