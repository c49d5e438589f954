"""Exact waves on a background: the compact wave's end, KdV's, and the theory's errors between."""

import math

import pytest

from lwa import Cell, loaded_wave
from validation.waves.solver import exact_wave


def theory(p0, rise):
    return loaded_wave(Cell([1], spacing=1), rise=rise, background=p0, k="3/2")


def off(p0: float) -> tuple[float, float]:
    """c² and FWHM of the theory over the lattice's, less 1."""
    wave, found = exact_wave([1], 1.5, background=p0), theory(p0, 1 - p0)
    return float(found.speed) ** 2 / wave.c2 - 1, float(found.fwhm("strain")) / wave.fwhm() - 1


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
        wave, kdv = exact_wave([1], 1.5, background=1 - B), theory(1 - B, B).kdv
        excess = float(kdv.speed(B) / kdv.sound_speed) - 1
        width = 2 * math.acosh(math.sqrt(2)) * float(kdv.width(B))
        sound = math.sqrt(1.5 * math.sqrt(1 - B))
        errors.append(((wave.c / sound - 1) / excess - 1, wave.fwhm() / width - 1))
    for large, small in zip(*errors, strict=True):
        assert abs(small) < 1e-3
        assert large / small == pytest.approx(10, rel=0.1)
