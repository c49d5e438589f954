"""The slaved field on the lattice itself: how much fast oscillation a truncated ansatz leaves.

A ring of beads starts at rest with a long smooth wave in the heavy beads, u_x = 1 + a cos(qx), and
the light ones where the ansatz, cut off behind D^n, puts them. What the cut leaves out starts the
light beads' own fast motion, whose amplitude must fall as D^{n+1} at a given wave (here D = 1 and
the wave grows longer instead: amplitude · q ~ q^{n+1}). At rest all jets of the velocity vanish.

The fast motion is taken from the record of the light beads against the mean of their neighbours,
above the acoustic band, behind a window that keeps the slow motion below 1e-12 there.
"""

from functools import cache
from itertools import product

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from lwa import Dimer, homogenize

K, M1, M2, A = 1.5, 1.0, 0.25, 0.3
SIZES = (20, 28)  # cells in the ring, which is one wavelength
ORDERS = (2, 3, 4, 5)
MASSES = Dimer(sp.Rational(str(M1)), sp.Rational(str(M2)), spacing=1)


def wave(q, n, x):
    """∂_x^n u of u_x = 1 + a cos(qx), n ≥ 1, and u itself for n = 0."""
    if n == 0:
        return x + A * np.sin(q * x) / q
    return (n == 1) + A * q ** (n - 1) * np.cos(q * x + (n - 1) * np.pi / 2)


def slaved(theory, order, q, x):
    """w by the ansatz, cut off behind D^order."""
    p = wave(q, 1, x)
    w = wave(q, 0, x)
    if theory.closure.name == "linear":
        return w + sum(float(theory.ansatz[n]) * wave(q, n, x) for n in range(1, order + 1))
    for n in range(1, order + 1):
        for jet, coefficient in theory.slaved[1][n].items():
            if not jet.t:
                factors = [(wave(q, i, x) / p) ** e for i, e in jet.x]
                w = w + float(coefficient) * p * np.prod([1 + 0 * x, *factors], axis=0)
    return w


@cache
def fast_amplitudes(cells):
    """(closure, order) → root mean square of the light beads' motion above the acoustic band.

    The rings of all closures and orders move side by side.
    """
    length = 2.0 * cells
    q = 2 * np.pi / length
    x = 2.0 * np.arange(cells)
    theories = [homogenize(MASSES, 6, k=K, closure=closure) for closure in ("full", "linear")]
    kinds = list(product(theories, ORDERS))
    w = np.array([slaved(*kind, q, x) for kind in kinds])
    u = np.broadcast_to(wave(q, 0, x), w.shape)

    def beads_ahead(u):
        ahead = np.roll(u, -1, axis=1)
        ahead[:, -1] += length
        return ahead

    def equations(t, state):
        u, w, du, dw = state.reshape(4, *shape)
        right, left = (w - u) ** K, (beads_ahead(u) - w) ** K
        forces = (right - np.roll(left, 1, axis=1)) / M1, (left - right) / M2
        return np.concatenate((du, dw, *forces), axis=None)

    shape, time = w.shape, np.linspace(0, 40, 801)
    start = np.concatenate((u, w, 0 * u, 0 * w), axis=None)
    run = solve_ivp(equations, (0, 40), start, "DOP853", time, rtol=1e-12, atol=1e-13)
    assert run.success
    u, w, *_ = run.y.reshape(4, *shape, len(time))
    signal = (w - (u + beads_ahead(u)) / 2) * np.kaiser(len(time), 30)
    spectrum = np.fft.rfft(signal) / np.kaiser(len(time), 30).sum()
    frequency = 2 * np.pi * np.fft.rfftfreq(len(time), time[1])
    # the acoustic band ends at √(2k p^{k-1}/m1), the optical one starts at √(2k p^{k-1}/m2)
    band = frequency > np.sqrt(2 * K * np.sqrt((1 - A) / (M1 * M2)))
    fast = q * np.sqrt(np.mean(np.sum(np.abs(spectrum[..., band]) ** 2, axis=-1), axis=-1))
    return {(theory.closure.name, order): a for (theory, order), a in zip(kinds, fast, strict=True)}


def slope(closure, order):
    q = np.pi / np.array(SIZES)
    amplitudes = [fast_amplitudes(cells)[closure, order] for cells in SIZES]
    return np.polyfit(np.log(q), np.log(amplitudes), 1)[0]


@pytest.mark.parametrize("order", ORDERS)
def test_the_full_closure_leaves_D_to_the_n_plus_1(order):
    # a finite range of q bends the line by its next power; measured: 2.98, 4.00, 5.05, 6.02
    assert slope("full", order) == pytest.approx(order + 1, abs=0.1)


@pytest.mark.parametrize(("order", "power"), [(2, 3), (3, 4), (4, 4), (5, 4)])
def test_the_linear_closure_stops_improving_at_four(order, power):
    assert slope("linear", order) == pytest.approx(power, abs=0.1)
