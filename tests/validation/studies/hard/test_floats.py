"""Losses in ulps: the measure itself, and that it sees every loss."""

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from lwa import Dimer, homogenize
from validation.studies.hard import floats
from validation.studies.hard.floats import (
    ALLOWED,
    CLOSURES,
    FORMS,
    PRINTED,
    closed_wave,
    exact,
    in_ulps,
    losses,
)


@pytest.fixture
def small(monkeypatch):
    """The corners of the grid, two points in its middle, and one without a wave."""
    monkeypatch.setattr(floats, "EXPONENTS", np.array([1 + 1e-6, 1.5, 3.0, 20.0]))
    monkeypatch.setattr(floats, "RATIOS", np.array([1e-6, 0.2733, 3.0, 1e6]))


def test_neighbours_are_one_ulp_apart_and_rounding_costs_half():
    x = np.array([1.0, -3.7, 1e-300, 2.0**-20])
    true = np.array([mp.mpf(float(value)) for value in x], object)
    assert in_ulps(x, true).tolist() == [0, 0, 0, 0]
    assert in_ulps(x + np.spacing(np.abs(x)), true).tolist() == [1, 1, 1, 1]
    with mp.workdps(50):
        third = np.array([mp.mpf(1) / 3], object)
    assert 0 < in_ulps(np.array([1 / 3]), third)[0] <= 0.5


def test_no_number_is_infinitely_wrong_and_no_wave_is_not_counted():
    true = np.array([mp.mpf(1), mp.mpf(1), mp.mpf(1), None], object)
    found = in_ulps(np.array([np.nan, np.inf, 1.0, np.nan]), true)
    assert np.isinf(found).tolist() == [True, True, False, False]
    loss = floats.Loss.of(found, np.ones(4), np.ones(4))
    assert (loss.points, loss.missing, loss.worst) == (3, 2, 0.0)
    assert np.isnan(found[3])


@pytest.mark.parametrize("closure", CLOSURES)
def test_the_reference_is_the_exact_wave_of_these_numbers(closure):
    """mpmath at the symbols' values, against SymPy with the values put in before the algebra."""
    k, omega = np.array([1.5, 2.5]), np.array([0.2733, 1.5])
    symbolic = closed_wave(closure)
    for name, (_, form) in FORMS.items():
        found = exact(symbolic, form(symbolic), k, omega)
        for i in range(2):
            cell = Dimer(1, sp.Rational(omega[i]), spacing=1)
            pde = homogenize(cell, k=sp.Rational(k[i]), **CLOSURES[closure]).pde
            number = sp.N(form(pde.traveling_wave()), 40)
            assert abs(sp.Float(found[i], 40) / number - 1) < sp.Float("1e-37"), name


def test_every_form_loses_little_and_the_printed_route_more(small):
    found = losses()
    assert {source for _, source in found} == {*CLOSURES, PRINTED}
    for (name, source), loss in found.items():
        if source != PRINTED:
            assert loss.missing == 0, (name, source)
            assert loss.worst <= ALLOWED, (name, source)
            if source == "paper's closure":
                assert 0 < np.count_nonzero(np.isnan(loss.ulps)) < loss.points
    # (k - 1)² is left of terms of order 1 at k = 1 + 1e-6: some 1e6 ulps are lost at least
    assert found["β", PRINTED].worst > 1e5
    assert found["β at k = 3/2", PRINTED].worst < 2 * ALLOWED


def test_an_error_of_a_few_ulps_is_seen(small, monkeypatch):
    def spoiled(f, k, w):
        return f.beta(k, w) * (1 + 20 * np.finfo(float).eps)

    monkeypatch.setattr(floats, "CLOSURES", {"full closure": CLOSURES["full closure"]})
    monkeypatch.setattr(floats, "FORMS", {**FORMS, "β": (spoiled, FORMS["β"][1])})
    monkeypatch.setattr(floats, "printed", lambda k, omega: {})
    monkeypatch.setattr(floats, "closed_wave", lambda name: closed_wave("full closure"))
    assert ALLOWED < losses()["β", "full closure"].worst < 50


def test_the_printed_route_is_the_same_theory():
    """Where nothing cancels both give the same numbers, to 1e-13 as some ten operations may."""
    k, omega = np.meshgrid([1.5, 2.0, 2.5], [0.1, 0.2733, 1.0])
    wave = closed_wave("paper's closure").numeric()
    for name, value in floats.printed(k, omega).items():
        np.testing.assert_allclose(value, FORMS[name][0](wave, k, omega), rtol=1e-13)
    ratios = np.array([0.01, 0.2733, 1.0, 30.0])
    beta = wave.beta(np.full(4, 1.5), ratios)
    np.testing.assert_allclose(floats.printed_hertz_beta(ratios), beta, rtol=1e-14)
