"""Every number with ± against the same computation at a hundred times the cost: it is within ±.

A study's cost is set by arguments: tolerances, distances, samples.
"""

import importlib
import tomllib
from dataclasses import replace

import pytest
import sympy as sp

from lwa import Cell, Power
from validation.pulses import steady
from validation.pulses.pulse import Measured
from validation.pulses.sensors import record
from validation.scenes import scenefile
from validation.waves.solution import solve
from validation.waves.solver import exact_wave, measured
from validation.waves.theory import theory_at

paper, figures, limits, runs = (
    importlib.import_module(f"validation.studies.{name}")
    for name in ("paper", "figures", "limits", "run")
)
disorder, gravity, precompressed = (
    importlib.import_module(f"book.studies.{name}")
    for name in ("disorder", "gravity", "precompressed")
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


def of_run(name, **options):
    found = record(scenefile.scene(tomllib.loads(runs.example(name))), **options)
    return {
        (reading.name, key): number
        for reading in (*found.sensors, *found.speeds)
        for key, number in reading.numbers.items()
    }


@pytest.mark.parametrize("name", runs.EXAMPLES)
def test_run(name):
    held(of_run(name), of_run(name, rtol=1e-13))


def of_paper(**options):
    return {quantity: number for quantity, _, number, *_ in paper.paper(**options).tables[0].rows}


def test_paper():
    held(of_paper(), of_paper(tolerances=FINER))


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
    [((1, 2), ()), pytest.param((5,), figures.MODULI[:1], marks=pytest.mark.slow)],
)
def test_figures(chains, moduli):
    held(of_figures(chains, moduli), of_figures(chains, moduli, tolerances=FINER))


def test_limits_of_one_wave():
    """The error is what the pulse has yet to shed: the finer run is read farther away."""
    wave = theory_at("3/2", 1)
    found = limits.lattice_wave(wave)
    held(found, limits.lattice_wave(wave, places=(8, 12, 16)))


@pytest.mark.parametrize(
    ("masses", "k"),
    [([1], 1.5), ([1, 0.3428457811], 1.5), pytest.param([1], 5, marks=pytest.mark.slow)],
)
def test_exact(masses, k):
    """A grid 2.7 times as fine costs twenty times as much: Newton's cost is of third order."""
    wave = exact_wave(masses, k)
    points = int(2.7 * len(wave.even))
    finer = solve(wave.masses, k, wave.half_period, points, wave, free=len(masses) == 2)
    held(measured(wave), measured(finer))


@pytest.mark.parametrize(
    ("masses", "ratio"), [((1,), 1.0), pytest.param((1, "1/2"), 3.0, marks=pytest.mark.slow)]
)
def test_precompressed(masses, ratio):
    wave = precompressed.Wave(Cell(masses, spacing=1), Power("3/2"), ratio)
    finer = replace(wave, tolerances=(1e-11, 1e-10))
    held(measurements(wave.row()), measurements(finer.row()))


@pytest.mark.slow
def test_gravity():
    """Ten times as deep, and at a hundredth of the tolerance; the exponent's limit is 1/3."""
    chain = gravity.Upright(Cell((1,), spacing=1), 1.5, 1000)
    found, deeper, finer = (
        dict(zip(("exponent", "prefactor"), one.fitted(*one.fronts()), strict=True))
        for one in (chain, replace(chain, beads=10_000), replace(chain, tolerances=(1e-7, 1e-6)))
    )
    held(found, deeper)
    held(found, finer)
    assert abs(found["exponent"].value - 1 / 3) <= found["exponent"].error


def test_disorder():
    """Losses at single beads."""
    found, finer = (
        dict(enumerate(disorder.single_losses((0.2, -0.2), rtol=rtol))) for rtol in (1e-9, 1e-12)
    )
    held(found, finer)


POINTS = [("3/2", omega) for omega in ("9/20", "3/5", "3/4", "1")]
POINTS += [("2", "1/4"), ("6", "3/10")]


@pytest.mark.slow
@pytest.mark.parametrize(("k", "omega"), POINTS)
def test_sweep(k, omega):
    """Ten times as far, where the pulse is not yet overtaken.

    A point without numbers states the reason.
    """
    point = sp.Rational(k), sp.Rational(omega)
    found = steady.point(*point, steady.STRETCH)
    assert bool(found.numbers) != (found.missing or "").startswith("not steady: ")
    farther = 10 if point[0] < 2 else 4
    finer = steady.point(*point, farther * steady.STRETCH, farther=1.2)
    if finer.missing is None:
        held(found.numbers, finer.numbers)
    else:
        assert finer.missing.startswith("not steady: ")
