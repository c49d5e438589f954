"""The Riemann problem: exact edges, Toda, KdV, hard spheres, other cells, units."""

import pytest
import scipy
import sympy as sp

from lwa import (
    Cell,
    Law,
    Power,
    piston,
    shock,
)
from lwa.law import DELTA, named
from lwa.loaded.background import Background
from lwa.shocks.waves import Pulse
from tests.identity import same

EQUAL = Cell([1], spacing=1)
HERTZ = Power("3/2")
TODA = named("exponential", 1)
BENT = named("polynomial", "1/2", "-1/4")  # F″ = 1 - 3δ/2
WAVY = Law(2 * DELTA + sp.sin(DELTA), DELTA)  # F″ = -sin δ


def test_edges_of_equal_beads_solve_els_equations():
    """∫ (1 - f′)/f dκ up to the edge is ln r, likewise at imaginary κ; k = 3 has r = p₋/p₊."""
    kappa, r = sp.symbols("kappa r", positive=True)
    f = 2 * sp.sin(kappa / 2)
    for sign, curve, speed in (
        (1, f, lambda q: sp.cos(q / 2)),
        (-1, 2 * sp.sinh(kappa / 2), lambda q: 2 * sp.sinh(q / 2) / q),
    ):
        # ∫ (1 - f′)/f = -2 ln cos κ/4, ∫ (f̃′ - 1)/f̃ = 2 ln cosh q/4
        primitive = -2 * sp.log(sp.cos(kappa / 4)) if sign > 0 else 2 * sp.log(sp.cosh(kappa / 4))
        rest = primitive.diff(kappa) - sign * (1 - curve.diff(kappa)) / curve
        assert abs(rest.subs(kappa, sp.Rational(6, 5)).n(30)) < 1e-25
        angle = 4 * (sp.acos(1 / sp.sqrt(r)) if sign > 0 else sp.acosh(sp.sqrt(r)))
        for value in map(sp.Rational, ("11/10", "5/4")):
            front = shock(EQUAL, value, 1, k=3)
            at = (
                (front.trailing_speed, front.behind)
                if sign > 0
                else (front.leading_speed("dispersion"), front.ahead)
            )
            ours = at[0] / front.sound(at[1])
            assert abs((speed(angle).subs(r, value) - ours).n(30)) < 1e-25


def test_a_toda_soliton_on_els_edge_moves_its_beads_at_twice_the_wall():
    """e^{δ-p} - 1 = sinh²κ sech²(κn - c₊ t sinh κ), beads at 2 c₊ (cosh κ - 1) (Toda 1967).

    El's edge has the speed of κ = 2 arcosh √r, and v_p = 2 c₊ (r - 1) under F = e^δ - 1.
    """
    r, n, t, c = sp.symbols("r n t c", positive=True)
    q = sp.Symbol("q", positive=True)
    factor = 1 + sp.sinh(q) ** 2 / sp.cosh(q * n - c * t * sp.sinh(q)) ** 2  # e^{δ-p}, c = e^{p/2}
    pushed = c**2 * (factor.subs(n, n - 1) - 2 * factor + factor.subs(n, n + 1))
    rest = sp.log(factor).diff(t, 2) - pushed
    place = {n: sp.Rational(1, 3), t: sp.Rational(2, 7), q: sp.Rational(6, 5), c: sp.Rational(3, 2)}
    assert abs(rest.subs(place).n(30)) < 1e-25
    kappa = 2 * sp.acosh(sp.sqrt(r))
    edge = sp.sqrt(r * (r - 1)) / sp.acosh(sp.sqrt(r))
    assert same(sp.sinh(kappa) / kappa, edge)
    assert same(2 * (sp.cosh(kappa) - 1), 4 * (r - 1))
    for D in (1, sp.Rational(1, 2)):
        found = shock(Cell([1], spacing=D), sp.log(sp.Rational(25, 16)) / D, 0, law=TODA)
        assert same(found.ratio, sp.Rational(5, 4))
        assert same(found.plateau, sp.S.Half)
        true = D * edge.subs(r, sp.Rational(5, 4))
        assert abs((found.leading_speed("dispersion") - true).n(30)) < 1e-25
        soliton = sp.log(1 + sp.sinh(kappa) ** 2).subs(r, sp.Rational(5, 4)) / D  # at its middle
        for name, ours, known in (
            ("doubling", found.leading_speed(), true),
            ("peak", found.peak, soliton),
        ):
            assert abs(float(ours / known) - 1) < found.errors[name]


