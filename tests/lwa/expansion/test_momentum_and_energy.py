"""Energy, momentum and units of the expansion's wave, and the pulse of a strike."""

import numpy as np
import pytest

from lwa import Cell, Dimer, ExpandedWave, canonical_wave, expand, pulse_of_strike

EQUAL = Cell([1], spacing=1)


def wave(k="3/2", force=1, cell=EQUAL):
    return ExpandedWave(expand(cell, 16, k=k), force)


def test_hertz_s_numbers():
    """Digits of the theory notes, and of the exact wave: computed outside the project."""
    one = wave()
    for sum_, known, digits in (
        (one.energy, 1.046516, 6), (one.momentum, 1.652067, 6),
        (one.expansion.effective_mass.at(), 1.3040, 4),
        (one.speed, 0.905515776419, 12), (one.fwhm("force"), 1.411928348539, 12),
    ):  # fmt: skip
        assert abs(sum_.value - known) < sum_.error + 10**-digits
        assert sum_.error < 1e-7


def test_units_and_forces_enter_as_dimensions_demand():
    """E ~ F δ, P ~ m δ/t with δ = (F/A)^{1/k}, t = √(m δ/F)."""
    k, m, A, F, D = 1.5, 4.0, 8.0, 27.0, 3.0
    delta = (F / A) ** (1 / k)
    t = np.sqrt(m * delta / F)
    one, other = wave(), wave(force=27, cell=Cell([4], [8], 3))
    for read, unit in (
        (lambda w: w.energy, F * delta),
        (lambda w: w.momentum, m * delta / t),
        (lambda w: w.expansion.effective_mass.at(), m),
        (lambda w: w.speed, D / t),
        (lambda w: w.fwhm("velocity"), D),
        (lambda w: w.fwhm("force", "time"), t),
    ):
        assert read(other).value == pytest.approx(unit * read(one).value, rel=1e-12)
        assert read(other).error == pytest.approx(unit * read(one).error, rel=1e-12)


def test_the_error_of_a_time_is_that_of_width_and_speed():
    found = wave(force=3)
    width, time = found.fwhm(), found.fwhm("strain", "time")
    shares = width.error / width.value + found.speed.error / found.speed.value
    assert time.error == pytest.approx(time.value * shares, rel=1e-12)


@pytest.mark.parametrize(
    "cell", [EQUAL, Dimer(2, 1, spacing=1)], ids=["equal", "dimer"]
)
def test_the_long_wave_has_the_lattice_s_momentum_as_k_tends_to_1(cell):
    """The error of the canonical wave falls as k - 1."""
    far, near = (
        float(canonical_wave(cell, k).at_force(8).momentum)
        / wave(k, 8, cell).momentum.value
        - 1
        for k in ("1.004", "1.002")
    )
    assert abs(far) < 0.004
    assert near == pytest.approx(far / 2, rel=0.02)  # the next order in k - 1


def test_a_strike_in_si_units_and_by_its_drop():
    """F ~ v^{2k/(k+1)} (m^k A)^{1/(k+1)}, as dimensions demand; a drop h gives √(2 g h)."""
    one = pulse_of_strike(EQUAL, 1, 1)
    other = pulse_of_strike(Cell(["1/2000"], ["1e9"], "1/200"), "1/2000", 3)
    ratio = 3 ** (6 / 5) * (5e-4**1.5 * 1e9) ** (2 / 5)
    assert other.force.value == pytest.approx(ratio * one.force.value, rel=1e-12)
    assert other.fwhm("force", "length") == other.wave.fwhm("force", "length")
    share = other.force.error / other.force.value / 6
    for found, sum_ in (
        (other.speed, other.wave.speed),
        (other.fwhm(), other.wave.fwhm("force", "time")),
    ):
        assert found.value == sum_.value
        assert found.error == pytest.approx(sum_.error + share * found.value)
    dropped = pulse_of_strike(other.chain.cell, "1/2000", drop=0.5)
    same = pulse_of_strike(other.chain.cell, "1/2000", (2 * 9.81 * 0.5) ** 0.5)
    assert dropped.force.value == pytest.approx(same.force.value, rel=1e-12)
