"""Frequencies of lattices of springs by mpmath, to all of its digits."""

import mpmath
import numpy as np


def squares(masses, springs, q):
    """Squared frequencies at the wavenumber q per spacing, ascending, of springs (i, j, K).

    Particles count on into the next cells; j is greater than i.
    """
    size = len(masses)
    K = mpmath.zeros(size)
    for i, j, spring in springs:
        b = mpmath.zeros(1, size)
        b[i] += 1
        b[j % size] -= mpmath.expj(q * (j - i))
        K += spring * b.H * b
    for i, j in np.ndindex(size, size):
        K[i, j] /= mpmath.sqrt(mpmath.mpf(masses[i]) * masses[j])
    return mpmath.eighe(K, eigvals_only=True)
