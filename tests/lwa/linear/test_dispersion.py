"""The dispersion relation against the chain's own matrices, closed forms and the wave equation.

The exact parts are compared exactly; each numerical bound says where it comes from. A singular
value is good to some 1e-16 of the largest, which for these cells is below 20.
"""

from math import factorial

import mpmath
import numpy as np
import pytest
import sympy as sp
from flint import fmpq, fmpq_poly
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy.polys.matrices import DomainMatrix

from lwa import Cell, Dimer, Dispersion, LoadedChain, Power, homogenize
from lwa.law import named
from tests.lwa.fields import rational

ROUNDING = 1e-13

values = st.fractions(min_value="1/9", max_value=9, max_denominator=9)


@st.composite
def cells(draw, sizes=(1, 2, 3, 4)):
    P = draw(st.sampled_from(sizes))
    masses = draw(st.lists(values, min_size=P, max_size=P))
    stiffnesses = draw(st.one_of(st.just(()), st.lists(values, min_size=P, max_size=P)))
    return Cell(masses, stiffnesses=stiffnesses)


@given(cells(sizes=(1, 2, 3, 4)), st.sampled_from([sp.S.One, sp.Rational(1, 2)]))
@settings(max_examples=12)
def test_acoustic_series_satisfies_the_chains_equations(cell, k):
    """det(K(κ) - Ω² M) Π c_i = T(Ω²) - 2 cos Pκ: SymPy's determinant of the P equations."""
    omega2, z = sp.symbols("omega2 z")
    P, c = cell.size, cell.shares(k)
    matrix = sp.zeros(P, P)
    for i in range(P):
        matrix[i, i] -= P * cell.fractions[i] * omega2
        j, phase = (i + 1, sp.S.One) if i < P - 1 else (0, z)
        matrix[i, i] += 1 / c[i]
        matrix[j, j] += 1 / c[i]
        matrix[i, j] -= phase / c[i]
        matrix[j, i] -= 1 / phase / c[i]
    exact = DomainMatrix.from_Matrix(matrix).to_field()
    determinant = exact.domain.to_sympy(exact.det()) * sp.prod(c)
    trace = sp.Poly(sp.cancel(determinant + z + 1 / z), omega2).all_coeffs()[::-1]
    order = 12
    series = Dispersion(cell, k).acoustic(order)
    branch = fmpq_poly(
        [rational(sp.sympify(series.get(n, 0))) for n in range(order + 1)]
    )
    found = fmpq_poly(list(map(rational, trace)))(branch)
    for n in range(order + 1):
        assert found[n] == (n % 2 == 0) * 2 * (-1) ** (n // 2) * fmpq(
            P**n, factorial(n)
        )


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
@pytest.mark.parametrize(
    ("cell", "order"),
    [
        (Dimer("m1", "m2", stiffnesses=("A1", 2)), 6),
        (Dimer(2, 5, stiffnesses=(7, 2)), 12),
    ],
    ids=str,
)
def test_the_linear_closure_of_a_dimer_is_exact_at_k_1(cell, order, branch):
    """No defect is left, and the wave equation is the branch's series."""
    optical = branch == "optical"
    chain, theory = Dispersion(cell), homogenize(cell, order, k=1, branch=branch)
    assert theory.defect == {}
    series = chain.optical(order) if optical else chain.acoustic(order)
    unit = (
        series[0] if optical else 1
    )  # Ω² of the optical branch in units of its own at κ = 0
    for n, terms in theory.pde.coefficients.items():
        i = n if optical else n + 1  # -Ω² = Σ coefficient (iκ)^i
        found = sum(terms.values()) * (-1) ** (i // 2 + 1)
        assert sp.cancel(found - sp.sympify(series.get(i, 0)) / unit) == 0


def test_long_waves_keep_their_digits():
    # Eigenvalues Ω² with an error of 1e-16 would leave nothing of Ω = 1e-8; the next term of the
    # series is below 1e-20.
    chain = Dispersion(Cell([1, 3, 2], stiffnesses=[1, 2, 3], spacing=1))
    kappa = np.array([1e-8, 1e-6, 1e-4])
    series = kappa * (1 - float(chain.I) * kappa**2 / 2)
    assert np.all(abs(chain.bands.branches(kappa)[:, 0] - series) < 1e-15)


def high_precision(cell, kappa, branch):
    """Ω by mpmath's Hermitian eigenvalues."""
    P = cell.size
    matrix = mpmath.matrix(P, P)
    for i, share in enumerate(cell.shares(sp.S.One)):
        j, phase = (i + 1, 1) if i < P - 1 else (0, mpmath.expj(P * kappa))
        spring = mpmath.mpf(share.q) / share.p
        matrix[i, i] += spring
        matrix[j, j] += spring
        matrix[i, j] -= spring * phase
        matrix[j, i] -= spring / phase
    root = [mpmath.sqrt(mpmath.mpf(P * x.p) / x.q) for x in cell.fractions]
    for i in range(P):
        for j in range(P):
            matrix[i, j] /= root[i] * root[j]
    return mpmath.sqrt(mpmath.eighe(matrix, eigvals_only=True)[branch])


CELLS = [
    Cell([3, 1]),
    Cell([1, 2, 3], stiffnesses=[3, 1, 2]),
    Cell([1, 1, 5, 2], stiffnesses=[1, 4, 1, 1]),
]


@pytest.mark.parametrize("cell", CELLS, ids=str)
def test_frequencies_have_all_digits(cell):
    chain = Dispersion(cell)
    with mpmath.workdps(40):
        for kappa in (0.2, 1.3, -7):
            for branch in range(cell.size):
                omega = high_precision(cell, kappa, branch)
                assert abs(chain.bands.branches(kappa)[branch] - omega) < ROUNDING


@given(cells(sizes=(1, 2, 3, 4, 5)))
@settings(max_examples=10)
def test_bands(cell):
    chain = Dispersion(cell)
    edges = chain.bands.edges()
    assert edges.shape == (cell.size, 2)
    inside = chain.bands.branches(np.linspace(-7, 7, 301))
    assert np.all(inside >= edges[:, 0] - ROUNDING)
    assert np.all(inside <= edges[:, 1] + ROUNDING)
    assert np.all(edges[1:, 0] - edges[:-1, 1] > -ROUNDING)
    # a zone is crossed in one direction, lowest branch upwards
    half = np.linspace(0, np.pi / cell.size, 50)
    direction = (-1.0) ** np.arange(cell.size)
    assert np.all(np.diff(chain.bands.branches(half), axis=0) * direction > -ROUNDING)


def test_springs_of_the_laws():
    """A_i F′ = k A_i^{1/k} F0^{1-1/k} of unlike contacts, and the bands of these springs."""
    masses, stiffnesses, k, F0 = (1, 2, "1/2"), np.array([1.0, 3.0, 2.0]), 1.5, 0.7
    chain = LoadedChain(Cell(masses, stiffnesses, 1), Power(k), F0)
    springs = k * stiffnesses ** (1 / k) * F0 ** (1 - 1 / k)
    assert np.array(chain.spring_constants, float) == pytest.approx(springs, rel=1e-13)
    linear = LoadedChain(Cell(masses, springs, 1), Power(1), 1)
    q = np.linspace(-3, 3, 7)
    assert chain.bands.branches(q) == pytest.approx(linear.bands.branches(q), rel=1e-12)
    law = named("exponential", 2)
    chain = LoadedChain(Cell([1], [3], 1), law, 6)
    # (e^{2δ} - 1)/2 = 2, and A F′ = 3 e^{2δ}
    assert float(chain.spring_constants[0]) == pytest.approx(15, rel=1e-14)
    assert chain.bands.edges()[0, 1] == pytest.approx(2 * np.sqrt(15), rel=1e-13)
