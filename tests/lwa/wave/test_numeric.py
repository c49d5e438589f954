"""The float64 functions against 50 digits."""

import numpy as np
import pytest
import sympy as sp

from lwa import Dimer, NoSolitaryWave, canonical_wave, homogenize

WAVE = homogenize(Dimer("m1", "m2")).pde.traveling_wave()
NUMERIC = WAVE.numeric()
LONG = canonical_wave(Dimer("m1", "m2", 3, stiffnesses=["A"] * 4))


@pytest.mark.parametrize("wave", [WAVE, LONG], ids=["paper", "N = 3"])
def test_closed_forms_are_good_to_1e11(wave):
    """Against 50 digits."""
    numeric = wave.numeric()
    for k, w in ((1 + 1e-6, 3.0), (1.5, 0.2733), (2.7, 1e-6), (4.0, 0.9), (1.5, 1e6)):
        found = (
            numeric.beta(k, w),
            numeric.width(k, w),
            numeric.fwhm(k, w, "force"),
            numeric.speed(k, w, 2.0),
            numeric.log_amplitude(k, w, 2.0),
        )
        at = wave.at(k=sp.Rational(k), m1=1, m2=sp.Rational(w), D=1)
        log_B = sp.log(4 / at.speed_factor) / (at.k - 1)
        exact = (at.beta, at.width, at.fwhm("force"), at.speed(2), log_B)
        known = [float(sp.N(value, 50)) for value in exact]
        assert found == pytest.approx(known, rel=1e-11)


@pytest.mark.parametrize(
    ("k", "omega", "words"),
    [(3.0, 100.0, "G[+]H[+]I > 0$"), (1.6, 1e3, "V² > 0$"), (1.0, 1.0, "k > 1$")],
)
def test_missing_waves_raise_or_are_nan_on_request(k, omega, words):
    with pytest.raises(NoSolitaryWave, match=f"k = {k}, ω = {omega}: .*{words}"):
        NUMERIC.width([[1.5], [k]], [1.0, omega])
    found = WAVE.numeric(missing="nan").width([[1.5], [k]], [1.0, omega])
    assert np.isnan(found[[0, 1], [0, 1]]).tolist() == [False, True]
