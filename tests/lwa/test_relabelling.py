"""The same chain described from another particle, or backwards.

Naming the particles of a cell anew changes which field the wave equation is about. What a wave does
cannot depend on it: β, the speed and I must stay, and with the full closure's canonical field the
whole equation does. The paper's linear closure keeps I only.
"""

import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lwa import Cell, Dimer, homogenize

values = st.fractions(min_value="1/9", max_value=9, max_denominator=9)


def rotated(cell, n):
    masses, stiffnesses = cell.masses, cell.stiffnesses
    return Cell(masses[n:] + masses[:n], stiffnesses=stiffnesses[n:] + stiffnesses[:n])


def reflected(cell):
    # contact i joins particles i and i+1; backwards, the last contact of the cell comes last again
    inner, last = cell.stiffnesses[:-1], cell.stiffnesses[-1]
    return Cell(cell.masses[::-1], stiffnesses=(*inner[::-1], last))


def canonical(cell, order=4):
    return homogenize(cell, order, k="3/2", closure="full", field="center").pde


@given(st.lists(st.tuples(values, values), min_size=2, max_size=4), st.integers(1, 3))
@settings(max_examples=4)
def test_beta_speed_and_I_do_not_depend_on_the_labels(pairs, n):
    masses, stiffnesses = zip(*pairs, strict=True)
    cell = Cell(masses, stiffnesses=stiffnesses)
    wave = canonical(cell).traveling_wave()
    for other in (rotated(cell, n % cell.size), reflected(cell)):
        again = canonical(other).traveling_wave()
        for name in ("I", "beta", "speed_factor", "time_scale"):
            difference = sp.N(getattr(wave, name) - getattr(again, name), 30).subs(cell.spacing, 1)
            assert abs(sp.N(difference, 30)) < 1e-25  # shares are irrational: 30 digits less some


@given(st.lists(values, min_size=2, max_size=4), st.integers(1, 3))
@settings(max_examples=10)
def test_the_canonical_equation_is_the_same_from_every_particle(masses, n):
    cell = Cell(masses)
    pde, again = canonical(cell, 7), canonical(rotated(cell, n % cell.size), 7)
    assert {n: dict(found) for n, found in pde.coefficients.items()} == {
        n: dict(found) for n, found in again.coefficients.items()
    }


@given(st.lists(values, min_size=2, max_size=4))
@settings(max_examples=10)
def test_backwards_the_even_orders_change_sign(masses):
    cell = Cell(masses)
    pde, again = canonical(cell, 7), canonical(reflected(cell), 7)
    for n, found in pde.coefficients.items():
        sign = 1 if n % 2 else -1
        assert dict(found) == {jet: sign * c for jet, c in again.coefficients[n].items()}


def test_from_m2_the_full_closure_describes_another_field_of_the_same_wave():
    one, two = (
        homogenize(Dimer(*masses), 4, closure="full").pde for masses in (("m1", "m2"), ("m2", "m1"))
    )
    m1, m2 = one.cell.masses
    assert one.I == two.I
    assert sp.cancel(one.G - two.G) != 0
    # α = (1-b)(b-1/2) leads from each of them to the canonical field, b = m1/M or m2/M
    fields = []
    for pde, b in ((one, m1 / (m1 + m2)), (two, m2 / (m1 + m2))):
        fields.append(pde.in_field({2: (1 - b) * (b - sp.Rational(1, 2))}))
    assert sp.cancel(fields[0].G - fields[1].G) == 0
    assert sp.cancel(fields[0].H - fields[1].H) == 0


def test_the_linear_closure_depends_on_the_labels():
    """β D → √10/10 for m2 → 0, but √6/4 for m1 → 0, which is the same chain (k = 3/2)."""
    wave = homogenize(Dimer("m1", "m2"), k="3/2").pde.traveling_wave()
    w = sp.Symbol("w", positive=True)
    heavy_first = sp.limit(wave.at(m1=1, m2=w, D=1).beta, w, 0)
    light_first = sp.limit(wave.at(m1=w, m2=1, D=1).beta, w, 0)
    assert heavy_first == sp.sqrt(10) / 10
    assert light_first == sp.sqrt(6) / 4
    full = homogenize(Dimer("m1", "m2"), k="3/2", closure="full", field="center").pde
    beta = full.traveling_wave().at(D=1).beta
    m1, m2 = full.cell.masses
    assert sp.limit(beta.subs({m1: 1, m2: w}), w, 0) == sp.sqrt(10) / 10
    assert sp.limit(beta.subs({m1: w, m2: 1}), w, 0) == sp.sqrt(10) / 10
