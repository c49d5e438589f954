// The calculator: the reader's own row of spheres, integrated, beside each theory.

const UNSTEADY = 0.1; // growth of the duration from which the theories do not describe the pulse
const FORM = "closed form"; // of the lattice's own wave, or the nearest to it
const FLATTENED = 0.1; // compression over the smaller radius from which Hertz's law is refused

// The pulse behind a blow on spheres, m1 = A = D = v = 1, at contacts 80 and 81: dynamic force of
// the contact, forces of the two beads there, duration, speed, decay per site, growth of the
// duration from contact 40 on, and the record of contact 80. The force falls evenly in ln F, and the
// speed as its power 1/6, under a load as the theory's speed, where the pulse is steady enough.
function struck(omega, p0) {
  const lattice = row({omega, p0, n: 100});
  if (!lattice.to(81, 400 * (1 + omega))) return null;
  const force = lattice.at(80, "force");
  const growth = lattice.at(80, "width") / lattice.at(40, "width") - 1;
  const decay = Math.log(lattice.at(40, "force") / force) / 40;
  const theory = part => f.loaded_speed(lattice.load + part * force, lattice.load, 1.5, 1, 1, omega, 1);
  let power = 1 / 6;
  if (p0 > 0) power = Math.log(theory(1.01) / theory(1)) / Math.log(1.01);
  if (p0 > 0 && Math.abs(growth) > UNSTEADY) power = 0;
  const z = 40 * decay * power;
  const mean = 40 / (lattice.at(80, "time") - lattice.at(40, "time"));
  const beads = [79, 80].map(i => lattice.trails[i].bead);
  return {
    force, beads, decay, growth,
    width: lattice.at(80, "width"),
    speed: mean * (z ? -Math.expm1(-z) / z : 1),
    pulse: lattice.arrivals[80],
    record: lattice.trails[80].past,
  };
}

// Numbers of a blow on spheres in SI units, by the lattice and by each theory, at contact 80. A
// given force fixes the unit of length, which the lattice's force depends on. lwaForms: rows of
// ln omega, speed and width in sites, each with its relative error, NaN where no pulse is steady. A
// material is a name of the table or {E, nu, density, yield}.
function calculate({a, b, radiusA, radiusB, load, blow, kind}) {
  if (!(radiusA > 0 && radiusB > 0 && blow > 0 && load >= 0)) {
    return {refused: "Radii and the blow must be positive numbers, the load a number that is not negative."};
  }
  if (kind === "force" && blow <= load) return {refused: "The peak force must exceed the load."};
  const solids = [a, b].map(solid => f.materials[solid] ?? solid);
  if (!solids.every(({E, nu, density}) => E > 0 && nu > -1 && nu <= 0.5 && density > 0)) {
    return {refused: "Young's modulus and density must be positive numbers, Poisson's ratio a number from −1 to 0.5."};
  }
  const [one, two] = solids;
  const [m1, m2] = [[radiusA, one], [radiusB, two]].map(([R, {density}]) => (4 / 3) * Math.PI * R ** 3 * density);
  const A = f.hertz_A(one.E, one.nu, radiusA, two.E, two.nu, radiusB);
  const D = radiusA + radiusB;
  const omega = m2 / m1;
  const still = Math.pow(load / A, 2 / 3);
  if (omega < 0.01 || omega > 100) {
    return {refused: `The mass ratio is ${omega.toPrecision(3)}: the page integrates ratios from 0.01 to 100.`};
  }
  const fall = kind === "drop" ? Math.sqrt(2 * 9.81e-3 * blow) : blow;
  let unit = kind === "force" ? Math.pow((blow - load) / A, 2 / 3) : Math.pow((m1 * fall ** 2) / A, 0.4);
  if (unit + still > FLATTENED * Math.min(radiusA, radiusB)) {
    const part = percent((unit + still) / Math.min(radiusA, radiusB), 0);
    return {refused: `The blow would compress a contact by about ${part} of the smaller radius: Hertz's law holds up to some ${percent(FLATTENED, 0)}.`};
  }
  let found = struck(omega, still / unit);
  for (let i = 0; found && kind === "force" && i < (load > 0 ? 6 : 2); i++) {
    unit = Math.pow((blow - load) / (A * found.force), 2 / 3);
    if (load > 0) found = struck(omega, still / unit);
  }
  if (!found) return {refused: "No pulse passes eighty contacts: the blow is too weak, or the striker too light."};
  const v = kind === "force" ? Math.sqrt((A * unit ** 2.5) / m1) : fall;
  const newton = A * unit ** 1.5;
  const F = kind === "force" ? blow : load + newton * found.force;
  const values = [1.5, A, m1, m2, D];
  const second = unit / v;
  const lattice = {speed: (found.speed * D) / second, width: found.width * second};
  const given = {F, load, A, D, omega, values, m1, m2};
  const theories = load > 0 ? underLoad(given) : withoutLoad(given);
  const curvature = D / (radiusA * radiusB);
  const pressure = (1.5 * Math.cbrt(F * A * A) * curvature) / Math.PI; // in the middle of the contact
  return {
    m1, m2, A, omega, F, v, lattice, theories, pressure,
    beads: found.beads.map(force => newton * force),
    decay: found.decay, growth: found.growth,
    sound: load > 0 ? f.sound_speed(load, ...values) : 0,
    record: found.record.map(([time, force]) => [second * time, newton * force]),
    pulse: {...found.pulse, time: second * found.pulse.time, rise: second * found.pulse.rise, force: newton * found.pulse.force, width: second * found.pulse.width},
    yields: solids.map(solid => solid.yield),
  };
}

