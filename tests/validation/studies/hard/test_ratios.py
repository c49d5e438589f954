"""Hard cases in ω: slaved light beads, decay at resonance, and waves that a closure lacks."""

import math

import pytest
import sympy as sp

from validation.pulses.steady import point
from validation.pulses.time_of_flight import passage, ratio
from validation.report.table import Finding
from validation.studies.hard import ratios as module
from validation.studies.hard.ratios import (
    _refusal,
    _slaved,
    mass_ratios,
    no_compact_wave,
    resonance,
)
from validation.waves.solver import solve


@pytest.fixture(scope="module")
def uniform():
    return solve((1.0, 1.0), 1.5)


@pytest.mark.parametrize("omega", [1e-3, 4e-3])
def test_slaved_beads_slow_the_limit_by_a_share_of_their_mass(uniform, omega):
    """Every cell has the mass 1 + ω: a speed lower by ω/2 at most, and by no less than ω/4."""
    passed = passage(_slaved(uniform, 1.0, omega), 1e-5)
    off = ratio(passed.speed, math.sqrt(2) * uniform.c).value
    assert -omega / 2 < off < -omega / 4
    assert abs(passed.momentum_drift) < 1e-12


def test_mass_ratios_hold_and_another_limit_does_not(monkeypatch, failing):
    monkeypatch.setattr(module, "RATIOS", (1e-4, 1e-3, 1e-2))
    assert failing(mass_ratios()) == []
    # springs in a row of 2^-k are the limit, not parallel ones
    monkeypatch.setattr(module.math, "sqrt", lambda x: 1.001 * x**0.5 if x == 2 else x**0.5)
    assert "ω = 0.0001: speed/limit - 1, over ω" in failing(mass_ratios())


def test_the_decay_at_the_resonance_is_that_of_the_steady_pulse(monkeypatch, failing):
    """One number, one error: it was 0.0153535 ± 4e-8 here and 0.01531 ± 2e-6 in a sweep."""
    monkeypatch.setattr(module, "RESONANT", (0.6,))
    monkeypatch.setattr(module, "QUIET", (1.0,))
    outcome = resonance()
    assert failing(outcome) == []
    found = next(f for f in outcome.findings if isinstance(f, Finding) and f.key == "decay")
    longer = point(sp.Rational(3, 2), sp.Rational(3, 5), 7).numbers["decay"]
    assert abs(found.value - longer.value) <= found.error + longer.error


@pytest.mark.parametrize(
    ("k", "omega", "says"),
    [
        ("3", "2.999", "has a wave"),
        ("3", "3", "(G+H+I)/D² is 0"),
        ("3", "3.001", "(G+H+I)/D² is -"),
        ("20", "5", "(G+H+I)/D² is -"),
        ("3/2", "1000000", "has a wave"),
        ("8/5", "7", "V²/B^(k-1) is -"),
    ],
)
def test_the_closure_is_refused_where_one_of_its_numbers_is_not_positive(k, omega, says):
    """6 (1+ω)² (G+H+I)/D² as the paper has it; at k = 3 it is 2 (3 - ω)(2 + ω)."""
    k, omega = sp.Rational(k), sp.Rational(omega)
    assert _refusal(k, omega).startswith(says)
    terms = (k - 2) * (k - 1), 2 * (k - 1) * (2 - omega) * (1 + omega), 2 * (1 - omega + omega**2)
    if says.startswith("(G"):
        assert sum(terms) <= 0
    else:
        assert sum(terms) > 0


@pytest.mark.slow
def test_no_compact_wave_holds_but_for_a_closure_with_a_wave(monkeypatch, failing):
    monkeypatch.setattr(module, "_refusal", lambda k, omega: "has a wave, of 5 sites")
    assert failing(no_compact_wave()) == [
        "k = 3, ω = 8.8137: paper's closure",
        "k = 8/5, ω = 7.0212: paper's closure",
    ]
