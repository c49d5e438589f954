"""The proof of the relation of `lwa.links.wave`, step by step, on the jets of a field u(x, t).

A density is an expression in the symbols u_i_j for ∂_x^i ∂_t^j u; Euler's operator gives its
equation of motion, which is 0 for total derivatives.
"""

from itertools import pairwise

import sympy as sp

JETS = {(i, j): sp.Symbol(f"u_{i}_{j}") for i in range(7) for j in range(7)}
UX, UT, XX, XT, TT = (JETS[place] for place in ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2)))
S = sp.Symbol("s")
T, N, R, J, W, I = map(sp.Function, "TNRJWI")
FORCE, SLOPE = W(S).diff(S), W(S).diff(S, 2)
STATIC = UT**2 / 2 - W(UX)
"""The leading density, mean mass 1."""


def along(value, dx, dt):
    """Total derivative by x or t."""
    pairs = [(z, JETS[i + dx, j + dt]) for (i, j), z in JETS.items() if value.has(z)]
    return sum((value.diff(z) * raised for z, raised in pairs), sp.S.Zero)


def euler(density):
    result = sp.S.Zero
    for (i, j), z in JETS.items():
        if part := density.diff(z):
            for step in [(1, 0)] * i + [(0, 1)] * j:
                part = -along(part, *step)
            result += part
    return sp.expand(result.doit())


def at(value, place=UX):
    return value.subs(S, place).doit()


def test_one_derivative_more_can_be_removed():
    """a(u_x) u_xx and b(u_x) u_xt are derivatives, c(u_x) u_tt is none."""
    assert euler(T(UX) * XX) == euler(T(UX) * XT) == 0
    assert euler(T(UX) * TT) != 0
    assert euler(T(UX) * at(SLOPE) * XX) == 0


def test_a_change_of_the_field_adds_the_equation_of_motion():
    """u → u + change adds (F′ u_xx - u_tt) change, but for derivatives."""
    for change in (T(UX), N(UX) * XX, R(UX) * TT):
        varied = UT * along(change, 0, 1) - at(FORCE) * along(change, 1, 0)
        assert euler(varied - (at(SLOPE) * XX - TT) * change) == 0


def test_the_mixed_square_is_a_product():
    """T u_xt² is T u_xx u_tt but for derivatives, and u_xx u_tt is no derivative."""
    assert euler(T(UX) * XT**2 - T(UX) * XX * TT) == 0
    assert euler(N(UX) * XX * TT) != 0


def test_the_speed_knows_the_static_energy_alone():
    """First integral of a wave u_x = v_0 (x - ct) of the density with four free functions."""
    four = STATIC + (T(UX) * XT**2 + 2 * N(UX) * XX * TT + R(UX) * TT**2 + J(UX) * XX**2) / 2
    c, p0, v = sp.Symbol("c"), sp.Symbol("p0"), sp.symbols("v:6")

    def rate(value):
        return sum(value.diff(a) * b for a, b in pairwise(v))

    wave = {z: (-c) ** j * v[i + j - 1] for (i, j), z in JETS.items() if 0 < i + j < 7}
    motion = euler(four).subs(wave, simultaneous=True).doit()
    weight = J(v[0]) + c**2 * (T(v[0]) + 2 * N(v[0])) + c**4 * R(v[0])
    rise = v[0] - p0
    static = 2 * (W(v[0]) - W(p0) - at(FORCE, p0) * rise)
    first = weight * v[1] ** 2 - c**2 * rise**2 + static
    assert sp.expand((rate(sp.expand(rate(first) / (2 * v[1]))) - motion).doit()) == 0


def test_the_function_that_is_left_is_that_of_small_waves():
    """J = F′ I: the equation of the field, and its small waves Ω² = F′ (q² - I q⁴)."""
    weight = I(S) * SLOPE
    flux = at(FORCE) + at(weight) * JETS[3, 0] + at(weight.diff(S)) * XX**2 / 2
    equation = along(flux, 1, 0) - TT
    assert sp.expand((euler(STATIC + at(weight) * XX**2 / 2) - equation).doit()) == 0
    linear = {z: 0 for (i, j), z in JETS.items() if i + j == 3}
    small = at(SLOPE) * (XX + I(UX) * JETS[4, 0]) - TT
    rest = sp.expand((equation.subs(linear) - small).doit())
    assert rest.subs(XX, sp.Symbol("e") * XX).coeff(sp.Symbol("e"), 1) == 0
