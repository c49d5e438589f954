"""The dispersion relation against the wave equation, the chain's own matrices and closed forms.

The exact parts are compared exactly; each numerical bound says where it comes from. A singular
value is good to some 1e-16 of the largest, which for these cells is below 20.
"""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
import sympy as sp

from lwa import (
    Cell,
    Dimer,
    Dispersion,
    InputError,
    LoadedChain,
    Power,
    homogenize,
)
from lwa.law import named
from lwa.linear.springs import solved
from tests.lwa.linear.exact import squares

ROUNDING = 1e-13


@pytest.mark.parametrize("field", ["first", "center"])
@pytest.mark.parametrize(
    "cell",
    [
        Cell([3, 1]),
        Cell([2, 5], stiffnesses=[7, 2]),
        Cell([1, 2, 3]),
        Cell([2, 1, 4], stiffnesses=[3, 1, 2]),
    ],
    ids=str,
)
def test_the_linear_wave_equation_is_the_series_to_order_12(cell, field):
    pde = homogenize(cell, 12, k=1, closure="full", field=field).pde
    found = {2: sp.Integer(1)}
    for terms in pde.coefficients.values():
        for jet, coefficient in terms.items():
            assert not jet.t
            ((i, e),) = jet.x
            assert e == 1
            found[i] = coefficient * (-1) ** (i // 2 + 1)  # -Ω² = Σ coefficient (iκ)^i
    assert found == Dispersion(cell).acoustic(12)


@pytest.mark.parametrize("branch", ["acoustic", "optical"])
def test_the_linear_closure_of_a_dimer_is_exact_at_k_1(branch):
    """No defect is left, and the wave equation is the branch's series."""
    cell = Dimer("m1", "m2", stiffnesses=("A1", 2))
    theory = homogenize(cell, 6, k=1, branch=branch)
    assert theory.defect == {}
    series = Dispersion(cell).series(6)[branch]
    # Ω² of the optical branch in units of its own at κ = 0
    unit = series.get(0, sp.S.One)
    for n, terms in theory.pde.coefficients.items():
        i = n if branch == "optical" else n + 1  # -Ω² = Σ coefficient (iκ)^i
        found = sum(terms.values()) * (-1) ** (i // 2 + 1)
        assert sp.cancel(found - series.get(i, sp.S.Zero) / unit) == 0


def high_precision(cell, kappa):
    """Frequencies of all branches in the theory's units."""
    springs = [(i, i + 1, int(A)) for i, A in enumerate(cell.stiffnesses)]
    unit = mpmath.mpf(cell.time_scale(1) ** 2)
    found = squares([*map(int, cell.masses)], springs, kappa)
    return [float(mpmath.sqrt(square / unit)) for square in found]


@pytest.mark.parametrize(
    "cell",
    [
        Cell([3, 1], spacing=1),
        Cell([1, 2, 3], stiffnesses=[3, 1, 2], spacing=1),
        Cell([1, 1, 5, 2], stiffnesses=[1, 4, 1, 1], spacing=1),
    ],
    ids=str,
)
def test_bands_have_all_digits(cell):
    """Frequencies at any wavenumber, and the edges that hold all of them."""
    bands = Dispersion(cell).bands
    with mpmath.workdps(40):
        # Of a long wave eigenvalues Ω² would leave no digit.
        for kappa in (1e-8, 0.2, 1.3, -7):
            found = bands.branches(kappa)
            assert found == pytest.approx(high_precision(cell, kappa), abs=ROUNDING)
    # to the end of the zone and beyond
    inside = bands.branches(np.pi / cell.size * np.linspace(-2, 2, 401))
    low, high = bands.edges().T
    assert inside.min(axis=0) == pytest.approx(low, abs=ROUNDING)
    assert inside.max(axis=0) == pytest.approx(high, abs=ROUNDING)
    assert np.all(low[1:] > high[:-1])
    assert low[0] == 0
    with pytest.raises(InputError, match="finite numbers"):
        replace(bands, length=1e300).branches(1e300)


def test_springs_of_the_laws():
    """A_i F′ = k A_i^{1/k} F0^{1-1/k} of unlike contacts, and the bands of these springs."""
    masses, A, k, F0 = (1, 2, "1/2"), np.array([1.0, 3.0, 2.0]), 1.5, 0.7
    chain = LoadedChain(Cell(masses, A, 1), Power(k), F0)
    springs = k * A ** (1 / k) * F0 ** (1 - 1 / k)
    assert np.array(chain.spring_constants, float) == pytest.approx(springs, rel=1e-13)
    linear = LoadedChain(Cell(masses, springs, 1), Power(1), 1)
    q = np.linspace(-3, 3, 7)
    assert chain.bands.branches(q) == pytest.approx(linear.bands.branches(q), rel=1e-12)
    chain = LoadedChain(Cell([1], [3], 1), named("exponential", 2), 6)
    # (e^{2δ} - 1)/2 = 2, and A F′ = 3 e^{2δ} = 15
    assert chain.bands.edges()[0, 1] == pytest.approx(2 * np.sqrt(15), rel=1e-13)


def test_long_decimals():
    """Written out, the root of the speed would hold numbers beyond a double."""
    masses, k, F0 = (0.239655726292, 1.563930410198), 1.97, 1.2
    chain = LoadedChain(Cell(masses, spacing=1), Power(k), F0)
    speed = np.sqrt(2 * k * F0 ** (1 - 1 / k) / sum(masses))
    assert float(chain.sound_speed) == pytest.approx(speed, rel=1e-14)
    assert chain.bands.branches(1e-6)[0] == pytest.approx(speed * 1e-6, rel=1e-9)
    # of a surd
    k, D = 2.3206499799, sp.sqrt(6)
    scale = Cell([9], spacing=D).time_scale(k)
    assert float(scale) == pytest.approx(np.sqrt(k * float(D) ** (k + 1) / 9))


def test_a_singular_system_is_nan_beside_the_others():
    right = np.array([[2.0, 2.0]] * 3)
    found = solved(np.array([np.eye(2) / 4, np.ones((2, 2)), np.zeros((2, 2))]), right)
    assert np.array_equal(found[0], [8, 8])
    assert np.all(np.isnan(found[1:]))
