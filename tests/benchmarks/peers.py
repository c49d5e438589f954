"""The linear closure of the dimer as users of other computer algebra systems would derive it.

The strain p = u_x, its jets r_n = ∂_x^n p / p, k and b = m1/M are symbols, and

    ∂_x (p^k f) = p^k (k r_1 f + Σ_n ∂f/∂r_n (r_{n+1} - r_1 r_n))

is the chain rule. With w = u + Σ b_n D^n ∂_x^n u, b_1 = 1, the strains of the two contacts of a
cell over their common first term are

    1 + X = 1 + Σ b_{n+1} D^n r_n,    1 + Z = 1 + Σ (2^{n+1}/(n+1)! - b_{n+1}) D^n r_n

and their forces Y = (1 + X)^k and V = (1 + Z)^k, by n Y_n = Σ (k j - (n - j)) X_j Y_{n-j}. Where
u_ττ = p^k Σ D^{n-1} E_n, the equations of motion of the two particles are at each order

    2kb E_n = Y_n - Σ_j (-2)^j/j! ∂_x^j V_{n-j},
    2k(1 - b) (E_n + Σ_j b_j ∂_x^j E_{n-j}) = V_n - Y_n,

∂_x^j meaning p^{-k} ∂_x^j p^k. The new b_{n+1} makes them agree in the monomial r_n, where it
stands as ± 2k b_{n+1}; E_n is then read off the first.
"""

from __future__ import annotations

from math import factorial
from types import ModuleType
from typing import Any

Derived = tuple[list[Any], list[Any]]
"""E_0 … E_{order-1} and b_0 … b_order."""


def derive(cas: ModuleType, order: int) -> Derived:
    """The derivation in expressions of ``cas``, which is SymPy or SymEngine."""
    expand, Add, Rational = cas.expand, cas.Add, cas.Rational
    k, b = cas.symbols("k b")
    r = [cas.Integer(1), *cas.symbols(f"r1:{order + 1}")]
    image = [r[n + 1] - r[1] * r[n] for n in range(order)]
    k_r1 = k * r[1]

    def dx(rungs: list[list[Any]], n: int, j: int) -> Any:
        kept = rungs[n]
        while len(kept) <= j:
            f, jets = kept[-1], range(1, n + len(kept))
            kept.append(expand(Add(k_r1 * f, *[f.diff(r[m]) * image[m] for m in jets])))
        return kept[j]

    def known(X: list[Any], Y: list[list[Any]], n: int) -> Any:
        return Add(*[(k * j - (n - j)) * X[j] * Y[n - j][0] for j in range(1, n)]) / n

    zero, one = cas.Integer(0), cas.Integer(1)
    X, Y, Z, V, E, ansatz = [zero], [[one]], [zero], [[one]], [[zero]], [one, one]
    for n in range(1, order):
        y, v = known(X, Y, n), known(Z, V, n)
        both = Rational(2 ** (n + 1), factorial(n + 1))
        shifted = [
            Rational((-2) ** j, factorial(j)) * dx(V, n - j, j) for j in range(1, n + 1)
        ]
        # the right sides of both equations without b_{n+1}
        second = expand(v - y) + k * both * r[n]
        first = expand(-second - Add(*shifted))
        inertia = Add(*[ansatz[j] * dx(E, n - j, j).diff(r[n]) for j in range(1, n)])
        condition = (1 - b) * first.diff(r[n]) - b * second.diff(r[n])
        new = expand(-(condition + 2 * k * b * (1 - b) * inertia) / (2 * k))
        ansatz.append(new)
        X.append(new * r[n])
        Z.append((both - new) * r[n])
        Y.append([expand(y + k * X[n])])
        V.append([expand(v + k * Z[n])])
        E.append([expand((first + 2 * k * X[n]) / (2 * k * b))])
    return [rungs[0] for rungs in E], ansatz
