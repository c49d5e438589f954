"""The derivation on SymPy's own polynomials instead of python-flint's: the same results."""

import pytest
import sympy as sp
from flint import fmpq
from sympy.polys.rings import ring as sympy_ring

import lwa.algebra.jets
from lwa import Cell, Dimer, homogenize


class Polynomial:
    """A SymPy PolyElement with the few methods of `flint.fmpq_mpoly` that the derivation uses."""

    def __init__(self, element):
        self.element = element

    def _other(self, other):
        if isinstance(other, Polynomial):
            return other.element
        if isinstance(other, fmpq):
            return self.element.ring.domain(int(other.p)) / self.element.ring.domain(int(other.q))
        return other

    def __add__(self, other):
        return Polynomial(self.element + self._other(other))

    def __sub__(self, other):
        return Polynomial(self.element - self._other(other))

    def __mul__(self, other):
        return Polynomial(self.element * self._other(other))

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other):
        return Polynomial(self._other(other) - self.element)

    def __neg__(self):
        return Polynomial(-self.element)

    def __pow__(self, n):
        return Polynomial(self.element**n)

    def __truediv__(self, other):
        if isinstance(other, Polynomial):
            return Polynomial(self.element.exquo(other.element))
        return Polynomial(self.element * (self.element.ring.domain(1) / self._other(other)))

    def __divmod__(self, other):
        quotient, remainder = self.element.div(other.element)
        return Polynomial(quotient), Polynomial(remainder)

    def is_zero(self):
        return not self.element

    def degrees(self):
        return [max(d, 0) for d in self.element.degrees()]

    def derivative(self, index):
        return Polynomial(self.element.diff(index))

    def terms(self):
        for exponents, c in self.element.terms():
            yield exponents, fmpq(int(c.numerator), int(c.denominator))


class Context:
    """A SymPy polynomial ring as `flint.fmpq_mpoly_ctx`."""

    def __init__(self, names):
        self.names = list(names)
        self.ring = sympy_ring(self.names, sp.QQ)[0]

    @classmethod
    def get(cls, names, ordering):
        return cls(names)

    def constant(self, value):
        return Polynomial(self.ring(Polynomial(self.ring(0))._other(value)))

    def gens(self):
        return [Polynomial(g) for g in self.ring.gens]

    def gen(self, index):
        return Polynomial(self.ring.gens[index])

    def variable_to_index(self, name):
        return self.names.index(name)

    def nvars(self):
        return len(self.names)


@pytest.mark.parametrize(
    ("cell", "closure", "field", "order"),
    [
        (Dimer("m1", "m2"), "linear", "first", 8),
        (Dimer("m1", "m2"), "full", "first", 6),
        (Cell([1, 2, 3], stiffnesses=["A1", "A1", "A2"]), "full", "center", 5),
    ],
)
def test_sympy_polynomials_give_the_same_theory(monkeypatch, cell, closure, field, order):
    flint = homogenize(cell, order, closure=closure, field=field)
    expected = flint.ansatz, {n: dict(found) for n, found in flint.pde.coefficients.items()}
    monkeypatch.setattr(lwa.algebra.jets, "fmpq_mpoly_ctx", Context)
    theory = homogenize(cell, order, closure=closure, field=field)
    assert isinstance(theory.closure.acceleration[-1], Polynomial)
    found = theory.ansatz, {n: dict(found) for n, found in theory.pde.coefficients.items()}
    assert found == expected
