"""The periodic cell: equal forces, N:1 dimers, refusals."""

import pytest
import sympy as sp

from lwa import (
    Cell,
    Dimer,
    Dispersion,
    InputError,
    canonical_wave,
    expand,
    homogenize,
    loaded_wave,
)
from tests.identity import same


def test_shares_make_all_contact_forces_equal():
    A1, A2, A3, k = sp.symbols("A1 A2 A3 k", positive=True)
    cell = Cell([1, 1, 1], stiffnesses=[A1, A2, A3])
    shares = cell.shares(k)
    assert same(sum(shares), 3)
    for A, c in zip(cell.stiffnesses, shares, strict=True):
        # A_i c_i^k = A_eff, at numbers: sympy does not merge the powers of a sum
        numbers = {A1: 2, A2: 3, A3: 5, k: sp.Rational(3, 2)}
        assert abs(sp.N((A * c**k / cell.stiffness(k) - 1).subs(numbers), 40)) < 1e-35


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (dict(masses=[]), "at least one mass"),
        (dict(masses=[1, 0]), "mass 2 is 0"),
        (dict(masses=[1, 2], stiffnesses=[1]), "1 stiffnesses for 2 masses"),
        (dict(masses=[1, 2], spacing=0), "spacing is 0"),
        (dict(masses="m1,m2"), "a sequence"),
        (dict(masses={1, 2}), "a sequence"),
    ],
)
def test_impossible_cells_are_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        Cell(**arguments)


def test_the_N_to_one_dimer():
    assert Dimer("a", "b", N=3) == Cell(["a", "a", "a", "b"])
    for N in (0, 1.5):
        with pytest.raises(InputError, match="N is"):
            Dimer(1, 2, N=N)


def test_integers_that_python_cannot_print_are_refused():
    for call in (lambda n: Cell([1, n]), lambda n: homogenize(Dimer(1, 2), n)):
        with pytest.raises(InputError) as caught:
            call(10**5000)
        assert len(str(caught.value)) < 200


def test_exponents_and_numbers_out_of_range_are_refused():
    for exponent in ("1e-9", 1001):
        with pytest.raises(InputError, match="exponents from 1/100 to 1000"):
            Dispersion(Cell([1, 1], [1, 2]), exponent)


def test_omega_replaces_a_mass():
    m1, m2, omega = sp.symbols("m1 m2 omega", positive=True)
    assert Dimer(m1, m2, N=2).at(omega="w").masses[-1] == m1 * sp.Symbol("w", positive=True)
    assert Dimer(m1, m2).at(m2=6, omega=3).masses == (2, 6)
    assert Dimer(1, omega).at(omega=3).masses == (1, 3)  # a symbol of the caller's
    for cell, values in (
        (Cell([m1]), {"omega": 1}),
        (Cell([m1, m2, 3]), {"omega": 1}),
        (Dimer(m1, m2), {"m1": 1, "m2": 2, "omega": 2}),
        (Dimer(m1, m2), {"omega": -1}),
        (Dimer(m1, m2), {"m3": 1}),
    ):
        with pytest.raises(InputError):
            cell.at(**values)


@pytest.mark.parametrize("wrong", [None, [1, 2]])
@pytest.mark.parametrize(
    "call",
    [
        homogenize,
        canonical_wave,
        expand,
        loaded_wave,
        Dispersion,
        lambda x: canonical_wave(Cell([1]), k="3/2", law=x or 3),
    ],
)
def test_anything_else_than_a_cell_or_a_law_is_refused_in_one_line(call, wrong):
    with pytest.raises(InputError) as refused:
        call(wrong)
    assert "\n" not in str(refused.value)
