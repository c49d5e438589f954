"""Every ± and bound that a user of `lwa` reads, beside a known deviation.

Each covers the deviation and is at most `LOOSE` times as large: here of sums of the series in
k - 1 and of shocks, in tests/lwa/wave of vectorised functions and in
tests/lwa/loaded of lattices of any links.
"""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import scipy
import sympy as sp

from book.studies.shock import leading
from lwa import Cell, Dimer, Estimate, InputError, Power, expand, loaded_wave, shock
from lwa.law import named
from tests.lwa.expansion.test_exact_waves import lattice, series
from validation import Drive, Scene, measure, simulate

pytestmark = pytest.mark.usefixtures("engine")

LOOSE = 30
EQUAL = Cell([1], spacing=1)


def holds(error, deviation, doubt=0.0):
    """True if an error covers a deviation that is known but for a doubt, and is not too large."""
    return deviation <= error + doubt and error <= LOOSE * (deviation + doubt)


@pytest.mark.parametrize(
    ("exponents", "orders"),
    [
        (("1.1", "3/2", "2.3", "3.25"), (6, 24)),
        pytest.param(
            [f"{k / 20}" for k in range(21, 71, 4)],
            range(6, 17),
            marks=pytest.mark.slow,
        ),
    ],
)
def test_the_error_of_a_sum(exponents, orders):
    """Every error covers the deviation, and 9 of 10 are at most `LOOSE` times as large."""
    every, found = series(expand(EQUAL, max(orders))), []
    for k, order in product(map(sp.Rational, exponents), orders):
        true = lattice(float(k))[0]
        for name, row in every.items():
            total = replace(row, k=k, coefficients=row.coefficients[: order + 1]).at()
            found.append((total.error / true[name], abs(total.value / true[name] - 1)))
    error, deviation = np.array(found).T
    seen = deviation > 1e-11  # the lattice's waves are good to 1e-12
    ratio = error[seen] / deviation[seen]
    assert ratio.min() >= 1
    assert np.mean(ratio <= LOOSE) >= 0.9
    assert np.all(deviation[~seen] <= error[~seen] + 1e-11)


