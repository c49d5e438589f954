"""The late coefficients of c² of equal beads: a factorial over a power of a complex action.

On the scale ε ξ the leading order is log F = Φ/ε with p = Φ′, e^{-Φ} = 4 sinh²(p/2)/p². Small
perturbations with the wavenumber q obey sinh(q/2)/q = -sinh(p/2)/p and meet the wave at p = 2πi, so
that γ_n → Re[Σ_j S_j Γ(n-1-j)/A^{n-1-j}] with the action A = ∫ (q - p) dη from there to p = 0.
"""

import mpmath
import numpy as np
import pytest

from lwa import Cell, expand


def action(points=20001):
    """A by Simpson's rule along a path that leaves the imaginary axis, where q branches."""
    s = np.linspace(0, 1, points)
    p = 2j * np.pi * (1 - s) + 0.8 * np.sin(np.pi * s)
    height = np.full_like(p, -0.5)
    height[:-1] = -np.sinh(p[:-1] / 2) / p[:-1]
    q = 4j * np.pi - p  # next to 2πi the two roots lie opposite to each other
    for i in range(2, points):
        x = 2 * q[i - 1] - q[i - 2]
        for _ in range(5):
            change = np.cosh(x / 2) / (2 * x) - np.sinh(x / 2) / x**2
            x -= (np.sinh(x / 2) / x - height[i]) / change
        q[i] = x
    slope = np.full_like(p, -1 / 6)
    slope[:-1] = (2 / p[:-1] - 1 / np.tanh(p[:-1] / 2)) / p[:-1]
    values = (q - p) * slope * (0.8 * np.pi * np.cos(np.pi * s) - 2j * np.pi)
    weights = np.where(np.arange(points) % 2, 4, 2)
    weights[[0, -1]] = 1
    return (weights @ values) / (3 * (points - 1))


def terms(A, n, count):
    """The Γ(n-1-j)/A^{n-1-j} of γ_n, over the first one's magnitude."""
    first = mpmath.gamma(n - 1) / abs(A) ** (n - 1)
    return [
        complex(mpmath.gamma(n - 1 - j) / A ** (n - 1 - j) / first)
        for j in range(count)
    ]


@pytest.mark.slow
def test_the_late_coefficients_are_predicted_from_earlier_ones():
    A = action()
    assert abs(A.real) == pytest.approx(7.188366, abs=2e-4)
    assert abs(A.imag) == pytest.approx(3.493125, abs=2e-4)
    gamma = [
        mpmath.mpf(int(c.p)) / int(c.q) for c in expand(Cell([1]), 60).c2.coefficients
    ]
    exact = mpmath.mpc("7.188366011688", "3.493124850470")
    rows, heights = [], []
    for n in range(36, 61):
        factors = np.array(terms(exact, n, 3))
        rows.append(np.concatenate([factors.real, -factors.imag]))
        heights.append(float(gamma[n] * abs(exact) ** (n - 1) / mpmath.gamma(n - 1)))
    rows, heights = np.array(rows), np.array(heights)
    early = slice(0, 18)
    constants = np.linalg.lstsq(rows[early], heights[early])[0]
    late = np.abs(rows[18:] @ constants - heights[18:])
    assert late.max() < 2e-3 * np.abs(heights).max()
