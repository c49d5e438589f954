"""The float64 functions against 50 digits."""

from functools import cache

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Dimer, InputError, NoSolitaryWave, canonical_wave, homogenize

ULPS = 8  # one bound on every machine: no extended precision

WAVE = homogenize(Dimer("m1", "m2")).pde.traveling_wave()
NUMERIC = WAVE.numeric()
WAVES = {
    "paper": WAVE,
    "N = 3": canonical_wave(Dimer("m1", "m2", N=3)),
    "contacts": canonical_wave(Dimer("m1", "m2", stiffnesses=("A", "A"))),
}
"""Cells of two masses that are symbols."""

GRID = [
    (k, w)
    for k in (1 + 2.0**-20, 1.125, 1.5, 2.0, 2 + 2.0**-20, 20.0)
    for w in (1e-6, 0.2733, 1.0, 1.5, 1e6)
]
# V² → 0 as k → 3/2, ω → ∞: its terms cancel six digits here.
GRID += [(1.5 - 2.0**-20, 1e9)]


@cache
def exact_wave(name, k, w):
    return WAVES[name].at(k=sp.Rational(k), m1=1, m2=sp.Rational(w), D=1)


@pytest.mark.parametrize("name", WAVES)
@pytest.mark.parametrize(
    ("function", "arguments", "expression"),
    [
        ("beta", (), lambda wave: wave.beta),
        ("width", (), lambda wave: wave.width),
        ("fwhm", ("strain",), lambda wave: wave.fwhm("strain")),
        ("fwhm", ("force",), lambda wave: wave.fwhm("force")),
        ("speed", (2.0,), lambda wave: wave.speed(2)),
        (
            "log_amplitude",
            (2.0,),
            lambda wave: (sp.log(4) - sp.log(wave.speed_factor)) / (wave.k - 1),
        ),
    ],
)
def test_closed_forms_to_eight_ulps(name, function, arguments, expression):
    """Against 50 digits: some ten operations of half an ulp each."""
    compute, checked = getattr(WAVES[name].numeric(), function), 0
    for k, w in GRID:
        try:
            reference = sp.N(expression(exact_wave(name, k, w)), 50)
        except NoSolitaryWave:
            with pytest.raises(NoSolitaryWave):
                compute(k, w, *arguments)
            continue
        error = abs(sp.Rational(float(compute(k, w, *arguments))) - reference)
        assert error <= ULPS * np.spacing(abs(float(reference)))
        checked += 1
    assert checked > 20


def test_arrays_broadcast():
    k, w = np.array([[1.25], [1.5]]), np.array([0.1, 1.0, 10.0])
    beta = NUMERIC.beta(k, w)
    assert beta.shape == (2, 3)
    assert beta[1, 1] == NUMERIC.beta(1.5, 1.0)
    assert 1e9 < NUMERIC.log_amplitude(1 + 1e-9, 1.0, V=2.0) < np.inf


def test_missing_waves_raise_or_are_nan_on_request():
    for k, omega, words in (
        (3.0, 100.0, r"G\+H\+I > 0$"),
        (1.6, 1e3, "V² > 0$"),
        (1.0, 1.0, "k > 1$"),
    ):
        with pytest.raises(NoSolitaryWave, match=f"k = {k}, ω = {omega}: .*{words}"):
            NUMERIC.width([1.5, k], [1.0, omega])
    found = WAVE.numeric(missing="nan").width([1.5, 3.0, 1.0], [1.0, 100.0, 1.0])
    assert np.isnan(found).tolist() == [False, True, True]


def test_bad_input():
    for arguments in ((np.nan, 1.0), (1.5, np.inf), (1.5, 0.0), (1.5, -1.0)):
        with pytest.raises(InputError):
            NUMERIC.beta(*arguments)
    with pytest.raises(InputError, match=r"B is -1\.0: it must be positive"):
        NUMERIC.speed(1.5, 1.0, B=-1.0)
    with pytest.raises(InputError, match="symbol k and a cell of two masses"):
        WAVE.at(k="3/2").numeric()
    for cell in (Cell(["m1", "m2", "m3"]), Cell(["m1", "m2"], ["A1", "A2"]), Cell(["m1"])):
        with pytest.raises(InputError, match="two masses"):
            canonical_wave(cell).numeric()
    with pytest.raises(InputError, match="missing"):
        WAVE.numeric(missing="zero")
