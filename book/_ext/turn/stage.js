// The frame of a thing to turn: a question, the verdict on the answer, then the picture moves and its
// controls appear. A thing has
//   ask, answers, verdict() -> {right, text}: the question, answers, number of the right one, and why;
//   then: values that the controls take after the answer;
//   label: of the picture, for those who do not see it; shape: its width over its height; least: of
//     the height, in pixels;
//   controls: sliders {name, text, low, high, step, start, value, show}, where value(x) is the
//     quantity at the slider's place x and show its text, or choices {name, text, options, start};
//   begin(values, old) -> scene; next(scene, ticks) advances it by sixtieths of a second, false at its
//     end; draw(scene, pen); tell(scene) -> the line below; rest(scene, ticks): whether a picture
//     that does not play stands here; quiet: nothing moves by itself;
//   touch(scene, x, y) -> values that a pointer at (x, y), parts of the picture, gives the controls;
//   a scene may have `controls`, values that the controls take with it.

const things = {};

const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;

// A thing whose scene are its values, and which nothing moves.
const QUIET = {quiet: true, begin: values => values, next: () => true, rest: () => true};

// Run a scene to where it stands when it does not play: by default four seconds on.
function toRest({next, rest = (_, ticks) => ticks === 240}, scene) {
  for (let ticks = 0; !rest(scene, ticks) && next(scene, 1); ticks++);
}

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const pair of Object.entries(attributes)) made.setAttribute(...pair);
  made.append(...children);
  return made;
}

// Three significant digits and a true minus.
const short = x => Number(x.toPrecision(3)).toString().replace("-", "−");
const percent = (x, digits = 1) =>
  `${(100 * x).toFixed(digits).replace(/^-(?=0\.?0*$)/, "").replace("-", "−")}\u00a0%`;
const signed = (x, digits = 1) => (x > 0 ? "+" : "") + percent(x, digits);

// A number as digits and a power of ten; without digits the power alone.
function tens(x, digits) {
  const [number, power] = x.toExponential(digits ?? 0).split("e");
  const raised = [...String(Number(power))].map(sign => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(sign)]);
  return `${digits === undefined ? "" : `${number}·`}10${raised.join("")}`;
}

// A text whose numbers do not part from their units.
const joined = text => text.replace(/(\d) (?=sites|beads|balls|D²)/g, "$1\u00a0");

// The question; the buttons stay, so that the focus stays, and the verdict stands below them.
function question(home, {ask, answers, verdict}, answered) {
  const buttons = answers.map(text => element("button", {type: "button"}, text));
  const group = element("div", {class: "lwa-answers", role: "group", "aria-label": ask}, ...buttons);
  const line = element("p", {class: "lwa-verdict", role: "status"});
  buttons.forEach((button, chosen) => {
    button.setAttribute("aria-pressed", "false");
    button.addEventListener("click", () => {
      const {right, text} = verdict();
      buttons.forEach((each, i) => {
        each.setAttribute("aria-pressed", String(i === chosen));
        if (i === right) each.classList.add("lwa-right");
      });
      line.textContent = joined(`${chosen === right ? "Yes" : "No"}: ${text}`);
      if (!home.answered) answered();
      home.answered = true;
    });
  });
  home.append(element("p", {class: "lwa-question"}, ask), group, line);
}

function slider({name, text, low, high, step, start, value = x => x, show = short}, changed) {
  const place = quantity => root(x => value(x) - quantity, low, high);
  const shown = element("span", {class: "lwa-value"}, show(start));
  const input = element("input", {
    type: "range", min: low, max: high, step, value: place(start), name,
    "aria-label": text, "aria-valuetext": show(start),
  });
  const told = quantity => {
    shown.textContent = show(quantity);
    input.setAttribute("aria-valuetext", show(quantity));
  };
  input.addEventListener("input", () => {
    told(value(Number(input.value)));
    changed(value(Number(input.value)));
  });
  const set = quantity => {
    input.value = place(quantity);
    told(quantity);
  };
  return {input, set, row: element("label", {}, `${text}: `, shown, input)};
}

