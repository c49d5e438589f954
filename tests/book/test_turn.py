"""The chain of the pages' script, run in Node.js, beside the validated lattice."""

import json
import math
import runpy
import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from lwa import Cell, Dimer, Power, envelope, piston
from validation import MeasureError, simulate
from validation.pulses.pulse import first_pulse
from validation.pulses.sensors import tracks
from validation.scenes.chains import struck

pytestmark = [pytest.mark.slow, pytest.mark.optional("node", "sphinx")]

SCRIPTS = Path(__file__).parents[2] / "book" / "_ext"
CONTACTS = 40, 41, 80, 81
PAGE = """
const matchMedia = () => ({}), document = {querySelectorAll: () => []}, window = globalThis;
"""
RUN = """
const struck = job => {
  const chain = new lwaTurn.Chain({...job, n: 100});
  while (chain.arrivals.length < 82) chain.advance(1);
  return {time: chain.time, pulses: CONTACTS.map(i => chain.arrivals[i])};
};
console.log(JSON.stringify(JOBS.map(struck)));
"""


@cache
def script():
    formulas = runpy.run_path(str(SCRIPTS / "interactive.py"))["formulas"]()
    return PAGE + formulas + (SCRIPTS / "turn.js").read_text()


def in_node(program, **values):
    """What a program prints, run after the script and the values."""
    constants = "".join(
        f"const {name} = {json.dumps(value)};" for name, value in values.items()
    )
    source = script() + constants + program
    run = subprocess.run(
        ["node", "-"], input=source, capture_output=True, text=True, timeout=250
    )
    assert not run.returncode, run.stderr
    return json.loads(run.stdout)


def by_lattice(duration, omega, k, p0):
    """Arrival, peak and width at the contacts, NaN where `lwa-validate` refuses the pulse."""
    pressed = dict(precompression=p0**k, wall=1.0) if p0 else {}
    scene = struck(
        (1.0, omega), 100, k, duration=duration, contact_sensors=CONTACTS, **pressed
    )
    for track in tracks(simulate(scene, rtol=1e-9)):
        try:
            pulse = first_pulse(track.force)
            yield pulse.arrival, pulse.peak, pulse.fwhm
        except MeasureError:
            yield (math.nan,) * 3


def refused(ratios, k, loads):
    """Hold chains of the page against the lattice; return how many pulses have no width."""
    jobs, count = [dict(omega=w, k=k, p0=p) for w in ratios for p in loads], 0
    for job, page in zip(jobs, in_node(RUN, JOBS=jobs, CONTACTS=CONTACTS), strict=True):
        keys = "time", "force", "width"
        ours = np.array([[p[key] for key in keys] for p in page["pulses"]], float)
        lattice = np.array(list(by_lattice(page["time"], **job)))
        assert (np.isnan(ours[:, 2]) == np.isnan(lattice[:, 2])).all(), job
        count += np.isnan(lattice[:, 2]).sum()
        passed = [rows[2:, 0] - rows[:2, 0] for rows in (ours, lattice)]
        assert np.nanmax(abs(passed[0] / passed[1] - 1), initial=0) < 1e-3, job
        assert np.nanmax(abs(ours / lattice - 1)[:, 1:], initial=0) < 5e-3, job
    return count


def test_the_page_counts_contacts_as_lwa_validate_does():
    """Humps of one pulse, light strikers, pulses longer than ten sites, two humps too close."""
    assert not refused((0.45, 2.2, 20), 1.5, (0, 0.1))
    assert not refused((100,), 1.5, (2,)) + refused((0.3428,), 3, (0,))
    assert refused((0.4,), 2, (0,)) == 2


@pytest.mark.parametrize("k", [1.2, 1.5, 2, 3])
def test_the_page_counts_contacts_everywhere(k):
    ratios = [float(f"{w:.4g}") for w in np.geomspace(0.01, 100, 13)]
    assert not refused(ratios, k, (0, 0.1, 2)) or k >= 2


