"""Exact waves by an own Newton solver, and the sums of the expansion beside them.

Equal beads have c² r = S * r^k for the strain r, in Fourier S = (sin(q/2)/(q/2))² (English & Pego
2005); with light beads that follow S is divided by 1 + ω cos²(q/2). Solved on cosine series, it
shares nothing with the expansion nor with `validation`, with whose waves it is compared.
"""

from contextlib import suppress
from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.optimize import brentq

from lwa import Cell, InputError, expand
from validation.waves.solver import exact_wave

WIDTHS = ("strain", "force", "velocity")
NAMES = ("c2", "momentum", "energy", "effective_mass")


@cache
def lattice(k, omega=0.0, points=300):
    """Values by name of the wave whose force peaks at 1; its places and forces.

    The velocity is the force's mean over one site, over c: c² s' = F(ξ - ½) - F(ξ + ½).
    """
    half = max(3.0, 8 / np.sqrt(k - 1)) if k < 1.5 else 4.0
    if k > 15:
        half, points = 2.0, 2 * points
    xi = np.linspace(0, half, points + 1)
    q = np.pi * np.arange(points + 1) / half
    waves = np.cos(np.outer(xi, q))
    trapezoid = np.ones(points + 1)
    trapezoid[[0, -1]] = 0.5
    analysis = 2 / points * trapezoid[:, None] * waves.T * trapezoid
    mean = np.sinc(q / 2 / np.pi)
    inertia = 1 + omega * np.cos(q / 2) ** 2
    step = waves @ ((mean**2 / inertia)[:, None] * analysis)
    r = np.exp(-3 * (k - 1) / k * xi**2)
    for _ in range(60):  # the iteration converges slowly, from far away
        r = step @ np.maximum(r, 0) ** k
        r /= r[0]
    for _ in range(6):
        push = np.maximum(r, 0) ** (k - 1)
        c2 = step[0] @ (push * r)
        jacobian = k * (step - np.outer(r, step[0])) * push - c2 * np.eye(points + 1)
        r = r - np.linalg.solve(jacobian, step @ (push * r) - c2 * r)
    force = np.maximum(r, 0) ** k
    c2 = step[0] @ force
    assert np.abs(step @ force - c2 * r).max() < 1e-14
    spectra = {"strain": analysis @ r, "force": analysis @ force}
    spectra["velocity"] = mean / inertia * spectra["force"] / np.sqrt(c2)

    def integral(values):
        return 2 * half / points * (trapezoid @ values)

    velocity = waves @ spectra["velocity"]
    elastic = integral(r * force) / (k + 1)
    kinetic = elastic * (k + 1) / 2  # the virial theorem
    values = {
        "c2": c2,
        "speed": np.sqrt(c2),
        "momentum": (1 + omega) * integral(velocity),
        "energy": kinetic + elastic,
    }
    values["effective_mass"] = values["momentum"] ** 2 / 2 / values["energy"]
    for name, spectrum in spectra.items():
        height = spectrum.sum() / 2
        values[name] = 2 * brentq(
            lambda x, s=spectrum, h=height: s @ np.cos(q * x) - h, 0, half, xtol=1e-15
        )
    if not omega:
        assert integral(velocity**2) / 2 == pytest.approx(kinetic, rel=1e-12)
    return values, xi, force


def series(expansion):
    """Series of all quantities of `lattice`, by the same names."""
    found = {name: getattr(expansion, name) for name in NAMES}
    return found | {name: expansion.fwhm(name) for name in WIDTHS}


@pytest.mark.parametrize("k", [1.04, 1.5, 8.0, 40.0])
def test_these_waves_are_exact(k):
    values, _, _ = lattice(k)
    finer, _, _ = lattice(k, points=400)
    for name, value in values.items():
        assert finer[name] == pytest.approx(value, rel=1e-11)
    if k < 8.5:
        other = exact_wave([1], k)
        assert other.c2 == pytest.approx(values["c2"], rel=1e-11)
        for name in WIDTHS:
            assert other.fwhm(name) == pytest.approx(values[name], rel=1e-10)


@pytest.mark.parametrize("k", ["1.1", "3/2", "4", "8", "20"])
def test_a_sum_is_right_within_its_error_or_refused(k):
    """At order 10 none is refused up to k = 8; c² is from k = 12 on."""
    values, _, _ = lattice(float(sp.Rational(k)))
    for order in (6, 10):
        rows = series(expand(Cell([1]), order, k=k))
        for name, row in list(rows.items()):
            with suppress(InputError):
                found = row.at()
                assert abs(found.value - values[name]) < found.error < found.value
                del rows[name]
    assert not rows or sp.Rational(k) > 8
    assert "c2" in rows or sp.Rational(k) < 12
