"""Waves on a static strain: limits, the canonical equation, the definitions at 120 digits."""

import pytest
import sympy as sp

from lwa import Cell, Dimer, KdV, Material, Power, Sphere, canonical_wave, loaded_wave
from lwa.law import named
from lwa.loaded.background import Background
from tests.identity import same

p0, k = sp.symbols("p0 k", positive=True)


def test_kdv_in_closed_form():
    field = Background(Dimer("m1", "m2"), Power("k"), "p0")
    c0 = p0 ** ((k - 1) / 2)
    expected = KdV(c0, (k - 1) * c0 / (2 * p0), field.I * c0 / 2)
    scaled = loaded_wave(field.cell, background="p0").kdv
    for name in ("sound_speed", "nonlinearity", "dispersion"):
        assert same(getattr(field.kdv, name), getattr(expected, name))
        assert same(getattr(scaled, name), getattr(expected, name) * field.time_scale)
    x, t = sp.symbols("x t", real=True)
    kdv = KdV(sp.Integer(3), sp.Rational(2, 5), sp.Rational(1, 7))
    v = 2 * sp.sech((x - kdv.speed(2) * t) / kdv.width(2)) ** 2
    left = v.diff(t) + 3 * v.diff(x) + 2 * v * v.diff(x) / 5 + v.diff(x, 3) / 7
    assert abs(left.subs({x: 1, t: sp.Rational(1, 3)}).n(30)) < 1e-25


def test_nesterenkos_relation_for_equal_spheres():
    """As Daraio, Nesterenko, Herbold and Jin print it, Phys. Rev. E 73, 026610 (2006), eqs. 3–5."""
    E, rho, a, F0, F = sp.symbols("E rho a F0 F", positive=True)
    bead = Sphere.solid(a / 2, Material(E=E, nu="3/10", density=rho))
    wave = canonical_wave(Cell.of_spheres([bead]), "3/2").at_force(F, precompression=F0)
    sound = (
        4 * E**2 * F0 / (a**2 * rho**3 * (1 - sp.Rational(9, 100)) ** 2)
    ) ** sp.Rational(1, 6)
    assert float(wave.sound_speed / sound) == pytest.approx(
        0.9314, abs=1e-4
    )  # printed, cut off
    ratio = (F / F0) ** sp.Rational(2, 3)
    square = sp.Rational(4, 15) * (3 + 2 * ratio ** sp.Rational(5, 2) - 5 * ratio)
    assert same((wave.speed / wave.sound_speed) ** 2, square / (ratio - 1) ** 2)


@pytest.mark.parametrize("cell", [Cell([1]), Dimer(1, 3, spacing=1)])
def test_a_law_that_is_no_power_has_waves_without_a_load(cell):
    """V² = 2W(δ)/δ² by the peak force; a light wave has the compact wave's width."""
    law = named("hertz2", 1, 1)
    wave = loaded_wave(cell, force=2, law=law)  # δ = 1
    # W = 2/5 + 2/7, and the mean mass is that of a bead
    square = 2 * sp.Rational(24, 35) * cell.spacing**2 * cell.size / cell.mass
    assert float(wave.speed**2 / square) == pytest.approx(1, rel=1e-14)
    assert wave.compression.is_Float  # the fraction of 35 digits is not shown
    assert float(wave.strain * cell.spacing) == pytest.approx(1, rel=1e-14)
    light = loaded_wave(cell, force="1e-30", law=law)
    width = canonical_wave(cell, "3/2").fwhm()
    assert float(light.fwhm("strain") / width) == pytest.approx(1, rel=1e-12)


def test_symbols_take_their_numbers():
    wave = canonical_wave(Cell(["m"]), "3/2").at_force("F", precompression="F0")
    known = loaded_wave(Cell([2], spacing=1), force=7, precompression=2, k="3/2")
    assert wave.at(m=2, F=7, F0=2, D=1) == known
    by_strain = canonical_wave(known.chain, "3/2").on_background(2, 7)
    assert by_strain == loaded_wave(known.chain, background=2, rise=7, k="3/2")
