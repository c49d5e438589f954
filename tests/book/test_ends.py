"""Things to turn, at the ends of their controls, by a mouse, a keyboard and a finger.

Events are real ones: they go the way of a reader's own, through the browser's hit test, focus and
gestures; events that a script makes do not. Each number that a page then shows is computed by the
packages, no word of a picture is cut, and the console says nothing. Run by its path, after the book
is built: ``python -m pytest tests/book/test_ends.py``.
"""

import json
import math
import re
import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import zip_longest
from unittest.mock import ANY

import numpy as np
import pytest
import scipy
import sympy as sp
from playwright.sync_api import Page

from lwa import (
    Cell,
    Dimer,
    Material,
    Power,
    Sphere,
    canonical_wave,
    expand,
    homogenize,
    loaded_wave,
    piston,
)
from lwa.law import named
from tests.book.browser import DESKTOP, PHONE, chromium, opened
from tests.book.prose import BOOK
from tests.book.test_turn import bloch_error, force_at, numbers, pulses
from validation import Scene, exact_wave, measure, simulate
from validation.scenes.checks import MISSING

HTML = BOOK / "_build" / "html"
HERTZ = Power("3/2")
EQUAL = Cell([1], spacing=1)

LIVE = 1.1
"""Seconds after which the line below a picture, written once a second at most, is the last one."""


MIDDLE = 0.5, 0.5
"""A point of an element, in parts of its width and height."""


def close(value):
    """A number with three decimals, of the page's own steps of time beside the engine's."""
    return pytest.approx(value, rel=2e-3, abs=6e-4)


def decimals(value, count):
    """A number that is printed with so many decimals."""
    return pytest.approx(value, abs=0.6 * 10**-count)


# --- the packages' numbers, by the values of the controls and by how far the page's row has run


