"""Breathers of loaded chains beside their envelopes; aluminium and steel at 20 N."""

import math

import numpy as np
import pytest

from book.studies.breather import Standing, breather
from lwa import Cell, LoadedChain, Material, Power, Sphere, envelope


def test_bright_breathers_of_a_dimer():
    report = breather(detunings=(0.002, 0.004))
    assert report.ok
    assert report.data["kind"] == "bright"
    first, second = report.document()["rows"]
    for row in (first, second):
        assert row["frequency_value"] == pytest.approx(
            math.sqrt(6) * (1 - row["detuning_value"])
        )
        # multipliers of some lengths of a chain meet off the real axis and leave the circle
        assert row["multiplier_value"] == pytest.approx(1, abs=1e-3)
        assert 0 < row["energy_value"] < 5
    assert 0 < first["amplitude_off_value"] < 0.008
    ratio = second["amplitude_off_value"] / first["amplitude_off_value"]
    assert ratio == pytest.approx(2, rel=0.1)


def test_dark_breathers_of_equal_beads():
    """Errors fall in proportion to ν; the ends of 13 widths change the plateau by 1e-5."""
    cell = Cell((1,), spacing=1)
    edge = envelope(cell, law=Power("3/2"), precompression=1)
    errors = []
    for nu in (0.002, 0.001, 0.0005):
        theory = edge.breather(detuning=nu)
        found = Standing(
            cell, 1.5, theory, math.ceil(13 * float(theory.width))
        ).numbers()
        amplitude = abs(float(theory.amplitude[0])) / found["amplitude"] - 1
        errors.append([amplitude, float(theory.width) / found["width"] - 1])
        assert amplitude == pytest.approx(2.7 * nu, rel=0.01)
    assert np.divide(errors[:-1], errors[1:]) == pytest.approx(2, rel=0.02)


@pytest.mark.slow
def test_errors_cover_a_longer_chain_with_more_harmonics():
    cell, k = Cell((1, "1/2"), spacing=1), 1.5
    theory = envelope(cell, law=Power(k), precompression=1).breather(detuning=0.002)
    row = Standing(cell, k, theory, 80).row()
    finer = Standing(cell, k, theory, 240, harmonics=8).numbers()
    for name in ("amplitude", "width"):
        assert abs(row[name].value - finer[name]) <= row[name].error


def test_aluminium_and_steel_at_20_newtons():
    """The chain of Boechler et al. (2010): 81 beads of 19.05 mm, with a breather in the gap."""
    steel = Sphere("28.84e-3", "9.525e-3", Material("193e9", "0.3"))
    aluminium = Sphere("9.75e-3", "9.525e-3", Material("73.5e9", "0.33"))
    cell = Cell.of_spheres([steel, aluminium])
    edge = LoadedChain(cell, Power("3/2"), 20).bands.edges()[1, 0]
    theory = envelope(cell, law=Power("3/2"), precompression=20).breather(
        detuning="1/200"
    )
    row = Standing(cell, 1.5, theory, 40, load=20.0).row()
    assert row["frequency_value"] == pytest.approx(edge * 0.995, rel=1e-9)
    assert abs(row["amplitude_off_value"]) < 0.015
    assert row["multiplier_value"] == pytest.approx(1, abs=1e-3)
