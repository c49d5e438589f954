"""Power series as lists of exact coefficients."""

from fractions import Fraction
from math import factorial

from flint import fmpq


def fraction(value):
    """A SymPy rational as Python's."""
    return Fraction(int(value.p), int(value.q))


def rational(value):
    """A SymPy rational as FLINT's."""
    return fmpq(int(value.p), int(value.q))


def exponential(rate, order):
    """exp(rate x)."""
    return [Fraction(rate) ** n / factorial(n) for n in range(order + 1)]


def product(a, b, order):
    """a b, cut after x^order."""
    return [sum((a[i] * b[n - i] for i in range(n + 1)), Fraction(0)) for n in range(order + 1)]