@dataclass(frozen=True)
class Run:
    """Time of the page's row, and contacts at which it has read the pulse; of several rows."""

    time: float
    read: list[int]

    def pair(self, first=12, number=0):
        """A contact and the last one of its kind."""
        return first, first + 2 * ((self.read[number] - 1 - first) // 2)

    @property
    def front(self):
        """The last two contacts."""
        return self.read[0] - 2, self.read[0] - 1


def speed_between(first, last, seen):
    return (last - first) / (seen[last].arrival - seen[first].arrival)


def theory_beside(speed, wave):
    """The wave's speed, and its error in percent."""
    theory = float(wave.speed)
    return [close(theory), pytest.approx(100 * (theory / speed - 1), abs=0.25)]


def beside_theory(run, v, omega=1.0, p0=0.0, beads=40):
    """Speed, and where the pulse has formed that of the theory and its error in percent."""
    load, pressed = p0**1.5, {}
    if p0:
        pressed = {"precompression": sp.Float(load)}
    blow = dict(velocities=(v,), precompression=load, wall=1.0 if p0 else None)
    ends = run.pair()
    seen = pulses(ends, run.time, (1.0, omega), beads, **blow)
    speed = speed_between(*ends, seen)
    near, later = (11, 12), (30, 31)
    seen = pulses(near + later, 37 / speed, (1.0, omega), **blow)
    longer = sum(seen[i].fwhm for i in later) / sum(seen[i].fwhm for i in near)
    if abs(longer - 1) > 0.03:
        return [close(speed)]
    force = sp.Float(load + force_at(near, seen))
    cell = EQUAL if omega == 1 else Dimer(1, sp.Float(omega), spacing=1)
    wave = canonical_wave(cell, "3/2").at_force(force, **pressed)
    return [close(speed), *theory_beside(speed, wave)]


def under_load(run, p0, v):
    found = beside_theory(run, v, p0=p0, beads=60)
    if p0:
        wave = canonical_wave(EQUAL, "3/2")
        sound = wave.at_force(1, precompression=sp.Float(p0**1.5)).sound_speed
        found += [close(float(sound)), close(found[0].expected / float(sound))]
    return found


def arch(run, k):
    wave = canonical_wave(EQUAL, str(k))
    length, width = float(wave.sites), float(wave.fwhm("strain"))
    return [
        pytest.approx(2 / (k - 1), rel=5e-3),
        decimals(length, 2),
        decimals(width, 2),
    ]


def ansatz(run, terms, length):
    return [decimals(100 * bloch_error(int(terms), length), 1)]


def observers(run, omega, closure):
    omega = sp.Float(omega)
    if closure != "the paper's":
        wave = canonical_wave(Dimer(1, omega, spacing=1), "3/2")
        return [decimals(float(wave.sites), 2)] * 2
    waves = [
        homogenize(Dimer(*masses, spacing=1), k="3/2").pde.traveling_wave()
        for masses in ((1, omega), (omega, 1))
    ]
    one, two = (float(wave.sites) for wave in waves)
    return [decimals(one, 2), decimals(two, 2), pytest.approx(one / two, rel=6e-3)]


def cell(run, masses, **rest):
    wave = canonical_wave(Cell(list(map(str, masses)), spacing=1), "3/2")
    return [*masses, decimals(float(wave.I), 4), 0.0833, decimals(float(wave.sites), 2)]


def ring(run, omega):
    seen = pulses((12, 13, *run.front), run.time, (1.0, omega), 64)
    before, after = force_at((12, 13), seen), force_at(run.front, seen)
    change = pytest.approx(100 * (after / before - 1), abs=0.3)
    return [12, close(before), run.front[0], close(after), change]


@cache
def coefficients():
    return [float(c) for c in expand(EQUAL, 60).c2.coefficients]


def partial_sum(run, order, k):
    truth = exact_wave([1], k).c2
    terms = [c * (k - 1) ** n for n, c in enumerate(coefficients())]
    error = abs(sum(terms[: int(order) + 1]) - truth)
    return [decimals(truth, 9), order, pytest.approx(max(error, 1e-12), rel=0.06)]


LAWS = {
    "spheres": HERTZ,
    "magnets": named("magnetic", 4, 1),
    "Toda": named("exponential", 1),
    "Hertz's next order": named("hertz2", 1, 1),
}


def law(run, law, v):
    chosen = LAWS[law]
    ends = run.pair()
    # a law stands in place of an exponent
    rest = {"k": MISSING, "law": chosen, "velocities": (v,)}
    seen = pulses((*ends, *run.front), run.time, (1.0,), **rest)
    force, speed = force_at(run.front, seen), speed_between(*ends, seen)
    strain = chosen.compression(EQUAL, sp.Float(force))
    wave = loaded_wave(EQUAL, rise=strain, background=0, law=chosen)
    return [close(force), close(speed), *theory_beside(speed, wave)]


def lattices(run, v):
    """The last row, whose layers are a chain; test_turn has the theory's speeds of the others."""
    ends = run.pair(11, 3)
    stiffness = 2 * 0.75**1.25  # of layers of unit mass
    seen = pulses(ends, run.time, (1 / stiffness,), velocities=(v,))
    return [ANY] * 6 + [close(speed_between(*ends, seen))]


def shock(run, v, p0):
    """Leading edge by the doubling rule, and the fastest beads near it, over the wall."""
    rule = piston(EQUAL, str(v), law=HERTZ, ahead=str(p0))
    edge = float(rule.leading_speed())
    beads = tuple(range(30, 90))
    wall = 1e9  # mass of the wall over that of a bead
    held = dict(precompression=p0**1.5, wall=1.0) if p0 else {}
    scene = Scene(
        masses=(wall, *(1.0,) * 119), stiffnesses=(1.0,) * 119, k=1.5, velocities=(v,),
        duration=run.time, bead_sensors=beads, samples=8001, **held,
    )  # fmt: skip
    run = simulate(scene, rtol=1e-8)
    ahead = np.array(beads)[:, None] - np.floor(edge * run.time)
    near = (ahead >= -6) & (ahead < 6) & (edge * run.time >= 41)
    return [
        decimals(edge, 3),
        pytest.approx(run.bead_velocity[near].max() / v, abs=0.02),
    ]


def light(run, a, k):
    """A bead between two that only its mean force moves; the period is a quadrature."""
    s = (np.arange(4000) + 0.5) * math.pi / 4000

    def pushed(room, x, power):
        return np.maximum(1 - room + x, 0) ** power

    def excess(room):
        return pushed(room, a * np.cos(s), k).mean() - 1

    room = scipy.optimize.brentq(excess, 0, 1)

    def energy(x):
        return (pushed(room, x, k + 1) + pushed(room, -x, k + 1)) / (k + 1)

    x = a * np.sin(s / 2)
    slowness = np.sqrt((a * a - x * x) / 2 / (energy(a) - energy(x)))
    rate = 1 / slowness.mean() / math.sqrt(2 * k)
    second = 1 - k * (k - 1) * a * a / 16
    return [pytest.approx(rate, abs=3e-4), decimals(second, 4), decimals(room, 3)]


def breather(run, number):
    rate = 1 - (1e-3, 1.5e-3, 2.5e-3, 4e-3, 5e-3)[int(number) - 1]
    return [decimals(rate, 4), pytest.approx(rate, abs=3e-4)]


def disorder(run, spread, draw):
    """A row by the page's own generator of random numbers, Park and Miller's."""
    from turned import LOSSES

    state = int(draw) * 7919
    masses = []
    for _ in range(90):
        state = state * 48271 % 2147483647
        masses.append(1 + spread * (2 * state / 2147483647 - 1))
    seen = pulses((12, 13, *run.front), run.time, masses, len(masses))
    left = 100 * force_at(run.front, seen) / force_at((12, 13), seen)
    last = run.front[0]
    # over masses that are drawn evenly
    sides = LOSSES.values()
    losses = [
        s["square"] * spread**2 / 3 + s["power"] * spread**2.5 / 3.5 for s in sides
    ]
    rule = 100 * math.exp(-np.mean(losses) * (last - 12))
    return [12, last, pytest.approx(left, abs=0.3), decimals(rule, 1)]


# --- the table


@dataclass(frozen=True)
class Thing:
    """A thing's page, its controls with the texts of their ends, and the numbers shown."""

    page: str
    controls: dict[str, tuple[str, str]]
    numbers: Callable[..., list]


SPEEDS = "0.2", "2"
RATIOS = "0.02", "1"
THINGS = {
    "chain": Thing("play", {"v": SPEEDS, "omega": RATIOS}, beside_theory),
    "arch": Thing("equal", {"k": ("1.1", "4")}, arch),
    "ansatz": Thing(
        "paper", {"terms": ("none", "b₄"), "length": ("4.5", "40.0")}, ansatz
    ),
    "observers": Thing(
        "closure",
        {
            "omega": ("0.0501", "20"),
            "closure": ("the paper's", "the full one, in the common field"),
        },
        observers,
    ),
    "cell": Thing("cells", {"bead": ("1", "4"), "mass": ("0.1", "6")}, cell),
    "ring": Thing("exact", {"omega": ("0.0501", "1")}, ring),
    "sum": Thing("expansion", {"order": ("0", "60"), "k": ("1.1", "2.0")}, partial_sum),
    "load": Thing("pressed", {"p0": ("0", "0.5"), "v": ("0.05", "2")}, under_load),
    "law": Thing(
        "laws", {"law": ("spheres", "Hertz's next order"), "v": ("0.05", "1.5")}, law
    ),
    "lattices": Thing("links", {"v": SPEEDS}, lattices),
    "shock": Thing("shocks", {"v": ("0.05", "1"), "p0": ("0", "1")}, shock),
    "light": Thing("modes", {"a": ("0.1", "0.8"), "k": ("1.1", "3")}, light),
    "breather": Thing("modes", {"number": ("0.0010", "0.0050")}, breather),
    "disorder": Thing(
        "column", {"spread": ("0\u00a0%", "40\u00a0%"), "draw": ("1", "20")}, disorder
    ),
}

WATCH = """
const draw = CanvasRenderingContext2D.prototype.fillText;
CanvasRenderingContext2D.prototype.fillText = function (words, x, y) {
  const scale = this.getTransform().a;
  const wide = this.measureText(words).width;
  const left = x - wide * {left: 0, center: 0.5, right: 1}[this.textAlign];
  const [right, low] = [this.canvas.width / scale, this.canvas.height / scale];
  if (left < -1 || left + wide > right + 1 || y < 8 || y > low) console.error(`cut: ${words}`);
  draw.call(this, words, x, y);
};
"""
"""A word that is drawn across the edge of its picture is an error of the console."""

READ = """(() => {
  const home = document.querySelector(".lwa-%s");
  const {scene} = home;
  const rows = scene.rows ?? [scene.lattice];
  const control = home.querySelector("[name=%s]");
  return {
    said: control.getAttribute("aria-valuetext") ?? control.value,
    line: home.querySelector("output").textContent,
    focused: document.activeElement === control,
    time: rows[0]?.time ?? 0,
    read: rows.map(row => row?.arrivals.length ?? 0),
    values: {...home.values, ...(scene.masses && {masses: scene.masses})},
  };
})()"""


@dataclass
class Hand:
    """A thing on a page that is turned in one way, one step at a time."""

    page: Page
    name: str
    way: str

    def find(self, part):
        return self.page.locator(f".lwa-{self.name} {part}").first

    def drag(self, part, *points):
        """Press a part at the first point and move over the others, by mouse or finger."""
        element = self.find(part)
        element.evaluate(
            "e => e.scrollIntoView({block: 'center', behavior: 'instant'})"
        )
        box = element.bounding_box()
        (x, y), *others = [
            (box["x"] + x * box["width"], box["y"] + y * box["height"])
            for x, y in points
        ]
        if self.way == "finger":
            # Playwright's own finger only taps
            screen = self.page.context.new_cdp_session(self.page)

            def touch(kind, *points):
                event = {"type": kind, "touchPoints": points}
                screen.send("Input.dispatchTouchEvent", event)

            touch("touchStart", {"x": x, "y": y})
            for x, y in others:
                touch("touchMove", {"x": x, "y": y})
            touch("touchEnd")
            return
        self.page.mouse.move(x, y)
        self.page.mouse.down()
        for x, y in others:
            self.page.mouse.move(x, y)
        self.page.mouse.up()

    def press(self, *keys):
        for key in keys:
            self.page.keyboard.press(key)

    def pause(self):
        """Stop what moves; with the keyboard the button has the focus."""
        button = self.find(".lwa-play")
        if not button.count() or button.inner_text() != "Pause":
            return
        if self.way == "keyboard":
            self.press("Enter")
        else:
            self.drag(".lwa-play", MIDDLE)

    def begin(self):
        """Answer the question, and stop what moves."""
        if self.way == "keyboard":
            self.drag(".lwa-question", MIDDLE)
            self.press("Tab", "Enter")
            assert self.page.evaluate("document.activeElement.ariaPressed") == "true"
            answers = self.find(".lwa-answers").locator("button").count()
            self.press(*["Tab"] * (answers + len(THINGS[self.name].controls)))
        else:
            self.drag(".lwa-answers button", MIDDLE)
        self.pause()

    def steps(self):
        """Both ends of each control, from the last control on."""
        for control in reversed(THINGS[self.name].controls):
            if self.way == "keyboard":
                self.press("Shift+Tab")
            for end in (0, 1):
                self.turn(f"[name={control}]", end)
                yield control, end
        if self.name == "cell" and self.way != "keyboard":
            for end, height in enumerate((0.999, 0.001)):
                self.drag("canvas", (0.3, 0.5), (0.3, 0.6), (0.3, height))
                yield "mass", end

    def turn(self, part, end):
        other, key = ("Home", "End") if end else ("End", "Home")
        if self.way == "keyboard":
            self.press(other, key)  # so that the value changes
        elif self.find(part).evaluate("e => e.tagName") == "SELECT":
            # The list that opens is the system's own: there the keyboard goes on.
            self.drag(part, MIDDLE)
            self.press(key, "Enter")
        else:
            self.drag(part, MIDDLE, (0.3 + 0.4 * end, 0.5), (0.001 + 0.998 * end, 0.5))

    def read(self, control, end):
        seen = self.page.evaluate(READ % (self.name, control))
        return {**seen, "way": self.way, "control": control, "end": end}


@cache
def turned():
    """What all things show at all ends, and what their consoles said."""
    seen = defaultdict(list)
    faults = []
    with chromium() as browser:
        for screen, ways in ((DESKTOP, ("keyboard", "mouse")), (PHONE, ("finger",))):
            pages = {}
            for name, thing in THINGS.items():
                file = HTML / f"{thing.page}.html"
                pages[name], said = opened(browser, file, screen, WATCH)
                faults.append(said)
            for way in ways:
                hands = [Hand(page, name, way) for name, page in pages.items()]
                for hand in hands:
                    hand.begin()
                # All things take a step, one after the other.
                for steps in zip_longest(*(hand.steps() for hand in hands)):
                    time.sleep(LIVE)
                    for hand, step in zip(hands, steps, strict=True):
                        if step:
                            seen[hand.name].append(hand.read(*step))
            for hand in hands:
                if hand.find(".lwa-play").count():
                    hand.drag(".lwa-play", MIDDLE)  # on with the last values
            time.sleep(LIVE)
            for page in pages.values():
                page.context.close()
    return seen, [said for said in faults if said]


def test_the_console_says_nothing():
    assert not turned()[1]


@cache
def wanted(step):
    """The packages' numbers for what a page shows."""
    name, duration, read, values = json.loads(step)
    return THINGS[name].numbers(Run(duration, read), **values)


@pytest.mark.parametrize("name", THINGS)
def test_a_thing_shows_the_packages_numbers_at_its_ends(name):
    thing = THINGS[name]
    steps = turned()[0][name]
    assert len(steps) == 6 * len(thing.controls) + 4 * (name == "cell")
    for step in steps:
        control, values = step["control"], step["values"]
        assert step["said"] == thing.controls[control][step["end"]], step
        # a finger leaves the focus where it was
        assert step["focused"] or step["way"] == "finger" or "cell" in thing.page, step
        ours = wanted(json.dumps([name, step["time"], step["read"], values]))
        # the speed before the change is that of another row
        line = re.sub(r" Grey, [^.]*[.]\d+[.]", "", step["line"])
        assert numbers(line)[: len(ours)] == ours, step


# --- the calculator, by what is typed

FIRST = {"blow": "1.37", "diameterB": "4.76", "load": "0"}
"""What its fields hold before anything is typed; a comma is a decimal point."""
TYPED = (
    {"blow": "0,01"}, {"blow": "6"}, {"diameterB": "1,6"}, {"diameterB": "30"}, {"load": "2"},
    {"load": "1e-9"},
)  # fmt: skip
REFUSED = (
    ({"diameterB": "1"}, "0.00252"),
    ({"diameterB": "60"}, "545"),
    ({"blow": "1e4"}, "Hertz"),
    ({"blow": "0"}, "positive"),
    ({"load": "two"}, "not negative"),
    ({"blow": "1.37,0"}, "positive"),
)
"""Beyond the ends: a part of the refusal."""


@cache
def calculated(way):
    """Rows of the calculator for all that is typed, and what the console said."""
    rows = "[...e.closest('.lwa-calculator').querySelectorAll('[data-name]')]"
    told = f"e => Object.fromEntries({rows}.map(r => [r.dataset.name, r.innerText.split('\\t')]))"
    found = []
    with chromium() as browser:
        screen = PHONE if way == "finger" else DESKTOP
        page, faults = opened(browser, HTML / "calculator.html", screen, WATCH)
        hand = Hand(page, "calculator", way)
        hand.begin()
        held = FIRST
        for typed in (*TYPED, *(typed for typed, _ in REFUSED)):
            for name, text in (FIRST | typed).items():
                if text == held[name]:
                    continue
                hand.drag(f"[name={name}]", MIDDLE)
                hand.press("Home", "Shift+End", *text)
                # the page waits for further letters, and for a second tap
                time.sleep(0.5)
            held = FIRST | typed
            found.append(hand.find("tbody").evaluate(told))
    return found, faults


def amounts(cell):
    """Numbers with a unit in a cell of the table, without their prefixes."""
    found = re.findall(r"([\d.]+)\u00a0([mµ]?)(?:N|s|m/s)", cell)
    return [
        float(number) * {"": 1, "m": 1e-3, "µ": 1e-6}[prefix]
        for number, prefix in found
    ]


STEEL, PTFE = Material.named("steel 316"), Material.named("PTFE")


def by_the_engine(blow, diameter, load, seconds):
    """Force, speed and width at the contacts 80 and 81, forces of their beads; the theories."""
    second = Sphere.solid(str(diameter / 2), PTFE)
    chain = Cell.of_spheres([Sphere.solid("2.38e-3", STEEL), second])
    row = simulate(Scene.of_cell(
        chain, 50, "3/2", velocities=(blow,), duration=seconds, contact_sensors=(79, 80, 81),
        bead_sensors=(80, 81), samples=20001, precompression=load,
        wall=float(chain.stiffnesses[0]) if load else None,
    ))  # fmt: skip
    before, here, after = (measure(row.time, f - f[0]) for f in row.contact_force)
    force = load + (here.peak + after.peak) / 2
    pressed = {"precompression": load} if load else {}
    waves = [canonical_wave(chain, "3/2").at_force(sp.Float(force), **pressed)]
    if not load:
        paper = homogenize(chain, k="3/2").pde.traveling_wave()
        waves.append(paper.at_force(sp.Float(force)))
    speed = 2 * (2.38e-3 + diameter / 2) / (after.arrival - before.arrival)
    width = (here.fwhm + after.fwhm) / 2
    return {
        "force": [force],
        "speed": [speed, *(float(wave.speed) for wave in waves)],
        "width": [width, *(float(wave.fwhm("force", "time")) for wave in waves)],
        "beads": [measure(row.time, f - f[0]).peak + f[0] for f in row.bead_force],
    }


@pytest.mark.parametrize("way", ["mouse", "finger"])
def test_the_calculator_at_its_ends(way):
    seen, faults = calculated(way)
    assert not faults
    for shown, typed in zip(seen, TYPED, strict=False):
        told = {name: amounts(" ".join(cells[1:4])) for name, cells in shown.items()}
        given = FIRST | {name: text.replace(",", ".") for name, text in typed.items()}
        blow, diameter, load = (float(given[name]) for name in FIRST)
        before_the_echo = 92 * (2.38e-3 + diameter / 2e3) / told["speed"][0]
        ours = by_the_engine(blow, diameter / 1e3, load, before_the_echo)
        for name, values in ours.items():
            # the page's Verlet steps, and its speed at contact 80
            assert told[name] == pytest.approx(values, rel=1e-2), (typed, name)
    for shown, (typed, part) in zip(seen[len(TYPED) :], REFUSED, strict=True):
        assert list(shown) == ["refused"], typed
        assert part in shown["refused"][0], typed
