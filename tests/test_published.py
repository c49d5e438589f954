"""Numbers that others published, beside ours: the tables of `book/literature.md`."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from book.studies.widths import widths
from lwa import Cell, Material, Sphere, canonical_wave
from validation import Scene, measure, simulate
from validation.pulses.pulse import first_pulse
from validation.pulses.sensors import tracks
from validation.scenes.chains import PTFE_BEAD, STEEL_BEAD
from validation.scenes.forcing import Damping

BOOK = Path(__file__).parents[1] / "book"
TABLES = re.findall(r"^\| (.*) \|$", (BOOK / "literature.md").read_text(), re.MULTILINE)
ROWS = {
    cells[0]: cells[1:]
    for row in TABLES
    if len(cells := row.split(" | ")) == 4 and "quantity" not in cells
}


def number(text):
    """A number of the tables: 1/6, −0.78, 12 %."""
    over, _, under = text.replace("−", "-").removesuffix(" %").partition("/")
    return float(over) / float(under or 1)


def check(quantity, value):
    """Hold a value against the printed digits of ours, and their difference to the published."""
    published, ours, difference = ROWS[quantity]
    digits = len(ours.partition(".")[2])
    assert abs(value - number(ours)) <= 0.51 * 10.0**-digits, (quantity, value)
    if difference[0].isdigit() or difference[0] == "−":
        there = number(published)
        off = 100 * (value / there - 1) if difference.endswith("%") else value - there
        digits = len(difference.removesuffix(" %").partition(".")[2])
        assert abs(off - number(difference)) <= 0.51 * 10.0**-digits, (quantity, off)


def test_the_paper():
    cell, points = Cell.of_spheres([STEEL_BEAD, PTFE_BEAD]), []
    for blow in (1.4, 2.8, 4.8):
        chain = Scene.of_cell(cell, 19, "3/2", velocities=(blow,), duration=1.5e-3,
                              bead_sensors=(14, 33))  # fmt: skip
        near, far = (
            first_pulse(track.force) for track in tracks(simulate(chain, rtol=1e-10))
        )
        points.append([1 / (far.arrival - near.arrival), (near.peak + far.peak) / 2])
    V, F = np.log(points).T
    check("exponent of speed against force, 38 beads", np.polyfit(F, V, 1)[0])
    equal = canonical_wave(Cell([1], spacing=1), "3/2")
    check("extent of the pulse, $m_1 = m_2$, sites", math.pi / float(equal.beta))
    check(r"extent of the pulse, $m_1 \gg m_2$, sites", 2 * math.pi / float(equal.beta))

    (ptfe,) = (
        row
        for row in widths().document()["definitions"]
        if row["quantity"].startswith("PTFE") and row["unit"] == "s"
    )
    off = {name: 100 * error for name, error in ptfe["error_value"]["linear"].items()}
    check(r"width for $m_1 \gg m_2$, error in %", off["m1 ≫ m2"])
    check("width for $m_1 = m_2$, error in %", off["m1 = m2"])
    check("width at the paper's masses, error in %", off["m2/m1 = 0.27"])


def test_struck_steel_beads():
    R, rho, E, nu = 5e-3, 7780.0, 2.03e11, 0.3
    cell = Cell.of_spheres([Sphere.solid(R, Material(E=E, nu=nu, density=rho))])
    run = simulate(Scene.of_cell(cell, 60, "3/2", velocities=(1,), duration=8e-4, samples=16001,
                                 bead_sensors=(20, 30, 40)), rtol=1e-10)  # fmt: skip
    first, middle, last = (
        measure(run.time, velocity) for velocity in run.bead_velocity
    )
    check("peak velocity of a bead, m/s", middle.peak)
    speed = 40 * R / (last.arrival - first.arrival)
    c0 = math.sqrt(6 / (5 * math.pi * rho * 3 * (1 - nu**2) / (4 * E)))
    check(
        "speed against $c_0^{4/5} V^{1/5}$, %",
        100 * (speed / (c0**0.8 * middle.peak**0.2) - 1),
    )
    above = run.time[run.bead_velocity[1] > 0.01 * middle.peak]
    # the first stretch above: oscillations behind the pulse stay below
    end = np.argmax(np.append(np.diff(above) > 2 * run.time[1], True))
    check(
        "length above 1 % of the peak, diameters",
        (above[end] - above[0]) * speed / (2 * R),
    )
    fwhm = 2 * math.acos(2**-0.25) * math.sqrt(10) * R
    check(r"FWHM against $\cos^4$, %", 100 * (middle.fwhm * speed / fwhm - 1))


def rebound(m, A, v, rate):
    """Restitution under A (δ^{3/2} + (3/2) rate √δ dδ/dt) if the contact pulls until δ = 0."""

    def motion(t, state):
        delta, speed = max(state[0], 0.0), state[1]
        return speed, -2 * A / m * (delta**1.5 + 1.5 * rate * math.sqrt(delta) * speed)

    def over(t, state):
        return state[0] if t else 1.0

    over.terminal, over.direction = True, -1
    end = solve_ivp(
        motion, (0, 1), (0.0, v), "DOP853", events=over, rtol=1e-11, atol=1e-14
    )
    return -end.y[1, -1] / v


def test_collisions_of_two_spheres():
    ball = Sphere.solid("0.01", Material(E="1e8", nu="0.3", density="2500"))
    m, A = float(ball.mass), float(Cell.of_spheres([ball]).stiffnesses[0])
    pair, rate = dict(masses=(m, m), stiffnesses=(A,), k=1.5), 5e-5
    run = simulate(Scene(**pair, velocities=(1,), duration=1e-3, contact_sensors=(0,),
                         samples=20001), rtol=1e-11)  # fmt: skip
    closed = run.time[run.contact_force[0] > 0]
    check("duration of Hertz's collision at 1 m/s, ms", 1e3 * closed[-1])
    group = (m**2 / 4 / (5e-3 * (1e8 / 1.82) ** 2)) ** 0.2
    assert abs(closed[-1] / group - 2.87) < 0.005
    assert abs(closed[-1] / run.compression.max() - 2.943) < 0.001
    overlap = (15 * m / 2 / (16 * 1e8 / 1.82 * math.sqrt(5e-3))) ** 0.4
    against = r"largest overlap there, against $(15m_*v^2/16E_*\sqrt{R_*})^{2/5}$, %"
    check(against, 100 * (run.compression.max() / overlap - 1))
    for v in ("0.1", "3"):
        viscous = Damping("kuwabara_kono", 1.5 * rate * A)
        blow = Scene(**pair, velocities=(float(v),), duration=5e-3, damping=viscous)
        run = simulate(blow, rtol=1e-11)
        own = (run.velocities[1] - run.velocities[0]) / float(v)
        check(f"restitution at {v} m/s, contacts that never pull", own)
        check(
            f"restitution at {v} m/s, contacts that pull", rebound(m, A, float(v), rate)
        )


def powers(beads):
    """Slopes of speed, velocity and displacement of a weak blow's front against the depth."""
    at = np.unique(np.geomspace(beads / 8, beads * 0.8, 8).astype(int))
    duration = 1.05 * np.sum(np.arange(1, beads + 1) ** (-1 / 6)) / math.sqrt(1.5) + 6
    column = Scene(
        masses=(1.0,) * beads, stiffnesses=(1.0,) * (beads - 1), wall=1.0, k=1.5, gravity=1.0,
        velocities=(1e-4,), duration=duration, bead_sensors=tuple(at.tolist()), samples=12001,
    )  # fmt: skip
    run = simulate(column, rtol=1e-9)
    moved = (run.bead_displacement - run.bead_displacement[:, :1]).max(axis=1)
    speed = np.diff(at) / np.diff(run.time[np.argmax(run.bead_velocity, axis=1)])
    rows = (
        ((at[1:] + at[:-1]) / 2, speed),
        (at, run.bead_velocity.max(axis=1)),
        (at, moved),
    )
    return [np.polyfit(np.log(x), np.log(y), 1)[0] for x, y in rows]


