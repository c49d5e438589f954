"""Breathers: they solve their equation; the gap breather of a dimer; where contacts open."""

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Dimer, InputError, Power, envelope
from lwa.law import named
from tests.identity import same

k, m1, m2, F0, X = sp.symbols("k m1 m2 F0 X", positive=True)
HERTZ = Power("3/2")


@pytest.mark.parametrize(
    ("chain", "kind"),
    [
        (envelope(Dimer(1, "1/2"), law=HERTZ, precompression=1), "bright"),
        (envelope(Cell([2], [3]), law=Power(2), precompression=1), "dark"),
        (envelope(Dimer(1, "1/2"), law=HERTZ, precompression=1, wavenumber=0), "dark"),
    ],
)
def test_the_profile_solves_the_equation(chain, kind):
    """Ω A + ½ω″A_XX = χ|A|²A for a f(bX), a from the amplitude of a bead."""
    found = chain.breather(detuning="1/200")
    assert found.kind == kind
    bead = max(range(chain.cell.size), key=lambda i: abs(float(chain.mode[i])))
    a = found.amplitude[bead] / (2 * chain.mode[bead])
    A = a * (sp.sech if kind == "bright" else sp.tanh)(X / found.width)
    rest = (found.frequency - chain.frequency) * A + chain.dispersion * A.diff(X, 2) / 2
    phase = sp.cos(chain.wavenumber * X)
    for place in (0.3, 1, 4):
        terms = [float(t.subs(X, place)) for t in (rest, chain.nonlinearity * A**3)]
        assert terms[0] == pytest.approx(terms[1], rel=1e-12)
        # The beads move along with the envelope.
        moved = found.displacements([place])[0]
        expected = 2 * float((A * phase).subs(X, place)) * np.array(chain.mode, float)
        assert moved == pytest.approx(expected, rel=1e-12)


def test_the_gap_breather_of_a_dimer():
    """U = δ0 √(32ν/(k(k-1))) of the light bead, whatever the masses; b² = 4νω²(m1 - m2)/K2."""
    chain = envelope(Dimer(m1, m2), law=Power("k"), precompression="F0")
    found = chain.breather(detuning="nu", kind="bright")
    static = F0 ** (1 / k)
    assert found.amplitude[0] == 0
    nu = sp.Symbol("nu", real=True)
    assert same(found.amplitude[1] ** 2, static**2 * 32 * nu / (k * (k - 1)))
    K2 = k * F0 ** (1 - 1 / k)
    assert same(1 / found.width**2, 4 * nu * chain.frequency**2 * (m1 - m2) / K2)
    assert same(found.opening_detuning, k * (k - 1) / 32)


def test_where_contacts_open_a_breather_is_refused_with_the_number():
    chain = envelope(Dimer(1, "1/2"), law=HERTZ, precompression=8)
    edge = chain.breather(detuning="3/128")
    assert float(edge.amplitude[1]) == pytest.approx(4, rel=1e-12)  # δ0
    refusal = r"^detuning 1 - f/f0 is 0\.025: contacts open from 0\.023438 on"
    for far in (
        {"detuning": "1/40"},
        {"frequency": chain.frequency * sp.Rational(39, 40)},
    ):
        with pytest.raises(InputError, match=refusal):
            chain.breather(**far)


def test_contacts_that_pull_do_not_open():
    """An exponential is a force at negative compressions, too; δ^{3/2} + δ^{5/2} is not."""
    chain = envelope(Cell([1], spacing=1), law=named("exponential", 1), background=0)
    assert chain.breather(detuning="1/2").opening_detuning == sp.oo
    with pytest.raises(
        InputError, match="a frequency is positive, and the detuning below 1"
    ):
        chain.breather(detuning="3/2")
    pushes = envelope(Cell([1], spacing=1), law=named("hertz2", 1, 1), background="1/2")
    found = pushes.breather(detuning="1/1000")
    assert 0.001 < found.opening_detuning < 1


def test_powers_of_a_decimal_exponent_are_not_factored():
    """As polynomials in p0^{1/1000} they have no end; 1/b = √(-ω″/(ωΔ)), ω″ = -ω/4 at κ = π."""
    equation = envelope(Cell(["m"]), k="1.963", background="1.536", wavenumber=sp.pi)
    found = equation.breather(detuning="1/9", kind="dark").width
    assert float(found) == pytest.approx(3 / 2, rel=1e-12)
