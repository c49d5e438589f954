"""Claims of the pages beside the numbers that are computed when the book is built."""

import math

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Material, Sphere, pulse_of_strike
from validation import Damping, measure, simulate
from validation.scenes.chains import struck
from validation.waves.solver import resonances


def test_the_first_pages_ball_does_not_yield():
    """It falls 5 mm; dropped 10 cm, as on the old page, it would yield in any steel."""
    ball = Sphere("29.0e-3", "9.525e-3", Material(E="193e9", nu="0.3"))
    modulus, radius = 193e9 / (1 - 0.3**2) / 2, 9.525e-3 / 2

    def pressure(drop):
        force = pulse_of_strike(Cell.of_spheres([ball]), ball.mass, drop=drop).force
        return (6 * force.value * modulus**2 / (math.pi**3 * radius**2)) ** (1 / 3)

    assert pressure("0.005") < 1.6 * 1900e6 < pressure("0.1")


@pytest.mark.slow
def test_turning_points_of_the_light_bead():
    """Four at the largest special ratio, and two more at each further one."""
    xi = np.linspace(-9, 9, 9001)
    for n, wave in enumerate(resonances(1.5, 3)):
        off = wave.strain(xi - 0.5) - wave.strain(xi + 0.5, 1)
        turns = (np.diff(off)[1:] * np.diff(off)[:-1] < 0) & (np.abs(off[1:-1]) > 2e-4)
        assert turns.sum() == 4 + 2 * n


def test_a_law_that_stiffens_has_a_pulse():
    """Q is a weighted mean of F′ from 0 to v, so that Q rises where F′ does."""
    s, v = sp.symbols("s v", positive=True)
    for law in (sp.exp(v) - 1, v + v**2 - v**3):
        mean = 2 * sp.integrate((1 - s) * law.diff(v).subs(v, s * v), (s, 0, 1))
        rest = sp.integrate(law, v)
        Q = 2 * (rest - rest.subs(v, 0) - law.subs(v, 0) * v) / v**2
        assert sp.simplify(mean - Q) == 0


@pytest.mark.slow
@pytest.mark.parametrize(("share", "blow"), [(0.98, 1.0), (0.95, 1.0), (0.95, 0.1)])
def test_decay_by_restitution(share, blow):
    """ln F falls by 0.26 (1 - e) per bead, within 5 %."""
    scene = struck(
        (1.0,), 100, velocities=(blow,), contact_sensors=(30, 80), samples=8001,
        duration=125.0 * blow**-0.2, damping=Damping("restitution", share),
    )  # fmt: skip
    run = simulate(scene)
    near, far = (measure(run.time, force).peak for force in run.contact_force)
    assert math.log(near / far) / 50 == pytest.approx(0.26 * (1 - share), rel=0.05)


@pytest.mark.parametrize(("kind", "power"), [("contact", 1), ("kuwabara_kono", -1)])
def test_speed_or_slowness_is_linear_in_damped_chains(kind, power):
    scene = struck(
        (1.0,), 160, duration=180.0, samples=9001, contact_sensors=range(30, 131, 20),
        damping=Damping(kind, 0.002),
    )  # fmt: skip
    run = simulate(scene)
    times = [measure(run.time, force).arrival for force in run.contact_force]
    slopes = np.diff(np.diff(times) ** -power)
    assert slopes[-1] == pytest.approx(slopes[0], rel=1e-3)
