"""The order of both solutions of the embedded pair, in exact arithmetic.

A step of the pair and the exact motion of a system y'' = f(y) are power series of the step h with
rational coefficients. Of a system with general derivatives they agree up to h^p only if every
condition of order p holds (Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I,
II.14), as a missed condition adds a term of its own to the difference.
"""

from fractions import Fraction
from math import isqrt

import flint

from validation.lattice.schemes import RKN86

H, SPEED = flint.fmpq_series([0, 1]), (1, -2, 3)
FORMS = (2, 1, -1), (1, -3, 2), (-1, 2, 1), (3, 1, 1)
WEIGHTS = (1, 2, -1, 1), (3, -1, 1, 2), (1, 1, -2, 5)


def combined(weights, terms):
    """Σ w x; FLINT has fractions of its own."""
    exact = (flint.fmpq(w.numerator, w.denominator) for w in weights)
    return sum((w * x for w, x in zip(exact, terms, strict=True)), 0 * H)


def force(y):
    """Sums of 1/(1 - a·y), whose derivatives of any order do not vanish."""
    poles = [1 / (1 - combined(form, y)) for form in FORMS]
    return [combined(row, poles) for row in WEIGHTS]


def motion():
    """Displacements and velocities of the exact motion, two orders more in each round."""
    y = [v * H for v in SPEED]
    for _ in range(6):
        speeds = [v + f.integral() for v, f in zip(SPEED, force(y), strict=True)]
        y = [v.integral() for v in speeds]
    return y + speeds


def order(pair, weights, speeds):
    """The order of a step with these weights of the stages."""
    beads = [(v, []) for v in SPEED]  # and the forces at the stages
    for row in pair.a:
        square = 2 * sum(row)
        c = flint.fmpq(isqrt(square.numerator), isqrt(square.denominator))
        assert c**2 == flint.fmpq(square.numerator, square.denominator)
        y = [H * (c * v + H * combined(row[: len(f)], f)) for v, f in beads]
        for (_, f), new in zip(beads, force(y), strict=True):
            f.append(new)
    ends = [H * (v + H * combined(weights, f)) for v, f in beads]
    ends += [v + H * combined(speeds, f) for v, f in beads]
    return min((a - b).valuation() for a, b in zip(ends, motion(), strict=True)) - 1


def test_the_order_of_both_solutions():
    """8 and 6, and no more; the last stage is the first one of the next step."""
    assert order(RKN86, RKN86.a[-1], RKN86.speeds) == RKN86.order
    assert order(RKN86, RKN86.low, RKN86.low_speeds) == RKN86.lower
    assert sum(RKN86.a[-1]) == Fraction(1, 2)
