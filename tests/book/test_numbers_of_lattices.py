"""Numbers and formulas of the pages on other lattices and of the appendix, computed again.

The numbers are read out of the pages: a number of the text that is changed turns a test red.
"""

import math
from itertools import chain

import pytest
import sympy as sp

from book.studies.links import CASES, links
from book.studies.shock import shock as driven
from book.studies.struck import struck
from lwa import Cell, Dimer, LoadedChain, Material, Power, Sphere, envelope, loaded_wave, shock
from tests.book.prose import bounds, said, told

k, m1, m2, F0, d = sp.symbols("k m1 m2 F0 d", positive=True)
HERTZ = Power("3/2")


def limited(page, words, *values):
    """The bounds of a sentence hold for these values, and are no larger than they need to be."""
    for text, several in zip(said(page, words), values, strict=True):
        assert bounds(several, text), f"{page}: {words}: {several} for {text}"


# --- the appendix: jets u_ij = ∂x^i ∂t^j u

JETS = {(i, j): sp.Symbol(f"u{i}{j}") for i in range(6) for j in range(6 - i)}
STRAIN = JETS[1, 0]


def total(expression, *axes):
    for axis in axes:
        expression = sum(
            expression.diff(u) * JETS[i + 1 - axis, j + axis]
            for (i, j), u in JETS.items()
            if i + j < 5
        )
    return expression


def euler_lagrange(density):
    return sp.expand(
        sum(
            (-1) ** (i + j) * total(density.diff(u), *[0] * i, *[1] * j)
            for (i, j), u in JETS.items()
            if i + j < 3
        )
    )


def test_terms_of_the_lagrangian():
    """Divergences, the term that is none, the two equal terms and the equation of the field."""
    a, W = (sp.Function(name)(STRAIN) for name in ("a", "W"))
    u_xx, u_xt, u_tt = JETS[2, 0], JETS[1, 1], JETS[0, 2]
    assert euler_lagrange(a * u_xx) == euler_lagrange(a * u_xt) == 0
    assert sp.expand(euler_lagrange(a * u_tt) - a.diff(STRAIN, 2) * (u_xt**2 - u_xx * u_tt)) == 0
    assert sp.expand(euler_lagrange(a * u_xt**2) - euler_lagrange(a * u_xx * u_tt)) == 0
    rest = JETS[0, 1] ** 2 / 2 - W + a * u_xx**2 / 2  # a stands for F'I
    flux = W.diff(STRAIN) + a * JETS[3, 0] + a.diff(STRAIN) * u_xx**2 / 2
    assert sp.expand(euler_lagrange(rest) + u_tt - total(flux, 0)) == 0


def test_the_first_integral():
    """Its derivative along the wave is v' times the integrated equation of the reduced density."""
    x, V, p0 = sp.symbols("x V p0")
    v, a, W = sp.Function("v")(x), sp.Function("a"), sp.Function("W")
    slope = v.diff(x)
    force = V**2 * v - W(p0 + v).diff(x) / slope + W(p0 + x).diff(x).subs(x, 0)
    inertia = (a(v) * slope).diff(x) - a(v).diff(x) / slope * slope**2 / 2
    integral = a(v) * slope**2 - V**2 * v**2 + 2 * (W(p0 + v) - v * W(p0 + x).diff(x).subs(x, 0))
    assert sp.simplify(integral.diff(x) - 2 * slope * (inertia - force)) == 0


def test_dispersion_of_two_springs():
    """A root of the determinant to the fourth order."""
    q, K1, K2 = sp.symbols("q K1 K2", positive=True)
    I = (K1**2 - K1 * K2 + K2**2) / (3 * (K1 + K2) ** 2)
    square = 2 * K1 * K2 / (K1 + K2) * (q**2 - I * q**4)
    determinant = square**2 - 2 * (K1 + K2) * square + 2 * K1 * K2 * (1 - sp.cos(2 * q))
    assert sp.simplify(sp.series(determinant, q, 0, 6).removeO()) == 0


