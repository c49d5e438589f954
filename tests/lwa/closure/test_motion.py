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
        terms = (total * factor).to_dict().items()
        kept = {e: c for e, c in terms if e[0] + e[1] <= DEGREE and e[2] <= 2}
        total = CONTEXT.from_dict(kept)
    return total


def inverse(f):
    """1/f of a series whose constant term is not 0."""
    constant = f.to_dict()[0, 0, 0]
    total = ONE
    for _ in range(DEGREE + 2):
        total = ONE + product(ONE - f / constant, total)
    return total / constant


def dx(f, times=1):
    """∂_x^times f."""
    return dx(f.derivative("x"), times - 1) if times else f


def shifted(f, h):
    """f(x + hD)."""
    return f.compose(X + h * D, D, TAU)


def tau(f, m):
    """The coefficient of τ^m."""
    return CONTEXT.from_dict(
        {(i, j, 0): c for (i, j, n), c in f.to_dict().items() if n == m}
    )


class Jets:
    """r_n and s_i of a field and its velocity, as series over p: the slope, or the field itself."""

    def __init__(self, k, field, velocity, p):
        self.p, self.field, self.velocity = p, field, velocity
        self.inverse = inverse(p)
        self.scale = product(*[self.inverse] * ((k + 1) // 2))
        self.known = {}

    def sum(self, terms):
        """Σ coefficient · Π jets of one order."""
        total = 0 * ONE
        for jet, coefficient in terms.items():
            powers = [("x", *power) for power in jet.x] + [
                ("t", *power) for power in jet.t
            ]
            factors = [self(kind, i) for kind, i, e in powers for _ in range(e)]
            total += rational(coefficient) * product(*factors)
        return total

    def __call__(self, kind, i):
        if (kind, i) not in self.known:
            source = self.field if kind == "x" else self.velocity
            unit = self.inverse if kind == "x" else self.scale
            self.known[kind, i] = product(dx(source, i), unit)
        return self.known[kind, i]


def acceleration(equation, k, field, velocity, optical):
    """φ_ττ by a wave equation, {n: terms of D^{k+n}, optical: of D^n}."""
    jets = Jets(k, field, velocity, field if optical else dx(field))
    total = -ONE if optical else jets("x", 2)
    for n, terms in equation.items():
        total += product(D ** (n if optical else n - 1), jets.sum(terms))
    return product(total, *[jets.p] * k)


def slaved(theory, k, field, velocity):
    """The particles' fields: by the full closure, or the first and the linear ansatz."""
    if theory.closure.name == "linear":
        ansatz = sum(
            rational(b) * D**n * dx(field, n) for n, b in theory.ansatz.items()
        )
        return [field, rational(theory.amplitude_ratio) * (field + ansatz)]
    jets, w = Jets(k, field, velocity, dx(field)), []
    for i in range(theory.cell.size):
        orders = theory.slaved.get(i, {}).items()
        w.append(
            field
            + product(jets.p, sum(D**n * jets.sum(terms) for n, terms in orders) * ONE)
        )
    return w


def residuals(theory, equation=None):
    """Residuals of the equations of motion at x = 0, by particle: at D^{k+1} … D^{k+order-1}, and
    on the optical branch, of the law δ^k without a bound, at D^0 … D^{order-1}."""
    cell, order, k, optical = (
        theory.cell,
        theory.order,
        int(theory.k),
        not theory.pde.acoustic,
    )
    equation = theory.pde.coefficients if equation is None else equation
    P = cell.size
    u = sum(
        c * X**i for i, c in enumerate([3, 2, 1, -1, 2, 1, -2, 1, 3, -1, 2, 1, 1, -2])
    )
    v = sum(
        c * X**i for i, c in enumerate([1, -1, 2, 1, 1, -3, 2, 1, -1, 1, 2, -1, 1, 1])
    )
    a = acceleration(equation, k, u, v, optical)
    # φ_τττ: the wave equation's own derivative along the motion (u + τv, v + τa)
    da = tau(acceleration(equation, k, u + v * TAU, v + a * TAU, optical), 1)
    w = slaved(theory, k, u + v * TAU + a * TAU**2 / 2, v + a * TAU + da * TAU**2 / 2)

    strains = [w[i + 1] - w[i] for i in range(P - 1)] + [shifted(w[0], P) - w[-1]]
    units = cell.stiffnesses if optical else [1 / c**k for c in cell.shares(theory.k)]
    force = [
        rational(unit) * product(*[tau(s, 0) / (1 if optical else D)] * k)
        for s, unit in zip(strains, units, strict=True)
    ]
    left = []
    for i in range(P):
        mass = (
            cell.masses[i] * theory.pde.time_scale**2
            if optical
            else P * k * cell.fractions[i]
        )
        inertia = 2 * rational(mass) * tau(w[i], 2) * (1 if optical else D)
        before = force[i - 1] if i else shifted(force[-1], -P)
        left.append(inertia - force[i] + before)
    return [
        [residual.to_dict().get((0, j, 0), 0) for j in range(order)]
        for residual in left
    ]


@pytest.mark.parametrize(
    ("k", "cell", "field"),
    [
        (3, Cell([1]), "first"),
        (3, Cell([3, 1], stiffnesses=[1, 8]), "first"),
        (3, Cell([3, 1], stiffnesses=[1, 8]), "center"),
        (3, Cell([1, 1, 4], stiffnesses=[1, 8, 27]), "center"),
        (1, Cell([2, 1]), "first"),
        (5, Cell([2, 1]), "first"),
    ],
    ids=str,
)
def test_every_equation_of_motion_is_satisfied(k, cell, field):
    # order 7 reaches D^{k+6}, where jets of the velocity stand in the fields and the wave equation
    theory = homogenize(cell, 7, k=k, closure="full", field=field)
    assert theory.defect == {}
    assert residuals(theory) == [[0] * 7] * cell.size


@pytest.mark.parametrize(
    ("k", "cell", "branch"),
    [
        (3, Cell([7, 2]), "acoustic"),
        (3, Cell([3, 1], [1, 8]), "acoustic"),
        (5, Cell([2, 3]), "acoustic"),
        (7, Cell([1, 1]), "acoustic"),
        (3, Cell([7, 2]), "optical"),
        (5, Cell([2, 3], [1, 3]), "optical"),
    ],
)
def test_the_linear_closure_satisfies_the_first_equation_and_leaves_its_defect(
    k, cell, branch
):
    """With the defect taken off, the wave equation satisfies the second equation of motion."""
    theory = homogenize(cell, 6, k=k, branch=branch)
    first, second = residuals(theory)
    assert first == [0] * 6
    assert (second == [0] * 6) == (not theory.defect)
    other = {n: dict(terms) for n, terms in theory.pde.coefficients.items()}
    for n, terms in theory.defect.items():
        for jet, c in terms.items():
            other[n][jet] = other[n].get(jet, 0) - c
    assert residuals(theory, other)[1] == [0] * 6
