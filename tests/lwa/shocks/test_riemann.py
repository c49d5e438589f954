"""The Riemann problem: exact edges, Toda, KdV, hard spheres, other cells, units."""

import pytest
import scipy
import sympy as sp

from lwa import Cell, Power, piston, shock
from lwa.law import named
from tests.identity import same

EQUAL = Cell([1], spacing=1)
HERTZ = Power("3/2")
TODA = named("exponential", 1)
SLOW = pytest.mark.slow


def test_edges_of_equal_beads_solve_els_equations():
    """∫ (1 - f′)/f dκ up to the edge is ln r, likewise at imaginary κ; k = 3 has r = p₋/p₊."""
    # ∫ (1 - f′)/f = -2 ln cos κ/4 of f = 2 sin κ/2, ∫ (f̃′ - 1)/f̃ = 2 ln cosh q/4 of 2 sinh q/2
    for r in map(sp.Rational, ("11/10", "5/4")):
        front = shock(EQUAL, r, 1, k=3)
        trailing = front.trailing_speed / front.sound(r)
        leading = front.leading_speed("dispersion") / front.sound(1)
        kappa, q = 4 * sp.acos(1 / sp.sqrt(r)), 4 * sp.acosh(sp.sqrt(r))
        assert same(trailing, sp.cos(kappa / 2))
        assert same(leading, 2 * sp.sinh(q / 2) / q)


def test_a_toda_soliton_on_els_edge_moves_its_beads_at_twice_the_wall():
    """e^{δ-p} - 1 = sinh²κ sech²(κn - c₊ t sinh κ), beads at 2 c₊ (cosh κ - 1) (Toda 1967).

    El's edge has the speed of κ = 2 arcosh √r, and v_p = 2 c₊ (r - 1) under F = e^δ - 1.
    """
    kappa = 2 * sp.acosh(sp.sqrt(sp.Rational(5, 4)))
    D = sp.S.Half
    found = shock(Cell([1], spacing=D), 2 * sp.log(sp.Rational(25, 16)), 0, law=TODA)
    assert same(found.ratio, sp.Rational(5, 4))
    assert same(found.plateau, D)  # c₊ is D
    true = D * sp.sinh(kappa) / kappa
    assert same(found.leading_speed("dispersion"), true)
    soliton = sp.log(1 + sp.sinh(kappa) ** 2) / D  # at its middle
    for name, known in (("leading_speed", true), ("peak", soliton)):
        ours = found.estimate(name)
        assert abs(ours.value - known) < ours.error


def test_plateau_and_rule_under_a_power_without_load():
    """B/p₋ = (8k/(k+1))^{1/(k+1)} and s₊/c₋ = 4/(k+1) (8k/(k+1))^{-1/(k+1)}; a contact's strain
    is B (1 - (k-1)/(2k(k+1)))."""
    k, p = sp.symbols("k p", positive=True)
    found = shock(EQUAL, p, 0, k=k)
    rise = (8 * k / (k + 1)) ** (1 / (k + 1))
    assert same(found.rise / p, rise)
    speed = found.leading_speed() / found.sound(p)
    assert same(speed, 4 / (k + 1) / rise)
    assert same(found.peak / found.rise, 1 - (k - 1) / (2 * k * (k + 1)))
    # The pulse on a small load is computed in numbers.
    for law in (HERTZ, Power(10)):
        loaded = shock(EQUAL, 1, "1e-14", law=law)
        bare = shock(EQUAL, 1, 0, law=law)
        assert float(loaded.peak) == pytest.approx(float(bare.peak), rel=1e-12)


