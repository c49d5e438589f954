"""Exact waves on a background: the compact wave's end, KdV's, and the theory's errors between."""

import math

import numpy as np
import pytest

from lwa import Cell, Power, background_wave
from tests.commands import ended
from validation import cli
from validation.waves.solver import exact_wave

THEORY = background_wave(Cell([1], spacing=1), law=Power("3/2"))


def off(p0: float) -> tuple[float, float]:
    """c² and FWHM of the theory over the lattice's, less 1."""
    wave, numeric = exact_wave([1], 1.5, background=p0), THEORY.numeric()
    c2 = 1.5 * numeric.speed_squared(p0, 1 - p0)
    return c2 / wave.c2 - 1, numeric.fwhm(p0, 1 - p0) / wave.fwhm() - 1


@pytest.mark.parametrize(
    ("ratio", "c2", "fwhm"),
    [(1e-9, -0.024, 0.048), (0.1, -0.014, 0.040), (1.0, -0.002, 0.017), (10.0, 0.0, 0.003)],
)
def test_the_errors_of_the_theory_on_a_background(ratio, c2, fwhm):
    """Errors at p0/B as the notes on the theory have them."""
    found = off(ratio / (1 + ratio))
    assert found == pytest.approx((c2, fwhm), abs=5.1e-4)
    if ratio == 10:
        assert abs(found[0]) < 1e-4


def test_without_a_load_it_is_the_compact_one():
    """c² = 0.8199588213 there, which it leaves in proportion to p0."""
    none = exact_wave([1], 1.5)
    assert none.c2 == pytest.approx(0.8199588213, abs=1e-10)
    assert exact_wave([1], 1.5, background=0).c2 == none.c2
    steps = [exact_wave([1], 1.5, background=p0).c2 - none.c2 for p0 in (1e-6, 1e-4)]
    assert steps[1] / steps[0] == pytest.approx(100, rel=0.02)  # the next term is √p0 of it
    light = exact_wave([1], 1.5, background=1e-8)
    for quantity in ("strain", "force", "velocity"):
        assert light.fwhm(quantity) == pytest.approx(none.fwhm(quantity), rel=1e-7)


def test_a_weak_wave_is_the_one_of_korteweg_and_de_vries():
    """Speed above that of sound, and width: what is left falls as B."""
    errors = []
    for B in (1e-2, 1e-3):
        wave, kdv = exact_wave([1], 1.5, background=1 - B), THEORY.on(1 - B).kdv
        excess = float(kdv.speed(B) / kdv.sound_speed) - 1
        width = 2 * math.acosh(math.sqrt(2)) * float(kdv.width(B))
        sound = math.sqrt(1.5 * math.sqrt(1 - B))
        errors.append(((wave.c / sound - 1) / excess - 1, wave.fwhm() / width - 1))
    for large, small in zip(*errors, strict=True):
        assert abs(small) < 1e-3
        assert large / small == pytest.approx(10, rel=0.1)


@pytest.mark.parametrize(("k", "p0"), [(1.01, 0.5), (1.5, 1 - 1e-4), (3.0, 1e-3), (6.0, 0.23)])
def test_the_equation_of_motion_holds(k, p0):
    """c² r'' = F(ξ+1) - 2F(ξ) + F(ξ-1), F = (p0 + r)^k, by finite differences of the wave."""
    wave = exact_wave([1], k, background=p0)
    assert wave.solitary
    assert wave.residual < 1e-14
    assert p0 + wave.peak("strain")[1] == pytest.approx(1, abs=1e-13)
    scale = wave.fwhm() / 30
    xi = np.linspace(0, wave.half_period / 2, 50)
    weights = np.array([2, -27, 270, -490, 270, -27, 2]) / 180
    curved = sum(
        w * wave.strain(xi + j * scale) for w, j in zip(weights, range(-3, 4), strict=True)
    )
    forces = [(p0 + wave.strain(xi + s)) ** k for s in (-1, 0, 1)]
    push = forces[0] - 2 * forces[1] + forces[2]
    assert wave.c2 * curved / scale**2 == pytest.approx(push, abs=2e-5 * np.abs(push).max())


def test_the_command(capsys):
    status, out, _ = ended(capsys, cli.main, "exact", "--background", "1/2")
    assert status == 0
    assert "background strain 0.5: strains and forces are above it" in out
    assert "c² = 1.22241250264" in out
    status, out, err = ended(capsys, cli.main, "exact", "--background", "2")
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