LINE = """
const chain = new lwaTurn.Chain();
while (chain.arrivals.length < 34) chain.advance(1);
const wave = Array.from({length: 400}, (_, i) => chain.arch.at(i / 10));
const [line, bars] = [wave, chain.contact].map(row => row.indexOf(Math.max(...row)));
console.log(JSON.stringify({line: line / 10, bars, speed: chain.speed()}));
"""


def test_the_line_of_the_theory_is_over_the_bars():
    """Contact i stands at i + 1/2; after 20 sites the line is there at its own speed."""
    seen = in_node(LINE)
    assert abs(seen["line"] - seen["bars"] - 0.5) < 1
    sensors = struck((1.0, 0.2733), 40, duration=44.0, contact_sensors=(12, 32))
    first, last = (first_pulse(track.force) for track in tracks(simulate(sensors)))
    assert abs(seen["speed"] * (last.arrival - first.arrival) / 20 - 1) < 1e-3


TURNED = """
const run = (name, values, watch = () => {}) => {
  const scene = lwaTurn.things[name].begin(values);
  while (lwaTurn.things[name].next(scene)) watch(scene);
  return scene;
};
const rate = ({turns, bottom}) =>
  (2 * Math.PI * (turns.length - 1)) / (turns.at(-1) - turns[0]) / bottom;
const shock = run("shock", WALL);
const breather = nu => {
  const apart = [];
  const seen = run("breather", {nu}, ({chain: {u}, lasting}) => {
    apart.push((u[75] - u[47]) / (2 * lasting(75)));
  });
  return [rate(seen), seen.bottom, Math.min(...apart), Math.max(...apart)];
};
console.log(JSON.stringify({
  shock: [shock.edge, shock.fastest / WALL.v],
  breathers: NU.map(breather),
  light: LIGHT.map(values => rate(run("light", values))),
}));
"""


def test_what_is_turned_shows_the_theory_beside_it():
    """Doubling rule and El's beads; the envelope's frequency; a light bead to second order."""
    v, ahead, nu = 0.4, 0.25, np.array([0.001, 0.003])
    light = [dict(a=a, k=k) for a in (0.1, 0.3) for k in (1.5, 3)]
    seen = in_node(TURNED, WALL=dict(v=v, p0=ahead), NU=nu.tolist(), LIGHT=light)
    rule = piston(Cell([1], spacing=1), str(v), law=Power("3/2"), ahead=str(ahead))
    assert seen["shock"][0] == pytest.approx(float(rule.leading_speed()), rel=1e-9)
    assert 1.85 < seen["shock"][1] < 2  # from below, as the train grows
    edge = envelope(Dimer(1, "1/2", spacing=1), law=Power("3/2"), background=1)
    rates, bottoms, least, most = np.transpose(seen["breathers"])
    assert bottoms == pytest.approx(float(edge.frequency), rel=1e-12)
    # Verlet's error, and the next order of the envelope
    assert (abs(rates - (1 - nu)) < 5e-5 + 50 * nu**2).all()
    assert 0.95 < least[-1] < most[-1] < 1.15  # the sides stay where they begin
    for values, rate in zip(light, seen["light"], strict=True):
        a, k = values["a"], values["k"]
        assert abs(rate - 1 + k * (k - 1) * a**2 / 16) < 1e-4 + 0.2 * a**4


BLOWS = """
globalThis.lwaSeries = [[0, 1, 1]];
const beads = {radiusA: 2.38e-3, radiusB: 2.38e-3, a: "steel 316", b: "PTFE"};
const under = load => lwaTurn.calculate({...beads, kind: "velocity", blow: 1.37, load});
console.log(JSON.stringify([0, 1e-9].map(load => under(load).lattice.speed)));
"""


def test_a_load_that_vanishes_changes_no_speed():
    """The speed at contact 80 from the mean over 40 contacts, with a load and without."""
    without, loaded = in_node(BLOWS)
    assert loaded == pytest.approx(without, rel=1e-4)