@pytest.mark.parametrize(
    ("law", "ahead"),
    [
        (HERTZ, 1),
        (Power("1/2"), 1),
        (named("hertz2", 1, 1), 1),
        (named("magnetic", 3, 1), 0),
    ],
    ids=str,
)
def test_small_jumps_are_those_of_kdv(law, ahead):
    """The edges stand -1 and 2/3 of the jump of c off c₊ for r → 1, and the leading pulse at 2."""
    for digits in (6, 12):
        # under k = 1/2 sound is faster on a lower strain
        jump = sp.Rational(-1 if law == Power("1/2") else 1, 10**digits)
        found = shock(EQUAL, ahead + jump, ahead, law=law)
        c = sp.N(found.sound(ahead), 50)
        sound = sp.N(found.sound(ahead + jump), 50) / c - 1
        parts = {
            found.leading_speed(): sp.Rational(2, 3),
            found.leading_speed("dispersion"): sp.Rational(2, 3),
            found.trailing_speed: -1,
        }
        for speed, part in parts.items():
            assert abs(sp.N(speed, 60) / c - 1 - part * sound) < abs(sound) ** 2 + 1e-26
        assert found.rise == pytest.approx(2 * jump, rel=1e-5)
        assert found.peak - ahead == pytest.approx(2 * jump, rel=1e-5)


@pytest.mark.parametrize(
    ("k", "behind", "ahead"),
    [
        ("2.77", 1, 0),
        ("2.38", "36.3", 1),
        ("4.99", "0.785", "0.1"),
        ("3.1085", "1.501", "0.738"),
        # SymPy searched without end for the sign of the pulse's equation
        (3, 2, "9/5"),
    ],
)
def test_long_decimals_are_floats_of_thirty_digits(k, behind, ahead):
    """Exact powers of 277/100 hold integers beyond a float, at which SymPy stopped or hung."""
    found = shock(EQUAL, behind, ahead, law=Power(k))
    k, p, q = (float(sp.Rational(x)) for x in (k, behind, ahead))
    v = 2 * k**0.5 * (p ** ((k + 1) / 2) - q ** ((k + 1) / 2)) / (k + 1)
    assert float(found.plateau) == pytest.approx(v, rel=1e-13)
    assert float(found.rise * found.leading_speed()) == pytest.approx(2 * v, rel=1e-13)
    for name in ("leading_speed", "peak", "peak_force"):
        assert found.estimate(name).error > 0


@pytest.mark.parametrize(
    ("law", "behind", "ahead", "kind"),
    [
        (named("magnetic", "1.963", "2.091"), "0.392", "0.834", "rarefaction"),
        (named("exponential", "0.731"), "1.127", "0.738", "shock"),
        pytest.param(
            named("magnetic", "1.963", "2.091"), "0.834", "0.392", "shock", marks=SLOW
        ),
        pytest.param(
            named("hertz2", "1.037", "0.519"), "1.127", "0.738", "shock", marks=SLOW
        ),
    ],
)
def test_laws_without_closed_forms(law, behind, ahead, kind):
    """v_p by SciPy's quadrature, and the wall of this v_p again; a fit gives such decimals."""
    found = shock(EQUAL, behind, ahead, law=law)
    F = sp.lambdify(law.delta, law.slope(1))
    area, _ = scipy.integrate.quad(lambda p: F(p) ** 0.5, float(ahead), float(behind))
    assert float(found.plateau) == pytest.approx(area, rel=1e-10)
    assert found.kind == kind
    if kind == "shock":
        again = piston(EQUAL, found.plateau.n(25), ahead, law=law)
        assert float(again.behind) == pytest.approx(float(behind), rel=1e-12)
        edge = found.estimate("leading_speed", "dispersion")
        pulse = found.estimate("leading_speed")
        # covers what the doubling rule's error covers
        assert edge.error > 0.999 * (abs(edge.value - pulse.value) + pulse.error)
        W, B, p = sp.lambdify(law.delta, law.energy), float(found.rise), float(ahead)
        work = W(p + B) - W(p) - float(law.at(sp.Rational(ahead))) * B
        assert work == pytest.approx(2 * area**2, rel=1e-10)  # the rule's equation


@pytest.mark.parametrize("cell", [EQUAL, Cell(["m"])], ids=str)
def test_the_opposite_jump_is_a_rarefaction(cell):
    found = shock(cell, 1, 2, law=HERTZ)
    assert found.kind == "rarefaction"
    assert found.trailing_speed == found.sound(found.behind)
    ahead = found.sound(found.ahead)
    assert found.leading_speed() == found.leading_speed("dispersion") == ahead
    assert found.plateau.subs({"m": 1, "D": 1}) < 0
