"""Errors that commands print, against the same computations at a hundredth of the tolerance."""

import tomllib

import pytest
import sympy as sp

from book.studies import gravity, precompressed
from validation.pulses import steady
from validation.pulses.pulse import Measured
from validation.pulses.sensors import record
from validation.scenes.scenefile import scene
from validation.studies import figures, limits, paper
from validation.studies.run import EXAMPLES
from validation.waves.theory import theory_at


def covered(found, finer):
    """Every measured number differs from the finer one by less than its error."""
    assert found.keys() == finer.keys()
    numbers = {name: value for name, value in found.items() if isinstance(value, Measured)}
    assert numbers
    for name, value in numbers.items():
        assert abs(value.value - finer[name].value) <= value.error, name


def readings(found):
    return {
        (reading.name, name): number
        for reading in (*found.sensors, *found.speeds)
        for name, number in reading.numbers.items()
    }


@pytest.mark.parametrize("name", EXAMPLES)
def test_run(name):
    example = scene(tomllib.loads(EXAMPLES[name][1]))
    covered(readings(record(example, rtol=1e-9)), readings(record(example, rtol=1e-11)))


def test_paper(monkeypatch):
    rows = {row.quantity: row.lattice for row in paper.paper(beads=24, sensors=(8, 18)).rows}
    monkeypatch.setattr(paper, "TOLERANCES", (1e-12, 1e-9))
    covered(rows, {r.quantity: r.lattice for r in paper.paper(beads=24, sensors=(8, 18)).rows})


def test_figures(monkeypatch):
    def numbers():
        found = figures.chain_speed(2)
        return {"speed": found.speed, "force": found.force}

    found = numbers()
    monkeypatch.setattr(paper, "TOLERANCES", (1e-11, 1e-9))
    covered(found, numbers())


@pytest.mark.parametrize("k", ["3/2", "5/4"])
def test_limits(monkeypatch, k):
    """The error is what the pulse has yet to shed: finer is farther away."""
    wave = theory_at(sp.Rational(k), sp.Integer(1))
    found = limits.lattice_wave(wave)
    monkeypatch.setattr(limits, "PLACES", (8, 12, 16))
    covered(found, limits.lattice_wave(wave))


@pytest.mark.parametrize(("k", "omega"), [("3/2", "1"), ("3/2", "3/5"), ("2", "1/4")])
def test_sweep(monkeypatch, k, omega):
    def numbers():
        return steady.point(sp.Rational(k), sp.Rational(omega), steady.STRETCH).numbers

    found = numbers()
    monkeypatch.setattr(steady, "TOLERANCES", (1e-8, 1e-7))
    covered(found, numbers())


def test_precompressed(monkeypatch):
    def numbers():
        (row,) = precompressed.precompressed(masses=(1,), ratios=(3,)).tables[0].records()
        names = [name for name in row if f"{name.removesuffix('_value')}_error_value" in row]
        return {n: Measured(row[n], row[n] + row[f"{n[:-6]}_error_value"]) for n in names}

    found = numbers()
    monkeypatch.setattr(precompressed, "_TOLERANCES", (1e-9, 1e-7))
    covered(found, numbers())


@pytest.mark.slow
def test_gravity(monkeypatch):
    def numbers():
        (row, *_) = gravity.gravity(masses=(1,)).tables[0].records()
        names = ("exponent_value", "prefactor_value")
        return {n: Measured(row[n], row[n] + row[f"{n[:-6]}_error_value"]) for n in names}

    found = numbers()
    monkeypatch.setattr(gravity, "_TOLERANCES", (1e-7, 1e-6))
    covered(found, numbers())