function underLoad({F, load, A, D, omega, values}) {
  const speed = f.loaded_speed(F, load, ...values);
  const [p0, whole, half] = [load, F, (F + load) / 2].map(force => Math.pow(force / A, 2 / 3) / D);
  const falling = flank(whole - p0, p0, 1.5, omega).map(([xi, v]) => [-v, xi]);
  const width = (2 * D * between(falling, p0 - half)[1]) / speed;
  return {"canonical wave": {speed, width}};
}

function withoutLoad({F, A, D, omega, values, m1, m2}) {
  const waves = {
    "canonical wave": {speed: f.pulse_speed(F, ...values), width: f.pulse_time(F, ...values)},
    "paper's closure": {speed: f.paper_speed(F, ...values), width: f.paper_time(F, ...values)},
  };
  // in units of the heavy ball's mass, A and D, at unit force
  const [, c, offC, sites, offWidth] = between(lwaForms, Math.log(Math.min(omega, 1 / omega))) ?? [];
  if (!c) return {...waves, [FORM]: {refused: "no steady pulse"}};
  const speed = c * D * Math.cbrt(A) * Math.pow(F, 1 / 6) / Math.sqrt(Math.max(m1, m2));
  return {...waves, [FORM]: {speed, width: (sites * D) / speed, errors: [offC, offC + offWidth]}};
}

// Force at contact 80 over time, with its peak, its width at half height and its arrival.
function drawRecord({record, pulse}, pen) {
  const [start, end] = [pulse.time - 2.6 * pulse.width, pulse.time + 3.2 * pulse.width];
  const x = time => 12 + ((time - start) / (end - start)) * (pen.width - 24);
  const y = force => pen.height - 30 - (force / pulse.force) * (pen.height - 62);
  const seen = record.filter(([time]) => time > start && time < end).map(([time, force]) => [x(time), y(force)]);
  pen.line([[x(start), y(0)], [x(end), y(0)]], pen.ink, 1);
  if (seen.length > 1) pen.line(seen, LATTICE, 2.5);
  pen.line([[x(pulse.time), y(0)], [x(pulse.time), y(pulse.force)]], THEORY, 1.5, [5, 4]);
  pen.text("peak", x(pulse.time) + 8, y(pulse.force) + 2, {fill: pen.ink});
  const half = y(pulse.force / 2);
  const fall = pulse.rise + pulse.width;
  pen.line([[x(pulse.rise), half], [x(fall), half]], THEORY, 2);
  pen.text("FWHM", x(fall) + 8, half + 4);
  pen.text("arrival at contact 80", x(pulse.time), pen.height - 10, {align: "center"});
}