def test_equal_beads_are_dark():
    K2, K3, K4 = (sp.ff(k, n) / sp.factorial(n) for n in (1, 2, 3))
    for kappa in (sp.pi / 3, sp.pi):
        s = sp.sin(kappa / 2) ** 2
        bracket = 3 * K2 * K4 - 2 * K3**2 * (1 + 1 / s)
        assert sp.simplify(bracket + k**2 * (k - 1) * (1 + (k - 1) / s) / 2) == 0
        found = envelope(Cell([1], spacing=1), law=Power(k), background=1, wavenumber=kappa)
        factor = sp.sqrt(K2) * (2 * sp.sin(kappa / 2)) ** 3 / (2 * K2**2)
        assert sp.simplify(found.nonlinearity / (factor * bracket)) == 1
        assert sp.simplify(found.dispersion / sp.sqrt(k)).is_negative


# --- modes


def test_formulas_of_a_breather():
    edge = envelope(Dimer(m1, m2), law=Power(k), precompression=F0)
    K2, K3, K4 = (sp.ff(k, n) / sp.factorial(n) * F0 ** (1 - n / k) for n in (1, 2, 3))
    W, one = sp.sqrt(2 * K2 / m2), edge.breather(detuning=d, kind="bright")
    for ours, expected in {
        edge.frequency: W,
        edge.dispersion: K2 / (2 * W * (m1 - m2)),
        edge.nonlinearity: (3 * K2 * K4 - 4 * K3**2) / (K2 * m2**2 * W),
        one.amplitude[1] ** 2: F0 ** (2 / k) * 32 * d / (k * (k - 1)),
        one.width**-2: 4 * d * W**2 * (m1 - m2) / K2,
        one.opening_detuning: k * (k - 1) / 32,
    }.items():
        assert sp.simplify(ours / expected) == 1


def test_the_experiment_of_the_breather():
    steel = Sphere("28.84e-3", "9.525e-3", Material(E="193e9", nu="0.3"))
    aluminium = Sphere("9.75e-3", "9.525e-3", Material(E="73.5e9", nu="0.33"))
    cell = Cell.of_spheres([steel, aluminium])
    (_, low), (edge, _) = LoadedChain(cell, HERTZ, 20).bands.edges() / (2000 * math.pi)
    assert told("modes", "edge of the optical band is # kHz", edge)
    assert told("modes", "Left, at # kHz", edge * (1 - 1 / 250))
    (shaken,) = said("modes", "is shaken at # kHz")
    assert low < float(shaken) < edge
    pair = envelope(cell, law=HERTZ, precompression=20).numeric()
    mean = float(pair.mean_strain[0] / pair.strains[0] * pair.static_compressions[0] / 4)
    swing = (1 - math.sqrt(1 - 4 * mean)) / (2 * mean)  # contacts open at 1 = s - mean s²
    assert told("modes", "the estimate is #", swing**2 * 3 / 128)


# --- links


@pytest.mark.slow
def test_errors_of_exact_waves():
    """Errors fall with the wave; the stated bounds of a wave cover its error."""
    rows = links().document()["rows"]
    by_case = {case: [row for row in rows if row["case"] == case] for case in CASES}
    on = [row for row in by_case["neighbours"] if row["ratio_value"] is not None]
    (off,) = (row for row in by_case["neighbours"] if row["ratio_value"] is None)
    squares = [[100 * row["square_error_value"] for row in some] for some in (on, [off])]
    limited("links", "is within # % up to $B = p_0$, and # % without load", *squares)
    widths = (100 * row["fwhm_error_value"] for row in (on[-1], off))
    assert told("links", "without load; the width is # % and # % off", *widths)
    for case, chains in CASES.items():
        for one, row in zip(chains(), by_case[case], strict=True):
            wave = loaded_wave(one.lattice, force=one.force, precompression=one.load)
            assert abs(math.sqrt(row["square_value"]) - float(wave.speed)) < wave.speed_error
            assert abs(row["fwhm_value"] - row["fwhm_theory_value"]) < wave.fwhm_error(row["of"])


