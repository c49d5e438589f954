"""The float64 functions against 50 digits."""

import numpy as np
import pytest
import sympy as sp

from lwa import Dimer, NoSolitaryWave, canonical_wave, homogenize

WAVE = homogenize(Dimer("m1", "m2")).pde.traveling_wave()
NUMERIC = WAVE.numeric()
WAVES = {
    "paper": WAVE,
    "N = 3": canonical_wave(Dimer("m1", "m2", N=3)),
    "contacts": canonical_wave(Dimer("m1", "m2", stiffnesses=("A", "A"))),
}
"""Cells of two masses that are symbols."""


@pytest.mark.parametrize("name", WAVES)
def test_closed_forms_at_random_points_are_good_to_1e11(name):
    """Exponents from 1 + 1e-6 to 20, mass ratios over twelve decades, against 50 digits."""
    rng, checked, numeric = (
        np.random.default_rng(1),
        0,
        WAVES[name].numeric(missing="nan"),
    )
    k, w = 1 + 10 ** rng.uniform(-6, 1.3, 16), 10 ** rng.uniform(-6, 6, 16)
    found = {
        "beta": numeric.beta(k, w),
        "width": numeric.width(k, w),
        "force": numeric.fwhm(k, w, "force"),
        "speed": numeric.speed(k, w, 2.0),
        "log B": numeric.log_amplitude(k, w),
    }
    for i, (k_i, w_i) in enumerate(zip(k, w, strict=True)):
        try:
            at = WAVES[name].at(k=sp.Rational(k_i), m1=1, m2=sp.Rational(w_i), D=1)
        except NoSolitaryWave:
            assert np.isnan(found["beta"][i])
            continue
        if min(at.coefficient_sum, at.speed_factor) < 1e-3:  # the edge of the domain
            continue
        log_B = -sp.log(at.speed_factor) / (at.k - 1)
        exact = (at.beta, at.width, at.fwhm("force"), at.speed(2), log_B)
        for values, value in zip(found.values(), exact, strict=True):
            reference = sp.N(value, 50)
            assert abs(sp.Rational(float(values[i])) - reference) <= 1e-11 * abs(
                reference
            )
        checked += 1
    assert checked > 5


def test_mass_ratios_at_the_end_of_the_range_and_arrays():
    """At k = 3/2 the paper's β tends to √(3/8) and V² to 0 as ω → ∞."""
    assert float(NUMERIC.beta(1.5, 1e150)) == pytest.approx(np.sqrt(3 / 8), rel=1e-11)
    assert 0 < float(NUMERIC.speed(1.5, 1e150)) < 1e-149
    k, w = np.array([[1.25], [1.5]]), np.array([0.1, 1.0, 10.0])
    beta = NUMERIC.beta(k, w)
    assert beta.shape == (2, 3)
    assert beta[1, 1] == NUMERIC.beta(1.5, 1.0)
    assert 1e9 < NUMERIC.log_amplitude(1 + 1e-9, 1.0, V=2.0) < np.inf


@pytest.mark.parametrize(
    ("k", "omega", "words"),
    [(3.0, 100.0, "G[+]H[+]I > 0$"), (1.6, 1e3, "V² > 0$"), (1.0, 1.0, "k > 1$")],
)
def test_missing_waves_raise_or_are_nan_on_request(k, omega, words):
    with pytest.raises(NoSolitaryWave, match=f"k = {k}, ω = {omega}: .*{words}"):
        NUMERIC.width([1.5, k], [1.0, omega])
    found = WAVE.numeric(missing="nan").width([1.5, k], [1.0, omega])
    assert np.isnan(found).tolist() == [False, True]