const BLOWS = {
  "the striker's velocity in m/s": "velocity", "the striker's drop in mm": "drop", "peak force in N, load included": "force",
};
const OWN = {E: [193, "E in GPa"], nu: [0.3, "Poisson's ratio ν"], density: [7900, "density in kg/m³"]};
const ANOTHER = "another: E, ν and density";

function calculator(home) {
  const number = value => element("input", {type: "text", inputmode: "decimal", value});
  const select = (options, chosen) => {
    const made = options.map(text => element("option", text === chosen ? {value: text, selected: ""} : {value: text}, text));
    return element("select", {}, ...made);
  };
  const read = text => (/^\s*[-+]?(\d+([.,]\d*)?|[.,]\d+)(e[-+]?\d+)?\s*$/i.test(text) ? Number(text.replace(",", ".")) : NaN);
  const solids = [...Object.keys(f.materials), ANOTHER];
  const fields = {};
  for (const [bead, name, solid] of [["A", "first ball (the striker)", "steel 316"], ["B", "second ball", "PTFE"]]) {
    fields[`solid${bead}`] = [name, select(solids, solid)];
    for (const [key, [value, label]] of Object.entries(OWN)) fields[`${key}${bead}`] = [`its ${label}`, number(value)];
    fields[`diameter${bead}`] = ["its diameter in mm", number(4.76)];
  }
  fields.kind = ["the blow is given as", select(Object.keys(BLOWS), Object.keys(BLOWS)[0])];
  fields.blow = ["its value", number(1.37)];
  fields.load = ["static load in N", number(0)];
  const form = element("div", {class: "lwa-panel"});
  for (const [name, [label, input]] of Object.entries(fields)) {
    input.name = name;
    form.append(element("label", {}, `${label} `, input));
  }
  const canvas = element("canvas", {role: "img", "aria-label": "Force at contact 80 over time, with its peak, its width at half height and its arrival"});
  const body = element("tbody");
  const head = ["quantity", "by the simulation", ...["canonical wave", "paper's closure", FORM]];
  const titles = element("tr", {}, ...head.map(text => element("th", {scope: "col"}, text)));
  const caption = element("caption", {}, "The pulse at contact 80");
  const scrolls = element("div", {class: "lwa-scrolls", tabindex: "0", role: "region", "aria-label": "numbers of the pulse"},
    element("table", {class: "table"}, caption, element("thead", {}, titles), body));
  const notes = element("div", {"aria-live": "polite"});
  const shown = element("div", {class: "lwa-below"}, form, canvas, scrolls, notes);
  let late = null;

  const note = (name, text) => notes.append(element("p", {"data-name": name}, text));
  const put = (name, ...cells) => {
    const [first, ...others] = cells;
    while (others.length < head.length - 1) others.push("");
    body.append(element("tr", {"data-name": name}, element("th", {scope: "row"}, first), ...others.map(text => element("td", {}, text))));
  };
  function update() {
    const given = {kind: BLOWS[fields.kind[1].value], blow: read(fields.blow[1].value), load: read(fields.load[1].value)};
    for (const bead of ["A", "B"]) {
      const own = fields[`solid${bead}`][1].value === ANOTHER;
      for (const key of Object.keys(OWN)) fields[`${key}${bead}`][1].parentElement.hidden = !own;
      const value = key => read(fields[`${key}${bead}`][1].value);
      given[`radius${bead}`] = value("diameter") / 2e3;
      given[bead.toLowerCase()] = own ? {E: 1e9 * value("E"), nu: value("nu"), density: value("density")} : fields[`solid${bead}`][1].value;
    }
    body.replaceChildren();
    notes.replaceChildren();
    const found = calculate(given);
    canvas.hidden = scrolls.hidden = Boolean(found.refused);
    if (found.refused) return note("refused", found.refused);
    const {F, v, beads, omega, A, sound, lattice, theories, decay, growth, pressure, yields} = found;
    const steady = Math.abs(growth) <= UNSTEADY;
    const names = head.slice(2).filter(() => steady);
    const cells = write => names.map(name => (theories[name] ? write(theories[name]) : "–"));
    put("force", "peak force of a contact", si(F, "N"), ...cells(() => "given"));
    const beside = (value, unit, truth, error) => {
      const digits = error < 1e-3 ? 2 : 1;
      const covered = error ? `, ±\u00a0${percent(error, digits)}` : "";
      return `${si(value, unit)} (${signed(value / truth - 1, digits)}${covered})`;
    };
    const write = (name, unit, number) => cells(one =>
      one.refused ?? beside(one[name], unit, lattice[name], one.errors?.[number]));
    put("speed", "speed", si(lattice.speed, "m/s"), ...write("speed", "m/s", 0));
    put("width", "FWHM of the force", si(lattice.width, "s"), ...write("width", "s", 1));
    put("beads", "force of a first, a second ball", `${si(beads[0], "N")}, ${si(beads[1], "N")}`);
    put("decay", "loss of force per ball", percent(-Math.expm1(-decay)));
    if (sound) put("sound", "speed of sound", si(sound, "m/s"));
    put("pressure", "Hertz's pressure", si(pressure, "Pa"));
    put("ratio", "mass ratio; A", `${omega.toPrecision(4)}; ${tens(A, 3)}\u00a0N/m^1.5`);
    note("blow", `The striker moves at ${v.toPrecision(4)}\u00a0m/s.`);
    if (!steady) note("unsteady", `The pulse changes its duration by ${percent(growth)} between contacts 40 and 80: it is no solitary wave, and the theories do not describe it.`);
    note("yields", yielding(pressure, ["first", "second"].map((name, i) => [`the ${name} ball`, yields[i]])));
    drawRecord(found, new Pen(canvas, {shape: 3}));
  }
  form.addEventListener("input", () => {
    clearTimeout(late);
    late = setTimeout(update, 120); // not at each letter
  });
  addEventListener("resize", () => shown.hidden || update());
  question(home, {
    ask: "Steel and PTFE balls of 4.76 mm lie in a row; the first is struck at 1.37 m/s. Sound runs at 4,900 m/s in a bar of this steel, at 820 m/s in PTFE and at 340 m/s in air. How fast does the pulse run?",
    answers: ["faster than sound in PTFE", "between PTFE and air", "slower than sound in air"],
    verdict() {
      const {lattice} = calculate({a: "steel 316", b: "PTFE", radiusA: 2.38e-3, radiusB: 2.38e-3, load: 0, blow: 1.37, kind: "velocity"});
      return {right: 2, text: `at ${lattice.speed.toFixed(0)}\u00a0m/s, slower than sound in air.`};
    },
  }, () => {
    shown.hidden = false;
    home.querySelector(".lwa-still")?.classList.add("lwa-replaced");
    update();
  });
  shown.hidden = true;
  home.append(shown);
}

// Four digits with a prefix and the unit.
function si(value, unit) {
  const [size, prefix] = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]].find(([size]) => value >= size || size === 1e-9);
  return unit === "m/s" ? `${value.toPrecision(4)}\u00a0m/s` : `${(value / size).toPrecision(4)}\u00a0${prefix}${unit}`;
}

// A sphere yields below its surface where the pressure in the middle exceeds 1.6 times its strength.
function yielding(pressure, balls) {
  return balls.map(([name, strength]) => {
    if (!strength) return `For ${name} no yield strength is known here: a material below ${si(pressure / 1.6, "Pa")} yields.`;
    const verb = pressure > 1.6 * strength ? "yields" : "does not yield";
    return `At this pressure ${name} ${verb} (its strength is about ${si(strength, "Pa")}; it would yield from ${si(1.6 * strength, "Pa")} on).`;
  }).join(" ");
}