def struck_dimer(law, mass, load=0.0, velocity=1.0, duration=140.0):
    """Speed between like contacts, peak of their force above the load, and FWHM of a pulse."""
    n = 160
    scene = Scene(
        masses=(1.0, float(sp.Rational(mass))) * (n // 2), stiffnesses=(1.0,) * (n - 1), law=law,
        velocities=(velocity,), duration=duration, contact_sensors=(60, 61, 100, 101), samples=8001,
        precompression=load, wall=1.0 if load else None,
    )  # fmt: skip
    run = simulate(scene)
    pulses = [measure(run.time, force - load) for force in run.contact_force]
    pace = np.mean([40 / (pulses[i + 2].arrival - pulses[i].arrival) for i in (0, 1)])
    force = np.exp(np.mean([np.log(pulse.peak) for pulse in pulses]))
    return pace, force, pace * np.mean([pulse.fwhm for pulse in pulses[2:]])


@pytest.mark.parametrize(
    ("k", "mass", "which"),
    [
        ("11/10", "3/5", (1,)),
        ("23/20", "1/2", (1,)),
        ("28/25", "3/4", (1,)),
        ("23/20", "3/5", (0,)),
        ("6/5", "7/10", (0,)),
        ("6/5", "4/5", (0, 1)),
        ("3/2", "4/5", (0,)),
    ],
)
def test_the_errors_of_sums_of_unlike_beads(k, mass, which):
    """c² (0) and widths (1) of a pulse that radiates; a term small by chance ends no series."""
    series, (pace, force, width) = (
        expand(Dimer(1, mass), 10, k=k),
        struck_dimer(Power(k), mass),
    )
    true = pace**2 / force ** float(1 - 1 / sp.Rational(k)), width
    for i in which:
        total = (series.fwhm("force") if i else series.c2).at()
        assert holds(total.error, abs(total.value - true[i]))


@pytest.mark.parametrize(
    ("law", "mass", "velocity"),
    [
        (Power("3/2"), "1/2", 3.0),
        (named("hertz2", 1, "1/2"), "1/2", 1.3),
        (Power("5/2"), 2, 1.5),
    ],
)
def test_the_errors_of_a_wave_among_unlike_beads_under_a_load(law, mass, velocity):
    speed, force, width = struck_dimer(law, mass, 1.0, velocity, 80.0)
    wave = loaded_wave(
        Dimer(1, mass, spacing=1), force=1 + force, precompression=1, law=law
    )
    assert holds(wave.estimate("speed").error, abs(float(wave.speed) - speed))
    assert holds(wave.estimate("fwhm").error, abs(float(wave.fwhm()) - width))


# Law, strains behind and ahead; the results whose error is tested for being too large: a
# deviation may also pass through zero.
LEADING = ("doubling", "peak", "peak_force")
SHOCKS = {
    "hertz": (Power("3/2"), 3, 1, (*LEADING, "dispersion")),
    "hertz, no load": (Power("3/2"), 1, 0, LEADING),
    "k = 11/10": (Power("11/10"), 1, 0, ("peak",)),
    "k = 3": (Power(3), 1, 0, LEADING),
    "k = 7/2": (Power("7/2"), 1, 0, LEADING),
    "k = 6": (Power(6), 1, 0, LEADING),
    "weak load": (Power("5/2"), 36, 1, (*LEADING, "dispersion")),
    "polynomial": (named("polynomial", 1, 1), 1, 0, LEADING),
    "softening": (named("polynomial", -1, 0), "1/10", "2/5", (*LEADING, "dispersion")),
    "lennard-jones": (named("lennard-jones", 1), "1/5", 0, LEADING),
}


def driven(front, sites=600):
    """Run a chain without units whose wall moves at v_p until the leading pulse is so far."""
    end, n = sites / float(front.leading_speed()), math.ceil(1.15 * sites) + 40
    places = np.unique(np.linspace(0.25, 0.9, 12) * sites).astype(int)
    scene = Scene(
        masses=(1.0,) * n, stiffnesses=(1.0,) * (n - 1), wall=1.0, law=front.law, duration=end,
        drive=Drive(velocity=float(front.plateau)), samples=8 * sites + 1,
        precompression=float(front.law.at(front.ahead)), contact_sensors=(4, *map(int, places)),
    )  # fmt: skip
    return simulate(scene, rtol=1e-6)


def deviations(front):
    """Name → error, at most which the front is off a driven chain, and the deviation."""
    speed, top = leading(driven(front))
    # what the values may lack of those of the steady pulse: the half farther away tells
    speed, top = (Estimate(x.value, 3 * x.error) for x in (speed, top))
    strains = top.value, top.value + top.error
    push = Estimate.against(*(float(front.law.at(sp.Float(p))) for p in strains))
    found = {}
    for result, true in (
        (("leading_speed", "dispersion"), speed),
        (("leading_speed", "doubling"), speed),
        (("peak",), top),
        (("peak_force",), push),
    ):
        try:
            ours = front.estimate(*result)
        except InputError:
            continue
        deviation = abs(ours.value - true.value)
        doubt = true.error + 5e-5 * abs(true.value)
        assert deviation <= ours.error + doubt, (result, front)
        found[result[-1]] = ours.error, deviation
    return found


SLOW = "k = 7/2", "k = 6", "polynomial", "lennard-jones"


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=pytest.mark.slow) if n in SLOW else n for n in SHOCKS],
)
def test_the_errors_of_a_shock(name):
    law, *strains, tight = SHOCKS[name]
    found = deviations(shock(EQUAL, *strains, law=law))
    for key in tight:
        error, deviation = found[key]
        assert error <= LOOSE * deviation, key


@pytest.mark.slow
@pytest.mark.parametrize(("k", "behind"), [("3/2", 2), ("3/2", "14/5"), ("11/10", 189)])
def test_the_error_of_the_trailing_edge(k, behind):
    """The line through the lower half of the envelope reaches p₋ there, divided by the time."""
    front = shock(EQUAL, behind, 1, k=k)
    run = driven(front, 2000)
    rise = float(front.ahead) - np.diff(run.displacements) - float(front.behind)
    tops = scipy.signal.find_peaks(rise, height=0)[0]
    place, rise = (tops + 0.5) / run.scene.duration, rise[tops]
    part = np.digitize(place, np.linspace(place.min(), place.max(), 120))
    envelope = np.array(
        [(place[part == i].mean(), rise[part == i].max()) for i in np.unique(part)]
    )
    height = envelope[:, 1] / rise.max()
    slope, offset = np.polyfit(*envelope[(height > 0.15) & (height < 0.5)].T, 1)
    speed = front.estimate("trailing_speed")
    assert holds(speed.error, abs(speed.value + offset / slope))
