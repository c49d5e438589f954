"""Every number with ± against the same computation at a hundred times the cost: it is within ±.

A study's cost is set by arguments: tolerances, distances, samples.
"""

import importlib
import tomllib

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Power
from validation.lattice.simulate import simulate
from validation.pulses import sensors, steady
from validation.pulses.pulse import Measured
from validation.pulses.sensors import TOLERANCE, record
from validation.scenes import scenefile
from validation.waves.solver import exact_wave, measured, solve
from validation.waves.theory import theory_at

paper, figures, limits, runs = (
    importlib.import_module(f"validation.studies.{name}")
    for name in ("paper", "figures", "limits", "run")
)
disorder, gravity, precompressed, widths = (
    importlib.import_module(f"book.studies.{name}")
    for name in ("disorder", "gravity", "precompressed", "widths")
)


FINER = (1e-13, 1e-12)  # tolerances of the run that counts and of the run that gives its errors


def held(numbers, finer):
    """Each number's difference from the finer one is within its ±."""
    assert numbers.keys() == finer.keys()
    assert numbers
    for name, number in numbers.items():
        off = abs(number.value - finer[name].value)
        assert off <= number.error, (name, number, finer[name], off / (number.error or 1e-300))


def measurements(values):
    """The values that have a ±, without exact ones and words."""
    return {name: value for name, value in values.items() if isinstance(value, Measured)}


def of_run(name):
    found = record(scenefile.scene(tomllib.loads(runs.example(name))))
    return {
        (reading.name, key): number
        for reading in (*found.sensors, *found.speeds)
        for key, number in reading.numbers.items()
    }


@pytest.mark.parametrize(
    "name",
    ["paper", "vertical", "trimer", pytest.param("defect", marks=pytest.mark.slow),
     pytest.param("precompressed", marks=pytest.mark.slow)],
)  # fmt: skip
def test_run(monkeypatch, name):
    """With a hundred times as many steps, none of them longer than a hundredth of the mean step."""
    found = of_run(name)

    def finest(scene, *_, **__):
        run = simulate(scene, rtol=1e-13, step=simulate(scene, rtol=TOLERANCE).step / 100)
        return run, run

    monkeypatch.setattr(sensors, "twice", finest)
    held(found, of_run(name))


def of_paper(**options):
    return {quantity: number for quantity, _, number, *_ in paper.paper(**options).tables[0].rows}


@pytest.mark.parametrize("options", [{"beads": 24, "sensors": (8, 19)}, {}])
def test_paper(options):
    held(of_paper(**options), of_paper(**options, tolerances=FINER))


def test_two_commands_print_the_same_value():
    """The paper's chain by `paper` and by `run` on its own example."""
    by_name = of_paper()
    scene = scenefile.scene(tomllib.loads(runs.example("paper")))
    found = record(scene)
    first, second = (reading.numbers["peak"] for reading in found.sensors[:2])
    pairs = [
        (by_name["peak bead force F_15"], first),
        (by_name["peak bead force F_34"], second),
        (by_name["speed V_s"], found.speeds[0].numbers["speed"]),
    ]
    for one, other in pairs:
        assert abs(one.value - other.value) <= one.error + other.error
        assert one.value == pytest.approx(other.value, rel=1e-9)


def of_figures(chains, moduli, **options):
    speeds = {N: figures.chain_speed(N, **options) for N in chains}
    found = {(N, name): getattr(s, name) for N, s in speeds.items() for name in ("speed", "force")}
    for E in moduli:
        scaling = figures.scaling(E, **options)
        found |= {(E, "V", i): number for i, number in enumerate(scaling.speeds)}
        found |= {(E, "F", i): number for i, number in enumerate(scaling.forces)}
        found[E, "exponent"] = scaling.exponent
    return found


@pytest.mark.parametrize(
    ("chains", "moduli"),
    [((1, 2), ()), pytest.param((3, 5, 11, 22), figures.MODULI, marks=pytest.mark.slow)],
)
def test_figures(chains, moduli):
    held(of_figures(chains, moduli), of_figures(chains, moduli, tolerances=FINER))


@pytest.mark.parametrize("k", ["3/2", "5/4"])
def test_limits_of_one_wave(monkeypatch, k):
    """The error is what the pulse has yet to shed: the finer run is read farther away."""
    wave = theory_at(sp.Rational(k), sp.Integer(1))
    found = limits.lattice_wave(wave)
    monkeypatch.setattr(limits, "PLACES", (8, 12, 16))
    held(measurements(found), measurements(limits.lattice_wave(wave)))


@pytest.mark.slow
def test_limits(monkeypatch):
    """Twice the distance at a thousandth of the tolerance; and the exact waves of equal beads."""
    rows = limits.compare()
    found = {(row.quantity, row.k, row.omega): row.lattice for row in rows}
    for k in limits.EXPONENTS:
        wave = exact_wave([1], float(k))
        true = wave.fwhm("force"), wave.fwhm("strain"), wave.c / float(k) ** 0.5
        for name, value in zip(np.delete(limits.QUANTITIES, 2), true, strict=True):
            number = found[name, k, limits.EQUAL]
            assert abs(number.value - value) <= number.error, (name, k)
    monkeypatch.setattr(limits, "PLACES", (8, 16, 24))
    monkeypatch.setattr(limits, "TOLERANCES", {1: (1e-12, 1e-12), 2: (1e-10, 1e-9)})
    held(found, {(row.quantity, row.k, row.omega): row.lattice for row in limits.compare()})


