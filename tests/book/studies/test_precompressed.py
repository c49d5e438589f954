"""Waves of chains under load: Newton's wave as the lattice runs it, and the theory beside both."""

import json
import math

import numpy as np
import pytest
import scipy

from book.studies.precompressed import CHAINS, RATIOS, Wave, precompressed
from lwa import Cell, Power
from lwa.linear.dispersion import LoadedChain
from tests.commands import ended
from validation.lattice.simulate import simulate


def rows(**options):
    return precompressed(**options).document()["rows"]


def test_equal_beads():
    """The exact wave keeps its shape on the lattice; the theory's errors grow with the wave.

    A bead's velocity is B V for weak waves. At k = 2 the error stays below the 6.8 % of c² that
    the theory has without a load."""
    equal = precompressed(masses=(1,), ratios=(0.3, 1, 100)).document()
    square = precompressed(k=2, masses=(1,), ratios=(3, 100)).document()
    assert (equal["ok"], square["ok"]) == (True, True)
    assert equal["lattice_over_exact_value"] < 1e-7
    for row in equal["rows"]:
        assert row["speed_value"] == pytest.approx(row["exact_value"], rel=1e-7)
        assert abs(row["decay_value"]) < 1e-8
    weak, even, strong = (row["error_value"] for row in equal["rows"])
    assert -1e-4 < weak < 0
    assert -1e-3 < even < 10 * weak / 3
    assert -0.025 < strong < -0.005
    assert (
        -0.0348
        < square["rows"][1]["error_value"]
        < square["rows"][0]["error_value"]
        < 0
    )
    weak, even, _ = (abs(row["peak_off_value"]) for row in equal["rows"])
    assert weak < 0.01
    assert 2 < even / weak < 3.34


@pytest.mark.slow
def test_the_strongest_waves_of_all_default_chains_are_measured():
    """A wave in a fourth default chain, of four beads, fell apart: the command had no output."""
    found = rows(ratios=RATIOS[-1:])
    assert [row["masses"] for row in found] == [
        [str(m) for m in masses] for masses in CHAINS
    ]
    assert all(abs(row["error_value"]) < 0.025 for row in found)


@pytest.mark.slow
def test_masses_matter_to_widths_only():
    """V/c0 of a weak wave is that of equal beads, the width √(12 I) times theirs, I = 1/9."""
    found = [rows(masses=masses, ratios=(0.03,))[0] for masses in ((3,), (2, 1))]
    one, two = found
    assert two["ratio_value"] == pytest.approx(0.03, rel=2e-3)
    assert two["speed_value"] == pytest.approx(one["speed_value"], abs=2e-5)
    assert two["fwhm_value"] / one["fwhm_value"] == pytest.approx(
        math.sqrt(12 / 9), rel=2e-3
    )
    assert one["exact_value"] is not None
    assert two["exact_value"] is None


def test_why_dimers_are_worse():
    """At the frequency of the tail the optical branch's phase speed is the speed of the wave."""
    wave = Wave(Cell((1, "1/2"), spacing=1), Power("3/2"), 1.0)
    run = simulate(wave.scene, method="symplectic", rtol=1e-7)
    found = wave.read(run, 1)
    assert found["decay"] > 1e-5
    chain = LoadedChain(wave.cell, wave.law, 1)
    speed = found["speed"] * wave.sound

    q = scipy.optimize.brentq(
        lambda q: chain.bands.branches(q)[-1] - speed * q, 0.1, np.pi
    )
    light = (
        run.bead_velocity[1] - run.bead_velocity[0]
    )  # a contact's rate: no long waves
    start = int(np.argmax(run.contact_force[0])) + 200
    tail = light[start : start + 3000] * np.hanning(3000)
    spectrum = np.abs(np.fft.rfft(tail, 2**17))
    step = run.time[1] - run.time[0]
    frequency = 2 * np.pi * np.argmax(spectrum) / (2**17 * step)
    assert frequency == pytest.approx(speed * q, rel=1e-3)
    assert frequency > 1.003 * chain.bands.edges()[1, 0]  # not where the branch is flat


@pytest.mark.slow
def test_another_law(capsys):
    """Weak waves of any law: V/c0 - 1 = F″(1)/(6 F′(1)) B, B = F0/F′(1) times the ratio."""
    options = "--law hertz2:1,2 --masses 1 --ratios 0.1 --format json"
    status, out, _ = ended(capsys, precompressed.main, *options.split())
    (row,) = json.loads(out)["rows"]
    assert (status, row["exact_value"]) == (0, None)
    # F = δ^{3/2} + 2 δ^{5/2}: F0 = 3, F′ = 13/2, F″ = 33/4
    small = 33 / 4 / (6 * 6.5) * 3 / 6.5 * row["ratio_value"]
    assert row["speed_value"] - 1 == pytest.approx(small, rel=0.03)
    assert row["speed_value"] == pytest.approx(row["theory_value"], rel=1e-4)
    assert abs(row["fwhm_off_value"]) < 0.005
