"""Both closures, put into every equation of motion by code that shares nothing with them
but FLINT's rational polynomials.

The field is a power series in (x, D, τ) with rational coefficients, truncated; the theory's wave
equation gives its acceleration and the slaved fields the particles' motion; the lattice's equations
are then evaluated term by term. Where the contact exponent k is an odd integer everything stays
rational, so that zero means zero.
"""

import pytest
from flint import fmpq_mpoly_ctx

from lwa import Cell, homogenize
from tests.lwa.fields import rational

CONTEXT = fmpq_mpoly_ctx.get(("x", "D", "tau"), "lex")
X, D, TAU = CONTEXT.gens()
ONE = CONTEXT.constant(1)
DEGREE = 9
"""Degree in x and D to which products are known: D∂_x keeps it, and a bare derivative costs one."""


def product(*factors):
    """The product to x^i D^j, i + j ≤ DEGREE, and to τ², whose coefficient is wanted."""
    total = ONE
    for factor in factors:
        kept = {}
        for e, c in (total * factor).to_dict().items():
            if e[0] + e[1] <= DEGREE and e[2] <= 2:
                kept[e] = c
        total = CONTEXT.from_dict(kept)
    return total


def inverse(f):
    """1/f of a series whose constant term is not 0."""
    constant = f.to_dict()[0, 0, 0]
    total = ONE
    for _ in range(DEGREE + 2):
        total = ONE + product(ONE - f / constant, total)
    return total / constant


def shifted(f, h):
    """f(x + hD)."""
    return f.compose(X + h * D, D, TAU)


def tau(f, m):
    """The coefficient of τ^m."""
    terms = f.to_dict().items()
    return CONTEXT.from_dict({(i, j, 0): c for (i, j, n), c in terms if n == m})


class Jets:
    """r_n and s_i of a field and its velocity, as series over p: the slope, or the field itself."""

    def __init__(self, k, field, velocity, p):
        self.p = p
        self.units = {"x": inverse(p)}
        self.units["t"] = product(*[self.units["x"]] * ((k + 1) // 2))
        self.derivatives = {"x": [field], "t": [velocity]}

    def sum(self, terms):
        """Σ coefficient · Π jets of one order."""
        total = 0 * ONE
        for jet, coefficient in terms.items():
            factors = []
            for kind, powers in (("x", jet.x), ("t", jet.t)):
                for i, e in powers:
                    factors += [self.jet(kind, i)] * e
            total += rational(coefficient) * product(*factors)
        return total

    def jet(self, kind, i):
        derivatives = self.derivatives[kind]
        while len(derivatives) <= i:
            derivatives.append(derivatives[-1].derivative("x"))
        return product(derivatives[i], self.units[kind])


def acceleration(equation, k, field, velocity, optical):
    """φ_ττ by a wave equation, {n: terms of D^{k+n}, optical: of D^n}."""
    if optical:
        jets, total, D_below = Jets(k, field, velocity, field), -ONE, ONE
    else:
        jets = Jets(k, field, velocity, field.derivative("x"))
        total, D_below = jets.jet("x", 2), D
    for n, terms in equation.items():
        total += product(D**n / D_below, jets.sum(terms))
    return product(total, *[jets.p] * k)


def slaved(theory, k, field, velocity):
    """The particles' fields: by the full closure, or the first and the linear ansatz."""
    if theory.closure.name == "linear":
        second = slope = field
        for n, b in theory.ansatz.items():
            slope = slope.derivative("x")
            second += rational(b) * D**n * slope
        return [field, rational(theory.amplitude_ratio) * second]
    jets, fields = Jets(k, field, velocity, field.derivative("x")), []
    for i in range(theory.cell.size):
        total = 0 * ONE
        for n, terms in theory.slaved.get(i, {}).items():
            total += D**n * jets.sum(terms)
        fields.append(field + product(jets.p, total))
    return fields


def residuals(theory, equation):
    """Residuals of the equations of motion at x = 0, by particle: at D^{k+1} … D^{k+order-1}, and
    on the optical branch, of the law δ^k without a bound, at D^0 … D^{order-1}."""
    cell, k, optical = theory.cell, int(theory.k), not theory.pde.acoustic
    P = cell.size
    # any field and velocity with a slope and all higher derivatives
    u = 3 + sum((-1) ** i * (i % 3 + 1) * X**i for i in range(1, 13))
    v = 1 + sum((-1) ** (i // 2) * (i % 3 + 1) * X**i for i in range(1, 12))
    a = acceleration(equation, k, u, v, optical)
    # φ_τττ: the wave equation's own derivative along the motion (u + τv, v + τa)
    da = tau(acceleration(equation, k, u + v * TAU, v + a * TAU, optical), 1)
    w = slaved(theory, k, u + v * TAU + a * TAU**2 / 2, v + a * TAU + da * TAU**2 / 2)

    if optical:
        unit, stiffnesses = ONE, cell.stiffnesses
        masses = [m * theory.pde.time_scale**2 for m in cell.masses]
    else:
        unit, stiffnesses = D, [1 / c**k for c in cell.shares(theory.k)]
        masses = [P * k * fraction for fraction in cell.fractions]
    forces, left = [], []
    for here, there, A in zip(w, [*w[1:], shifted(w[0], P)], stiffnesses, strict=True):
        strain = tau(there - here, 0) / unit
        forces.append(rational(A) * product(*[strain] * k))
    for i, mass in enumerate(masses):
        before = forces[i - 1] if i else shifted(forces[-1], -P)
        inertia = 2 * rational(mass) * tau(w[i], 2) * unit
        residual = (inertia - forces[i] + before).to_dict()
        left.append([residual.get((0, j, 0), 0) for j in range(theory.order)])
    return left


FIRST = {"closure": "full", "field": "first"}
CENTER = {"closure": "full", "field": "center"}
OPTICAL = {"branch": "optical"}


@pytest.mark.parametrize(
    ("k", "cell", "kind"),
    [
        (3, Cell([1]), FIRST),
        (3, Cell([3, 1], stiffnesses=[1, 8]), CENTER),
        (3, Cell([1, 1, 4], stiffnesses=[1, 8, 27]), CENTER),
        (1, Cell([2, 1]), FIRST),
        (5, Cell([2, 1], stiffnesses=[1, 32]), FIRST),
        (3, Cell([3, 1], stiffnesses=[1, 8]), {}),
        (5, Cell([2, 3]), {}),
        (7, Cell([1, 1]), {}),
        (3, Cell([7, 2]), OPTICAL),
        (5, Cell([2, 3], [1, 3]), OPTICAL),
    ],
    ids=str,
)
def test_every_equation_of_motion_is_satisfied_but_for_the_defect(k, cell, kind):
    """With the defect taken off, the wave equation satisfies the second equation of motion."""
    # order 7 reaches D^{k+6}, where jets of the velocity stand in the fields and the wave equation
    order = 7 if kind in (FIRST, CENTER) else 6
    theory = homogenize(cell, order, k=k, **kind)
    first, *others = residuals(theory, theory.pde.coefficients)
    assert first == [0] * order
    assert any(map(any, others)) == bool(theory.defect)
    if theory.defect:
        assert theory.closure.name == "linear"
        corrected = {n: dict(terms) for n, terms in theory.pde.coefficients.items()}
        for n, terms in theory.defect.items():
            # b_n is chosen so that the equations agree at the n-th derivative of the base
            assert ((n + theory.closure.model.base, 1),) not in terms
            for jet, c in terms.items():
                corrected[n][jet] = corrected[n].get(jet, 0) - c
        assert residuals(theory, corrected)[1] == [0] * order
