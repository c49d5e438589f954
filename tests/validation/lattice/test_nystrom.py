"""The pairs' orders, in exact arithmetic: every condition of Hairer, Nørsett & Wanner, Solving
Ordinary Differential Equations I, II.14, from trees that are generated here."""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from math import isqrt

import pytest

from validation.lattice.schemes import RKN86


@cache
def trees(weight):
    """A force f(y) at time τ, differentiated: (powers of τ from v, trees of the forces in y), each
    force moves y by ∫ (τ - s) f ds. Of so many powers of τ altogether."""
    return [
        (power, children)
        for power in range(weight + 1)
        for children in forests(weight - power, weight - 2)
    ]


@cache
def forests(weight, largest):
    """Multisets of trees that bring so many powers of τ, two with every integral."""
    if weight == 0:
        return [()]
    return [
        (tree, *rest)
        for size in range(min(weight - 2, largest), -1, -1)
        for tree in trees(size)
        for rest in forests(weight - size - 2, size)
        if not rest
        or order(rest[0]) < size
        or trees(size).index(rest[0]) >= trees(size).index(tree)
    ]


def order(tree):
    power, children = tree
    return power + sum(order(child) + 2 for child in children)


@cache
def factor(tree):
    """C of C τ^n, which is what the tree is in the exact motion."""
    value = Fraction(1)
    for child in tree[1]:
        n = order(child)
        value *= factor(child) / ((n + 1) * (n + 2))
    return value


def stages(pair, tree):
    """The value of a tree in the stages."""
    c, (power, children) = nodes(pair), tree
    values = [x**power for x in c]
    for child in children:
        inner = stages(pair, child)
        moved = [sum(a * f for a, f in zip(row, inner, strict=True)) for row in pair.rows]
        values = [x * y for x, y in zip(values, moved, strict=True)]
    return values


def nodes(pair):
    """c, exact: Σ a_ij = c²/2."""
    squares = [2 * sum(row) for row in pair.rows]
    roots = [Fraction(isqrt(x.numerator), isqrt(x.denominator)) for x in squares]
    assert [x * x for x in roots] == squares
    return roots


def misses(pair, weights, most, integrals):
    """Trees whose condition is missed, of all that count up to an order: 1 integral for v, 2 for
    y."""
    missed = []
    for n in range(most - integrals + 1):
        exact = Fraction(1, n + 1) / (n + 2 if integrals == 2 else 1)
        for tree in trees(n):
            found = sum(w * x for w, x in zip(weights, stages(pair, tree), strict=True))
            if found != exact * factor(tree):
                missed.append(tree)
    return missed


def test_the_trees():
    """Numbers of SN-trees: 1, 1, 2, 3, 6, 10, 20, 36 (Hairer, Nørsett & Wanner, table II.14.3)."""
    assert [len(trees(n)) for n in range(8)] == [1, 1, 2, 3, 6, 10, 20, 36]
    assert all(len(set(trees(n))) == len(trees(n)) for n in range(8))


@pytest.mark.parametrize("pair", [RKN86])
def test_the_order_of_both_solutions(pair):
    """The order of y and v, and no more; the last stage is the first one of the next step."""
    rows = ((pair.rows[-1], pair.speeds, pair.order), (pair.low, pair.low_speeds, pair.lower))
    for displacements, speeds, most in rows:
        assert not misses(pair, displacements, most, 2)
        assert not misses(pair, speeds, most, 1)
        assert misses(pair, displacements, most + 1, 2) or misses(pair, speeds, most + 1, 1)
    assert nodes(pair)[-1] == 1


def test_a_wrong_digit_is_found():
    wrong = [list(row) for row in RKN86.rows]
    wrong[4][2] += Fraction(1, 10**12)
    wrong[4][1] -= Fraction(1, 10**12)  # the node stays
    spoiled = replace(RKN86, rows=tuple(map(tuple, wrong)))
    assert misses(spoiled, spoiled.speeds, 8, 1)
