"""Both closures, put into every equation of motion by code that shares nothing with them
but the rational numbers of FLINT.

The field is a power series in (x, D, τ) with rational coefficients, truncated; the theory's wave
equation gives its acceleration and the slaved fields the particles' motion; the lattice's equations
are then evaluated term by term. Where the contact exponent k is an odd integer everything stays
rational, so that zero means zero.
"""

import pytest
from flint import fmpq

from lwa import Cell, homogenize
from tests.lwa.series import rational

TAU = 2  # the second derivative in τ is wanted


class Series:
    """Σ c x^i D^j τ^l, truncated at i + j ≤ degree and l ≤ TAU."""

    def __init__(self, degree, terms=()):
        self.degree = degree
        self.terms = {e: c for e, c in dict(terms).items() if c and e[0] + e[1] <= degree}

    def __add__(self, other):
        terms = dict(self.terms)
        for e, c in other.terms.items():
            terms[e] = terms.get(e, 0) + c
        return Series(min(self.degree, other.degree), terms)

    def __sub__(self, other):
        return self + other * fmpq(-1)

    def __mul__(self, other):
        if not isinstance(other, Series):
            return Series(self.degree, {e: c * other for e, c in self.terms.items()})
        degree = min(self.degree, other.degree)
        terms = {}
        for (i, j, m), a in self.terms.items():
            for (p, q, n), b in other.terms.items():
                if i + j + p + q <= degree and m + n <= TAU:
                    e = (i + p, j + q, m + n)
                    terms[e] = terms.get(e, 0) + a * b
        return Series(degree, terms)

    def __pow__(self, n):
        result = Series(self.degree, {(0, 0, 0): fmpq(1)})
        for _ in range(n):
            result = result * self
        return result

    def dx(self, times=1):
        """∂_x^times; each costs a degree."""
        if times == 0:
            return self
        terms = {(i - 1, j, m): c * i for (i, j, m), c in self.terms.items() if i}
        return Series(self.degree - 1, terms).dx(times - 1)

    def inverse(self):
        constant = self.terms[0, 0, 0]
        rest = Series(self.degree, {e: -c / constant for e, c in self.terms.items() if any(e)})
        result = power = Series(self.degree, {(0, 0, 0): fmpq(1)})
        for _ in range(self.degree + TAU):
            power = power * rest
            result = result + power
        return result * (1 / constant)

    def times_D(self, n):
        return Series(self.degree + n, {(i, j + n, m): c for (i, j, m), c in self.terms.items()})

    def over_D(self):
        assert all(j for _, j, _ in self.terms)
        return Series(self.degree - 1, {(i, j - 1, m): c for (i, j, m), c in self.terms.items()})

    def shifted(self, h):
        """f(x + hD)."""
        result = term = self
        for n in range(1, self.degree + 1):
            term = term.dx() * fmpq(h, n)
            result = result + term.times_D(n)
        return result

    def tau(self, m):
        """The coefficient of τ^m."""
        return Series(self.degree, {(i, j, 0): c for (i, j, n), c in self.terms.items() if n == m})

    def at_tau(self, m):
        """Times τ^m."""
        return Series(
            self.degree, {(i, j, n + m): c for (i, j, n), c in self.terms.items() if n + m <= TAU}
        )


