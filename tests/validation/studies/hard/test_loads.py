"""Waves on a background in float64: that every loss is seen."""

import math

import mpmath as mp
import numpy as np
import pytest

from lwa import Cell, Power, background_wave
from validation.studies.hard import loads
from validation.studies.hard.floats import DIGITS
from validation.studies.hard.loads import ALLOWED, squared, under_load, width_error

WAVE = background_wave(Cell([1], spacing=1), law=Power("3/2"))


@pytest.fixture
def few(monkeypatch):
    monkeypatch.setattr(loads, "RATIOS", 10.0 ** np.array([-12.0, 2.0, 4.0, 8.0, 12.0]))
    monkeypatch.setattr(loads, "WIDTHS", np.array([1e-12, 1e12]))


def test_the_reference_is_the_integral_of_the_law():
    """2(W(p0+B) - W(p0) - F(p0) B)/B² = 2∫(1-s) F′(p0 + sB) ds."""
    with mp.workdps(DIGITS):
        for p0 in (1e-12, 0.3, 1e12):
            integral = mp.quad(lambda s, p0=p0: 2 * (1 - s) * mp.sqrt(p0 + s * mp.mpf(loads.B)),
                               [0, 1e-12, 1e-9, 1e-6, 1e-3, 1])  # fmt: skip
            assert abs(squared(WAVE, p0) / integral - 1) < 1e-25


def test_all_hold_and_the_printed_relation_loses_two_digits_a_decade(few):
    found = under_load()
    assert found.ok
    assert 0 < found.document()["loss_ulps_value"] < ALLOWED
    (printed,) = (c for c in found.panels[0].curves if c.label == loads.PRINTED)
    at = dict(zip(printed.x, printed.y, strict=True))
    assert math.log10(at[1e4] / at[1e2]) == pytest.approx(4, abs=1.5)
    assert at[1e12] > 2**52


def test_a_loss_is_seen(few, monkeypatch):
    """V² off by 1e-15 of itself, the width by 1e-11."""
    from lwa.wave.quadrature import NumericBackground

    true = NumericBackground.speed_squared, NumericBackground.fwhm
    monkeypatch.setattr(NumericBackground, "speed_squared",
                        lambda *a: true[0](*a) * (1 + 2e-15))  # fmt: skip
    monkeypatch.setattr(NumericBackground, "fwhm", lambda *a: true[1](*a) * (1 + 1e-11))
    assert width_error(WAVE, 1.0, "strain") == pytest.approx(1e-11, rel=1e-3)
    failed = [f for f in under_load().findings if not f.ok]
    assert len(failed) == 8  # all but the printed one
