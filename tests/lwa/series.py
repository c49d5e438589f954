"""Power series as lists: with exact coefficients, and by Cauchy's integral."""

from fractions import Fraction
from math import factorial

import mpmath
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


def taylor(f, order, points=64):
    """Taylor coefficients at 0 of a function that is real on the real axis.

    By Cauchy's integral over the upper half of a circle of radius 1/8; the error falls as the
    power `points` of 1/8 over the distance of the next singularity.
    """
    turns = [mpmath.mpf(2 * j + 1) / points for j in range(points // 2)]
    values = [f(mpmath.expjpi(turn) / 8) for turn in turns]
    return [
        mpmath.fsum((v * mpmath.expjpi(-n * t)).real for v, t in zip(values, turns, strict=True))
        * mpmath.mpf(2 * 8**n)
        / points
        for n in range(order + 1)
    ]