class Jets:
    """r_n and s_i of a field and its velocity, as series over p: the slope, or the field itself."""

    def __init__(self, k, field, velocity, p):
        self.p, self.field, self.velocity = p, field, velocity
        self.inverse = p.inverse()
        self.scale = self.inverse ** ((k + 1) // 2)
        self.known = {}

    def sum(self, terms):
        """Σ coefficient · Π jets of one order."""
        total = Series(self.p.degree)
        for jet, coefficient in terms.items():
            product = Series(self.p.degree, {(0, 0, 0): rational(coefficient)})
            for i, e in jet.x:
                product = product * self("x", i) ** e
            for i, e in jet.t:
                product = product * self("t", i) ** e
            total = total + product
        return total

    def __call__(self, kind, i):
        if (kind, i) not in self.known:
            source = self.field if kind == "x" else self.velocity
            unit = self.inverse if kind == "x" else self.scale
            self.known[kind, i] = source.dx(i) * unit
        return self.known[kind, i]


def acceleration(equation, k, field, velocity, optical):
    """φ_ττ by a wave equation, {n: terms of D^{k+n}, optical: of D^n}."""
    jets = Jets(k, field, velocity, field if optical else field.dx())
    total = Series(field.degree, {(0, 0, 0): fmpq(-1)}) if optical else jets("x", 2)
    for n, terms in equation.items():
        if terms:
            total = total + jets.sum(terms).times_D(n if optical else n - 1)
    return jets.p**k * total


def slaved(theory, k, field, velocity):
    """The particles' fields: by the full closure, or the first and the linear ansatz."""
    if theory.closure.name == "linear":
        w = field
        for n, b in theory.ansatz.items():
            w = w + (field.dx(n) * rational(b)).times_D(n)
        return [field, w * rational(theory.amplitude_ratio)]
    jets, w = Jets(k, field, velocity, field.dx()), []
    for i in range(theory.cell.size):
        total = field
        for n, terms in theory.slaved.get(i, {}).items():
            if terms:
                total = total + (jets.p * jets.sum(terms)).times_D(n)
        w.append(total)
    return w


def residuals(theory, equation=None):
    """Residuals of the equations of motion at x = 0, by particle: at D^{k+1} … D^{k+order-1}, and
    on the optical branch, of the law δ^k without a bound, at D^0 … D^{order-1}."""
    cell, order, k, optical = theory.cell, theory.order, int(theory.k), not theory.pde.acoustic
    equation = theory.pde.coefficients if equation is None else equation
    P = cell.size
    degree = order + 6
    u = {(i, 0, 0): fmpq(c) for i, c in enumerate([3, 2, 1, -1, 2, 1, -2, 1, 3, -1, 2, 1, 1, -2])}
    v = {(i, 0, 0): fmpq(c) for i, c in enumerate([1, -1, 2, 1, 1, -3, 2, 1, -1, 1, 2, -1, 1, 1])}
    u, v = Series(degree, u), Series(degree, v)
    a = acceleration(equation, k, u, v, optical)
    # φ_τττ: the wave equation's own derivative along the motion (u + τv, v + τa)
    da = acceleration(equation, k, u + v.at_tau(1), v + a.at_tau(1), optical).tau(1)
    field = u + v.at_tau(1) + (a * fmpq(1, 2)).at_tau(2)
    velocity = v + a.at_tau(1) + (da * fmpq(1, 2)).at_tau(2)

    w = slaved(theory, k, field, velocity)
    strains = [w[i + 1] - w[i] for i in range(P - 1)] + [w[0].shifted(P) - w[-1]]
    if optical:
        force = [
            s.tau(0) ** k * rational(A) for s, A in zip(strains, cell.stiffnesses, strict=True)
        ]
    else:
        shares = [rational(c) for c in cell.shares(theory.k)]
        force = [s.over_D().tau(0) ** k * (1 / c**k) for s, c in zip(strains, shares, strict=True)]
    left = []
    for i in range(P):
        inertia = w[i].tau(2) * 2
        if optical:
            inertia = inertia * rational(cell.masses[i] * theory.pde.time_scale**2)
        else:
            inertia = inertia.times_D(1) * (P * k * rational(cell.fractions[i]))
        before = force[i - 1] if i else force[-1].shifted(-P)
        left.append(inertia - force[i] + before)
    assert all(residual.degree >= order - 1 for residual in left)
    return [[residual.terms.get((0, j, 0), 0) for j in range(order)] for residual in left]


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
def test_the_linear_closure_satisfies_the_first_equation_and_leaves_its_defect(k, cell, branch):
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