def test_plateau_and_rule_under_a_power_without_load():
    """B/p₋ = (8k/(k+1))^{1/(k+1)} and s₊/c₋ = 4/(k+1) (8k/(k+1))^{-1/(k+1)}; a contact's strain
    is B (1 - (k-1)/(2k(k+1)))."""
    k = sp.Symbol("k", positive=True)
    found = shock(EQUAL, "p", 0, law=Power("k"))
    p = sp.Symbol("p", positive=True)
    rise = (8 * k / (k + 1)) ** (1 / (k + 1))
    for value in (sp.Rational(3, 2), 2, 5):
        numbers = {k: value, p: sp.Rational(1, 3)}
        speed, contact = found.leading_speed() / found.sound(p), 1 - (k - 1) / (2 * k * (k + 1))
        for ratio in (
            found.rise / p / rise,
            speed * rise * (k + 1) / 4,
            found.peak / p / rise / contact,
        ):
            assert float(ratio.subs(numbers)) == pytest.approx(1, rel=1e-12)


def test_a_contact_is_pressed_by_the_mean_of_the_slope_over_a_site():
    """u_x + D² u_xxx/24, with u_xxx at the peak from I F′ v′² = v² (Q(B) - Q(v)), I = 1/12."""
    field = Background(EQUAL, HERTZ, "2/3")
    w = sp.Rational(7, 10)
    pulse = Pulse(field, w)
    v, B = sp.Symbol("v", positive=True), pulse.rise
    square = (
        v**2 * (field.stiffness(B) - field.stiffness(v)) / (field.I * field.force(field.p0 + v, 1))
    )
    bend = square.diff(v).subs(v, B) / 2  # v″ = d(v′²)/dv / 2
    assert float(pulse.contact_rise) == pytest.approx(float(B + bend / 24), rel=1e-12)
    assert float(pulse.speed**2) == pytest.approx(float(field.stiffness(B)), rel=1e-12)


@pytest.mark.parametrize(
    ("law", "ahead"),
    [(HERTZ, 1), (Power("1/2"), 1), (named("hertz2", 1, 1), 1), (named("magnetic", 3, 1), 0)],
    ids=["hertz", "root", "hertz2", "magnets"],
)
def test_small_jumps_are_those_of_kdv(law, ahead):
    """The edges stand -1 and 2/3 of the jump of c off c₊ for r → 1, and the leading pulse at 2.

    Under k = 1/2 sound is faster on a lower
    strain: the strain of its shocks falls.
    """
    for digits in (6, 12):
        jump = sp.Rational(-1 if law == Power("1/2") else 1, 10**digits)
        found = shock(EQUAL, ahead + jump, ahead, law=law)
        c = sp.N(found.sound(ahead), 50)
        sound = sp.N(found.sound(ahead + jump), 50) / c - 1
        for speed, part in (
            (found.leading_speed(), sp.Rational(2, 3)),
            (found.leading_speed("dispersion"), sp.Rational(2, 3)),
            (found.trailing_speed, -1),
        ):
            assert abs(sp.N(speed, 60) / c - 1 - part * sound) < abs(sound) ** 2 + 1e-26
        assert found.rise == pytest.approx(2 * jump, rel=1e-5)
        assert found.peak - ahead == pytest.approx(2 * jump, rel=1e-5)