function choice({name, text, options, start}, changed) {
  const made = options.map(option => element("option", {value: option}, option));
  const input = element("select", {name}, ...made);
  input.value = start;
  input.addEventListener("input", () => changed(input.value));
  return {input, set: option => (input.value = option), row: element("label", {}, `${text}: `, input)};
}

function stage(home, thing) {
  const plain = !thing.ask;
  const canvas = element("canvas", {role: "img", "aria-label": thing.label});
  const output = element("output", plain ? {} : {"aria-live": "polite"});
  const button = element("button", {type: "button", class: "lwa-play"}, "Play");
  const panel = element("div", {class: "lwa-panel"});
  const values = (home.values = {});
  const controls = {};
  let scene = null;
  let settled = null; // values before the hand came to a control
  let playing = false;
  let last = 0; // time of the picture before
  let due = 0; // time from which the line below may be written again

  const show = () => thing.draw(scene, new Pen(canvas, thing));
  // The line below is written once a second at most; a control that comes to rest has the last word.
  const tell = () => {
    clearTimeout(home.rest);
    const wait = due - performance.now();
    if (wait > 0) {
      if (!playing) home.rest = setTimeout(tell, wait);
      return;
    }
    output.textContent = joined(thing.tell(scene));
    due = performance.now() + 1000;
  };
  const restart = old => {
    scene = home.scene = thing.begin(values, old);
    for (const [name, value] of Object.entries(scene.controls ?? {})) {
      controls[name].set(value);
      values[name] = value;
    }
    if (!playing) toRest(thing, scene);
    show();
    tell();
  };
  function frame(now) {
    if (!playing) return;
    const {top, bottom} = canvas.getBoundingClientRect();
    const ticks = Math.min((now - last) / (1000 / 60), 3);
    last = now;
    if (bottom > 0 && top < innerHeight && ticks > 0) {
      if (!thing.next(scene, ticks)) restart(scene);
      show();
      tell();
    }
    requestAnimationFrame(frame);
  }
  const play = on => {
    playing = on;
    button.textContent = on ? "Pause" : "Play";
    last = performance.now();
    if (on) requestAnimationFrame(frame);
  };
  const change = (name, value) => {
    values[name] = value;
    restart({...scene, before: settled});
  };

  for (const control of thing.controls ?? []) {
    const make = control.options ? choice : slider;
    const made = make(control, value => change(control.name, value));
    made.input.addEventListener("change", () => (settled = {...values}));
    values[control.name] = control.start;
    controls[control.name] = made;
    panel.append(made.row);
  }
  settled = {...values};
  if (!thing.quiet) panel.append(button);
  button.addEventListener("click", () => play(!playing));
  if (thing.touch) {
    canvas.style.touchAction = "none";
    const touched = event => {
      if (!home.answered || !event.buttons) return;
      const box = canvas.getBoundingClientRect();
      const x = (event.clientX - box.left) / (box.width > 460 ? box.width / 2 : box.width);
      const y = (event.clientY - box.top) / box.height;
      for (const [name, value] of Object.entries(thing.touch(scene, x, y))) {
        controls[name].set(value);
        values[name] = value;
      }
      restart(scene);
    };
    canvas.addEventListener("pointerdown", touched);
    canvas.addEventListener("pointermove", touched);
  }
  // Drawn anew at each width, that of a page whose sidebars come late too: circles stay round.
  new ResizeObserver(() => requestAnimationFrame(show)).observe(canvas);

  const below = element("div", {class: "lwa-below"}, panel, output);
  if (!plain) {
    question(home, thing, () => {
      below.hidden = false;
      for (const [name, value] of Object.entries(thing.then ?? {})) {
        controls[name].set(value);
        values[name] = value;
      }
      playing = !calm && !thing.quiet;
      restart({...scene, before: settled});
      settled = {...values};
      play(playing);
    });
    below.hidden = true;
  }
  home.append(canvas, below);
  home.querySelector(".lwa-still")?.classList.add("lwa-replaced");
  restart(null);
  if (plain) play(!calm);
}
