"""Bands under a static load against closed forms and the chain's own linearisation."""

import numpy as np
import pytest

from lwa import Cell, InputError, Power
from lwa.law import general, named
from lwa.linear.dispersion import LoadedChain


def test_the_eigenvalues_of_a_ring_of_unlike_contacts():
    """Eight cells in a ring, linearised by differences of the force."""
    masses, stiffnesses, k, F0 = (1.0, 2.0, 0.5), (1.0, 3.0, 2.0), 1.5, 0.7
    chain = LoadedChain(Cell(masses, stiffnesses, 1), Power(k), F0)
    cells, P, h = 8, 3, 1e-6
    size = cells * P
    delta = (F0 / np.array(stiffnesses)) ** (1 / k)

    def forces(u):
        bends = np.tile(delta, cells) + u - np.roll(u, -1)
        push = np.tile(stiffnesses, cells) * bends**k
        return np.roll(push, 1) - push

    rows = [(forces(h * e) - forces(-h * e)) / (2 * h) for e in np.eye(size)]
    inertia = np.tile(masses, cells)
    omega2 = np.linalg.eigvals(-np.array(rows) / inertia[:, None]).real
    expected = np.sort(np.sqrt(np.maximum(omega2, 0)))
    q = 2 * np.pi * np.arange(cells) / size
    found = np.sort(chain.bands.branches(q).ravel())
    assert found == pytest.approx(expected, abs=1e-4)  # √ of the differences' 1e-9 at ω = 0
    edges = chain.bands.edges()
    assert np.all(edges[:, 0] <= edges[:, 1])


def test_another_law():
    law = named("exponential", 2)
    chain = LoadedChain(Cell([1], [3], 1), law, 6)
    # (e^{2δ} - 1)/2 = 2, and A F′ = 3 e^{2δ}
    assert float(chain.spring_constants[0]) == pytest.approx(15, rel=1e-14)
    assert chain.bands.edges()[0, 1] == pytest.approx(2 * np.sqrt(15), rel=1e-13)


def test_bad_arguments_are_refused():
    for make, reason in (
        (lambda: LoadedChain(Cell([1]), Power("3/2"), 0), "positive"),
        (lambda: LoadedChain(Cell(["m"]), Power("3/2"), 1).bands.edges(), "has no value"),
        (lambda: LoadedChain(Cell([1, 1], [1, 2]), general(), 1), "shares"),
    ):
        with pytest.raises(InputError, match=reason):
            make()
