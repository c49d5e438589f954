"""Identities of symbolic expressions."""

import sympy as sp


def same(left, right):
    """Whether two expressions agree to 30 digits where their symbols are fractions of primes.

    Analytic functions that differ agree at a point only by chance, and no formula of the tests has
    these primes; SymPy's `simplify` may take a second, or fail, where this takes milliseconds.
    """
    # Results and numbers of Python, no text from outside.
    pair = [sp.sympify(left), sp.sympify(right)]
    symbols = sorted(pair[0].free_symbols | pair[1].free_symbols, key=str)
    assert len({*map(str, symbols)}) == len(symbols), "two symbols of one name"
    point = {
        symbol: sp.Rational(sp.prime(9 + i), 19) for i, symbol in enumerate(symbols)
    }
    first, second = (sp.N(value.xreplace(point), 40) for value in pair)
    return bool(abs(first - second) < 1e-30 * max(1, abs(second)))
