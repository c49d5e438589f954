"""Any contact law: a power gives the power's results, and other laws are compared with the chain's
difference equation, expanded independently."""

import pickle
from math import factorial

import numpy as np
import pytest
import sympy as sp
from flint import fmpq, fmpq_poly

from lwa import Cell, Dimer, Law, Power, general, homogenize, k
from lwa.law import NAMES, named, phi_symbol, read_law
from tests.identity import same
from tests.lwa.fields import of_fields, rational, right_side

x = sp.Symbol("x")


OF_POWER = {phi_symbol(n): sp.ff(k - 1, n - 1) for n in range(2, 8)}
"""The values of φ_2, φ_3, … for F = δ^k."""


@pytest.mark.parametrize(
    ("cell", "order", "kind"),
    [
        (Dimer("m1", "m2"), 7, {"closure": "full", "field": "first"}),
        (Dimer("m1", "m2"), 8, {}),
        (Cell([1, 2, 3]), 6, {"closure": "full", "field": "center"}),
    ],
)
def test_the_power_law_comes_back_at_every_order(cell, order, kind):
    power = homogenize(cell, order, **kind)
    found = homogenize(cell, order, law=general(), **kind)
    assert power.pde.conservative == found.pde.conservative
    pairs = [
        (power.pde.coefficients, found.pde.coefficients),
        (power.defect, found.defect),
        *zip(power.slaved.values(), found.slaved.values(), strict=True),
    ]
    if not power.defect:
        pairs.append((power.pde.energy, found.pde.energy))
    for old, new in pairs:
        assert old.keys() == new.keys()
        for n in old:
            for jet in {*old[n], *new[n]}:
                # A jet without a coefficient has a plain 0.
                again = sp.sympify(new[n].get(jet, 0)).xreplace(OF_POWER)
                assert same(old[n].get(jet, 0), again)


def force(law, strain):
    """The law at a strain that is a polynomial in D, by Taylor's theorem."""
    at = sp.Rational(int(strain[0].p), int(strain[0].q))
    slopes = (rational(sp.Rational(law.at(at, m))) for m in range(strain.degree() + 1))
    terms = [slope / factorial(m) for m, slope in enumerate(slopes)]
    return fmpq_poly(terms)(strain - strain[0])


def test_the_equal_chain_is_the_difference_of_shifted_fields():
    """[F((u(x+D) - u)/D) - F((u - u(x-D))/D)]/D at x = 0, D only in the shifts, to D^4."""
    law, order = named("hertz2", 2, "1/3"), 6
    jets = [0, 4, 1, -2, 3, 1, -1, 2, 5]  # ∂^n u at 0; u_x = 4 has a rational root
    ahead = fmpq_poly([fmpq(jets[n + 1], factorial(n + 1)) for n in range(order)])
    behind = ahead(fmpq_poly([0, -1]))
    expected = (force(law, ahead) - force(law, behind)).coeffs()[1:]
    pde = homogenize(Cell([1], spacing=1), order, law=law).pde
    u = sum(sp.Rational(c, sp.factorial(n)) * x**n for n, c in enumerate(jets))
    orders = (of_fields(pde, pde.coefficients[n], u, x) for n in range(2, order))
    found = [law.at(sp.S(4), 1) * jets[2], *(value.subs(x, 0) for value in orders)]
    assert list(map(rational, found)) == expected[: len(found)]
    assert sum(found) == right_side(pde, u, x).subs(x, 0)
    assert any(found[2::2])


def test_a_law_is_a_value():
    law, dimer = named("exponential", "a"), Dimer("m1", "m2")
    theory = homogenize(dimer, law=law)
    numbers = homogenize(Dimer(1, 3), law=named("exponential", 2))
    assert theory.at(a=2, m1=1, m2=3) == numbers
    assert theory.law.phi(3) == (law.symbols[0] * law.delta) ** 2
    softer = homogenize(dimer, law=named("polynomial", "a", 1)).at(a=-2)
    assert softer.law == named("polynomial", -2, 1)
    kept = pickle.loads(pickle.dumps(theory.at(a="1/2").law))
    assert (kept.text, repr(kept)) == ("exponential:1/2", "named('exponential', 1/2)")
    assert kept == Law(kept.F)


@pytest.mark.parametrize("name", NAMES)
def test_every_name_has_its_derivatives_and_energy(name):
    law = named(name)
    assert law.phi(2) != 0
    assert read_law(law.text, "law") == law
    if name != "general":
        assert same(law.energy.diff(law.delta), law.F)


def test_an_open_contact_carries_nothing():
    """Numbers, arrays and expressions; only laws with F′(0) > 0 also pull."""
    hertz, toda = named("hertz"), named("exponential", 1)
    assert hertz == Power("3/2")
    assert (hertz.at(-1), hertz.at(4), hertz.at(0.25, 1)) == (0, 8, sp.Rational(3, 4))
    assert named("hertz2", 1, 1).at(-2) == named("hertz2", 1, 1).at(-2, 1) == 0
    assert np.array_equal(hertz.at([[-1, 4], [0, 1]]), [[0, 8], [0, 1]])
    assert np.array_equal(Power(1).at([-1, 1], 1), [0, 1])
    assert toda.at(-1) == sp.exp(-1) - 1
    x = sp.Symbol("x", positive=True)
    assert Law(sp.sinh(x), x).at(2) == sp.sinh(2)  # in the law's own variable
    assert np.allclose(toda.at([-1.0, 1.0]), np.expm1([-1.0, 1.0]), rtol=1e-15)


def test_a_large_force_has_its_compression():
    law = named("hertz2", 4, 1)
    assert float(law.inverse(law.at(10**120))) == 1e120


def test_long_powers_of_a_law_are_not_written_out():
    """SymPy's search for their factors would take for ever."""
    n, d = 1234 / 99991, 2.123456789012345
    law = named("magnetic", "1234/99991", d)
    expected = n * (n + 1) / d**2 * (1 - 1.7 / d) ** (-n - 2)
    assert float(law.at(1.7, 2)) == pytest.approx(expected, rel=1e-14)