@pytest.mark.slow
def test_errors_of_struck_lattices():
    def errors(chosen, *names):
        return [[100 * row[f"{name}_error_value"] for row in chosen] for name in names]

    rows = struck().document()["rows"]
    flat = [r for r in rows if r["case"] == "packings" and r["strain_value"] < 1.1e-3]
    across, along = ([r for r in flat if r["chain"] == name] for name in ("across", "along"))
    limited("links", "the speed is within # %. The width", *errors(flat, "speed"))
    words = "The width is # % off across the rows, as in a chain, and # %"
    assert told("links", words, errors(across, "fwhm")[0][0], errors(along, "fwhm")[0][0])
    mixed = [r for r in rows if r["chain"] == "δ^3/2, δ^1"]
    words = "within # % over almost four decades of the force, while the width is off by up to # %"
    limited("links", words, *errors(mixed, "speed", "fwhm"))
    forces = [r["force_value"] for r in mixed]
    assert 8e3 < max(forces) / min(forces) < 1e4
    rung = [r for r in rows if r["case"] == "resonators"]
    known = [r for r in rung if r["speed_error_value"] is not None]
    words = "the speed is within # % and the width within # % where"
    limited("links", words, *errors(known, "speed", "fwhm"))
    (least,) = said("links", r"is at least $# \cdot 2\pi V_s$")
    assert all((r in known) == (r["tuning_value"] >= float(least)) for r in rung)
    tuned, *beside = sorted(
        (abs(r["tuning_value"] - 1), r["ringing_value"]) for r in rung if r["chain"] == "m_r = 3/10"
    )
    assert min(ring for _, ring in beside[:2]) > 4 * tuned[1]


# --- shocks


def test_edges_of_a_shock():
    """El's integrals, their edges, the identity of Toda's contacts and the shock without load."""
    x, r = sp.symbols("x r", positive=True)
    for wave, primitive in (
        (2 * sp.sin(x / 2), -2 * sp.log(sp.cos(x / 4))),
        (2 * sp.sinh(x / 2), -2 * sp.log(sp.cosh(x / 4))),
    ):
        assert sp.simplify(primitive.diff(x) - (1 - wave.diff(x)) / wave) == 0
    q = 4 * sp.acosh(sp.sqrt(r))  # cosh²(q/4) = r
    found = shock(Cell([1], spacing=1), "2.8561", 1, law=HERTZ)  # (c₋/c₊)^4 = 1.3^4
    leading = 2 * sp.sinh(q / 2) / q
    assert float(found.leading_speed("dispersion") / leading.subs(r, 1.3)) == pytest.approx(
        1.5**0.5
    )
    (most,) = said("shocks", r"trailing edge up to $c_- = #\,c_+$")
    assert float(found.trailing_speed) == pytest.approx(1.5**0.5 * (2 - float(most)), rel=1e-12)
    theta = q / 2  # twice the piston's velocity: cosh θ = 2r - 1
    assert sp.simplify(sp.expand_trig(sp.cosh(theta)) - 2 * r + 1) == 0
    assert sp.simplify(sp.expand_trig(sp.sinh(theta)) / theta - sp.expand_trig(leading)) == 0
    bare = shock(Cell([1], spacing=1), 1, 0, law=HERTZ)
    assert float(bare.rise) == pytest.approx((12 / 2.5) ** 0.4, rel=1e-12)
    assert told("shocks", "for spheres #. There", bare.peak / bare.rise)


@pytest.mark.slow
def test_driven_chains():
    """The page's table, with the sentences about it."""
    chains = {"jumps": (3,)}, {"k": "3/2", "jumps": (2, 8)}, {"k": "3/2", "jumps": (1,), "ahead": 0}
    rows = [row for one in chains for row in driven(duration=300, **one).document()["rows"]]
    toda, powers = rows[0], rows[1:]

    def errors(rows, theory):
        return [[100 * row[f"{theory}_error_value"][n] for row in rows] for n in ("speed", "peak")]

    limited("shocks", "right within # % in speed and # % in strain", *errors(powers, "doubling"))
    (agreement,) = said("shocks", "rule, edge and lattice agree to # %")
    exact = *chain(*errors([toda], "doubling")), 100 * toda["dispersion_error_value"]["speed"]
    assert max(map(abs, exact)) < float(agreement)
    own = [[*chain(*errors(some, "canonical"))] for some in (powers, [toda])]
    limited("shocks", "up to # % for powers and # % for Toda's contacts", *own)
    slow = [
        -100 * row["dispersion_error_value"]["speed"]
        for n in (3, 8)
        for row in powers
        if row["law"] == "k = 3/2" and row["behind_value"] == n
    ]
    assert told("shocks", "it is # % too slow at $p_-/p_+ = 3$, # % at 8", *slow)
    loaded, bare = (
        [100 * r["plateau_error_value"] for r in part] for part in (rows[:-1], rows[-1:])
    )
    limited("shocks", "under a load is right within # %", loaded)
    assert told("shocks", "the plateau's strain is # % below", *(-error for error in bare))
