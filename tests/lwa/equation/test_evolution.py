"""The equation that can be integrated: its derivation, its energy, its waves."""

import pytest
import sympy as sp

from lwa import Cell, Dimer, Evolution, InputError, Power, background_wave, general, homogenize
from lwa.law import named
from tests.identity import same

x = sp.Symbol("x", real=True)
CELLS = {
    "symbols": Dimer("m1", "m2"),
    "equal": Cell([1]),
    "contacts": Cell([1, 1], [1, 8]),
    "three": Cell([1, 2, "1/3"]),
}


@pytest.mark.parametrize("name", [*CELLS, "any law"])
def test_the_equation_is_the_canonical_one_in_another_field(name):
    """(1 + I ∂²) ∂ F(u_x) to D²: I (F′ u_4x + 3 F″ u_xx u_xxx + F‴ u_xx³), in the jets."""
    k = sp.Integer(3) if name == "contacts" else sp.Symbol("k", positive=True)
    law, second, third = Power(k), k - 1, (k - 1) * (k - 2)
    if name == "any law":
        law, second, third = general(), *sp.symbols("phi2 phi3", real=True)
    cell = CELLS.get(name, CELLS["symbols"])
    theory = homogenize(cell, law=law, closure="full", field="center")
    I = theory.evolution.I / cell.spacing**2
    pde = theory.pde.in_field({2: I / 2})
    assert theory.evolution.time_scale == pde.time_scale
    for jet, value in {((2, 3),): third, ((2, 1), (3, 1)): 3 * second, ((4, 1),): 1}.items():
        assert same(pde.coefficients[3][jet], I * value)


@pytest.mark.parametrize("law", [Power("k"), named("exponential", 1)])
def test_the_energy_is_conserved(law):
    """∂_τ e is ∂_x of the flux u_τ (F + I u_xττ): for u_ττ free, by the equation."""
    evolution = Evolution(Cell([1], spacing=1), law)
    t = sp.Symbol("t", real=True)
    u = sp.Function("u")(x, t)
    p, v = u.diff(x), u.diff(t)
    F, W = (evolution.law.of_strain(p, sp.S.One, n) for n in (0, -1))
    density = v**2 / 2 + evolution.I * v.diff(x) ** 2 / 2 + W
    flux = u.diff(t) * (F + evolution.I * u.diff(x, t, t))
    equation = u.diff(t, 2) - evolution.I * u.diff(x, 2, t, 2) - F.diff(x)
    assert sp.simplify(density.diff(t) - flux.diff(x) - u.diff(t) * equation) == 0


@pytest.mark.parametrize("k", ["6/5", "3"])
def test_the_wave_solves_the_equation(k):
    """V² v - I V² v″ = F(v), the equation integrated twice in ξ = x - V τ."""
    evolution = Evolution(Dimer(1, "1/3", spacing=1), Power(k))
    V, v = evolution.speed(2), evolution.profile(x, 2)
    rest = V**2 * (v - evolution.I * v.diff(x, 2)) - evolution.law.of_strain(v, sp.S.One, 0)
    for place in (0, "0.3", 1, 2):
        assert abs(rest.subs(x, sp.Rational(place)).n(30)) < 1e-25


def test_speeds_under_load_are_those_of_the_canonical_field():
    evolution = Evolution(Cell([1], spacing=1), Power("3/2"))
    ours = evolution.speed(2, p0=1)
    assert float(ours) == pytest.approx(
        float(background_wave(Cell([1], spacing=1), 1, law=Power("3/2")).speed(2))
    )
    assert float(evolution.speed(sp.Rational(1, 10**6), p0=1)) == pytest.approx(1, abs=1e-6)


def test_hertz_s_pulse_is_too_narrow():
    """FWHM of the strain 1.3991, 19 % less than the lattice's 1.7257."""
    v = Evolution(Cell([1], spacing=1), Power("3/2")).profile(x, 1)
    half = sp.nsolve(v - sp.Rational(1, 2), x, 0.7)
    assert float(2 * half) == pytest.approx(1.3991, abs=1e-4)


def test_the_optical_branch_and_profiles_of_other_laws_are_refused():
    with pytest.raises(InputError, match="belongs to the acoustic branch"):
        homogenize(Dimer(1, 2), branch="optical").evolution  # noqa: B018
    with pytest.raises(InputError, match="under a power law only"):
        Evolution(Cell([1]), named("exponential", 1)).profile(0, 1)