@pytest.mark.parametrize(
    ("k", "behind", "ahead"),
    [("2.77", 1, 0), ("2.38", "36.3", 1), ("4.99", "0.785", "0.1"), ("3.1085", "1.501", "0.738")],
)
def test_long_decimals_are_floats_of_thirty_digits(k, behind, ahead):
    """Exact powers of 277/100 hold integers beyond a float, at which SymPy stopped or hung."""
    found = shock(EQUAL, behind, ahead, law=Power(k))
    k, p, q = (float(sp.Rational(x)) for x in (k, behind, ahead))
    v = 2 * k**0.5 * (p ** ((k + 1) / 2) - q ** ((k + 1) / 2)) / (k + 1)
    assert float(found.plateau) == pytest.approx(v, rel=1e-13)
    assert float(found.rise * found.leading_speed()) == pytest.approx(2 * v, rel=1e-13)
    assert {"doubling", "peak", "peak_force"} <= {*found.errors}


@pytest.mark.parametrize(
    ("law", "behind", "ahead", "kind"),
    [
        (named("magnetic", "1.963", "2.091"), "0.392", "0.834", "rarefaction"),
        (named("magnetic", "1.963", "2.091"), "0.834", "0.392", "shock"),
        (named("hertz2", "1.037", "0.519"), "1.127", "0.738", "shock"),
    ],
)
def test_laws_of_three_decimals(law, behind, ahead, kind):
    """A fit gives such numbers; v_p by SciPy's quadrature, and the wall of this v_p again."""
    found = shock(EQUAL, behind, ahead, law=law)
    F = sp.lambdify(law.delta, law.slope(1))
    area, _ = scipy.integrate.quad(lambda p: F(p) ** 0.5, float(ahead), float(behind))
    assert float(found.plateau) == pytest.approx(area, rel=1e-10)
    assert found.kind == kind
    if kind == "shock":
        again = piston(EQUAL, found.plateau.n(25), ahead, law=law)
        assert float(again.behind) == pytest.approx(float(behind), rel=1e-12)
        assert {"doubling", "peak", "dispersion"} <= {*found.errors}


def test_a_law_without_closed_forms():
    """hertz2: v_p by SciPy's quadrature, and the rule's equation for B."""
    law = named("hertz2", 1, 1)
    found = shock(EQUAL, 2, 1, law=law)
    F = sp.lambdify(law.delta, law.slope(1))
    area, _ = scipy.integrate.quad(lambda p: F(p) ** 0.5, 1, 2)
    assert float(found.plateau) == pytest.approx(area, rel=1e-10)
    W = sp.lambdify(law.delta, law.energy)
    B = float(found.rise)
    work = W(1 + B) - W(1) - float(law.at(sp.S.One)) * B
    assert work == pytest.approx(2 * area**2, rel=1e-10)
    assert float(piston(EQUAL, found.plateau.n(25), 1, law=law).behind) == pytest.approx(
        2, rel=1e-12
    )


@pytest.mark.parametrize("cell", [EQUAL, Cell(["m"])], ids=str)
def test_the_opposite_jump_is_a_rarefaction(cell):
    found = shock(cell, 1, 2, law=HERTZ)
    assert found.kind == "rarefaction"
    assert found.trailing_speed == found.sound(found.behind)
    assert found.leading_speed() == found.leading_speed("dispersion") == found.sound(found.ahead)
    assert found.plateau.subs({"m": 1, "D": 1}) < 0


def test_si_units():
    """v ~ c p, F ~ A (D p)^k: a piston at the same v/c and p gives the same shape."""
    real = Cell(["1/2000"], ["1e9"], "1/200")
    scale = float(real.time_scale("3/2"))
    plain, found = (
        piston(EQUAL, 1, "1/2", law=HERTZ),
        piston(real, scale / 1.5**0.5, "1/2", law=HERTZ),
    )
    assert float(found.plateau) == pytest.approx(scale / 1.5**0.5, rel=1e-9)
    assert float(found.behind) == pytest.approx(float(plain.behind), rel=1e-9)
    ratio = float(found.leading_speed() / plain.leading_speed())
    assert ratio == pytest.approx(scale / 1.5**0.5, rel=1e-9)
    peak = 1e9 * (float(found.peak) / 200) ** 1.5
    assert float(found.peak_force) == pytest.approx(peak, rel=1e-9)