@pytest.mark.parametrize(
    ("masses", "k"),
    [([1], 1.5), pytest.param([1, 0.8], 1.5, marks=pytest.mark.slow),
     pytest.param([1], 1.05, marks=pytest.mark.slow), pytest.param([1], 5, marks=pytest.mark.slow)],
)  # fmt: skip
def test_exact(masses, k):
    """On a grid almost three times as fine: Newton's method costs the third power of its size."""
    wave = exact_wave(masses, k)
    finer = solve(wave.masses, k, wave.half_period, int(2.7 * len(wave.even)), wave)
    held(measured(wave), measured(finer))


def of_precompressed(masses, ratios):
    waves = {
        ratio: precompressed.Wave(Cell(masses, spacing=1), Power("3/2"), ratio).row()
        for ratio in ratios
    }
    return {
        (ratio, name): number
        for ratio, row in waves.items()
        for name, number in row.items()
        if isinstance(number, Measured)
    }


@pytest.mark.parametrize(
    ("masses", "ratios"),
    [((1,), (1.0,)), pytest.param((1,), (0.03, 0.3, 3, 10, 100), marks=pytest.mark.slow),
     pytest.param((1, "1/2"), (0.1, 3), marks=pytest.mark.slow)],
)  # fmt: skip
def test_precompressed(monkeypatch, masses, ratios):
    found = of_precompressed(masses, ratios)
    monkeypatch.setattr(precompressed, "_TOLERANCES", (1e-11, 1e-10))
    held(found, of_precompressed(masses, ratios))


def of_gravity(masses, beads):
    chain = gravity.Upright(Cell(masses, spacing=1), 1.5, beads)
    return dict(zip(("exponent", "prefactor"), chain.fitted(*chain.fronts()), strict=True))


@pytest.mark.slow
@pytest.mark.parametrize("masses", [(1,), (1, "1/2")])
def test_gravity(monkeypatch, masses):
    """Ten times as deep, and at a hundredth of the tolerance; the exponent's limit is 1/3."""
    found = of_gravity(masses, 1000)
    held(found, of_gravity(masses, 10_000))
    assert abs(found["exponent"].value - 1 / 3) <= found["exponent"].error
    monkeypatch.setattr(gravity, "_TOLERANCES", (1e-7, 1e-6))
    held(found, of_gravity(masses, 1000))


def of_disorder(spread):
    singles = disorder.single_losses((spread, -spread))
    report = disorder.disorder(spread=spread, chains=4, sites=60)
    rows = report.tables[0].rows
    decay = Measured(report.data["decay_value"], report.data["decay_value"] + 0.0)
    found = {(row[0], i): row[i] for row in rows[1:] for i in (1, 3)}
    return singles, found, decay


def test_disorder(monkeypatch):
    """The same chains, more accurately: errors over chains are far larger than the integration's,
    which is what the losses at single beads state."""
    singles, found, _ = of_disorder(0.2)
    monkeypatch.setattr(disorder, "_TOLERANCE", 1e-9)
    monkeypatch.setattr(disorder, "_FINE", 1e-12)
    finer, again, _ = of_disorder(0.2)
    held(dict(enumerate(singles)), dict(enumerate(finer)))
    held(found, again)


def of_widths(**options):
    report = widths.widths(**options)
    beads = zip(report.data["fwhm_value"], report.data["fwhm_error_value"], strict=True)
    times = [Measured(value, value + error) for value, error in beads]
    return dict(enumerate([*times, *(average for _, _, average, *_ in report.tables[0].rows)]))


@pytest.mark.slow
def test_widths():
    held(of_widths(), of_widths(tolerances=FINER))


POINTS = [("3/2", omega) for omega in ("9/20", "1/5", "1/2", "3/5", "7/10", "3/4", "1")]
POINTS += [("5/4", "3/4"), ("2", "1/4"), ("2", "3/10"), ("2", "1/2"), ("2", "3/5"), ("6", "3/10")]


@pytest.mark.slow
@pytest.mark.parametrize(("k", "omega"), POINTS)
def test_sweep(monkeypatch, k, omega):
    """Ten times as far at a hundredth of the tolerance, where the pulse is not yet overtaken.

    A point without numbers says why.
    """
    point = sp.Rational(k), sp.Rational(omega)
    found = steady.point(*point, steady.STRETCH)
    assert bool(found.numbers) != (found.missing or "").startswith("not steady: ")
    monkeypatch.setattr(steady, "TOLERANCES", (1e-8, 1e-7))
    farther = 10 if point[0] < 2 else 4
    finer = steady.point(*point, farther * steady.STRETCH, farther=1.2)
    if finer.missing is None:
        held(found.numbers, finer.numbers)
    else:
        assert finer.missing.startswith("not steady: ")