def test_a_column_under_its_own_weight():
    speed, velocity, displacement = powers(800)
    check("exponent of the speed", speed)
    check("exponent of the velocity of a bead", velocity)
    check("exponent of the displacement of a bead", displacement)


@pytest.mark.slow
def test_deeper_down_the_column_the_top_counts():
    _, velocity, displacement = powers(3200)
    assert abs(velocity + 0.254) < 5e-4
    assert abs(displacement + 0.092) < 5e-4


@pytest.mark.parametrize("ratio", ["0.98", "0.55"])
def test_pulses_that_decay(ratio):
    chain = Scene(
        masses=(1.0, float(ratio)) * 50, stiffnesses=(1.0,) * 99, k=1.5, velocities=(1.0,),
        duration=60, contact_sensors=(20, 21, 40, 41),
    )  # fmt: skip
    peaks = [
        first_pulse(track.force).peak for track in tracks(simulate(chain, rtol=1e-9))
    ]
    loss = 100 * (1 - sum(peaks[2:]) / sum(peaks[:2]))
    check(f"loss of force per 20 beads at the mass ratio {ratio}, %", loss)


def test_slow_collisions():
    speeds, lost = np.array([1e-6, 1e-5]), []
    for v in speeds:
        pair = Scene(masses=(1.0, 1.0), stiffnesses=(1.0,), k=1.5, velocities=(float(v),),
                     duration=6 * v**-0.2, damping=Damping("kuwabara_kono", 0.05))  # fmt: skip
        run = simulate(pair, rtol=1e-11)
        lost.append(1 - (run.velocities[1] - run.velocities[0]) / v)
    check("exponent of $1 - e_r$ against the speed of slow collisions",
          np.diff(np.log(lost))[0] / np.log(10))  # fmt: skip


def test_each_row_of_the_page_is_checked_here():
    assert len(ROWS) == 22
