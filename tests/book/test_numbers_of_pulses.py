"""Numbers of the pages on pulses, accuracy, laws and the laboratory, read and computed again."""

import math
import sys
from functools import cache

import numpy as np
import pytest
import sympy as sp

import lwa
from book.studies.hard import three_beads
from lwa import (
    Cell,
    Dimer,
    Material,
    Sphere,
    canonical_wave,
    expand,
    homogenize,
    loaded_wave,
)
from lwa.law import NAMES, named
from tests.book.prose import BOOK, bounds, limited, said, told
from validation import Damping, MeasureError, exact_wave, measure, simulate
from validation.pulses.noisy import noisy_pulse
from validation.scenes.chains import carrying, struck
from validation.waves.solver import resonances

sys.path.append(str(BOOK))  # the pages' own modules
from trust import trust

UNIFORM = Cell([1], spacing=1)
PAPER = sp.Rational(123, 450)
D, m1, m2 = sp.symbols("D m1 m2", positive=True)


@cache
def error(omega, theory):
    """Error in percent of a theory's width: 0 the paper's closure, 1 the canonical wave."""
    return 100 * trust("3/2", omega).errors[theory]


def off_in_speed(omega, wave):
    """Error in percent of a theory's speed at the peak force of the lattice."""
    pulse = trust("3/2", omega).pulse
    return 100 * (
        float(wave.at_force(1).speed) * pulse.force ** (1 / 6) / pulse.speed - 1
    )


def peaks(scene):
    run = simulate(scene)
    return [measure(run.time, force).peak for force in run.contact_force]


def wave_of(cell):
    return homogenize(cell, k="3/2").pde.traveling_wave()


# --- the pulse


def test_a_ball_that_falls():
    ball = Sphere("29.0e-3", "9.525e-3", Material(E="193e9", nu="0.3"))
    strike = lwa.pulse_of_strike(Cell.of_spheres([ball]), ball.mass, drop="0.1")
    duration, speed = 1e6 * strike.fwhm("force", "time").value, strike.speed.value
    words = (
        "peaks at # kN and stays above half of that for # µs; the pulse runs at # m/s"
    )
    assert told("intro", words, strike.force.value / 1000, duration, speed)
    in_a_rod = math.sqrt(193e9 / (29e-3 / (4 / 3 * math.pi * 9.525e-3**3)))
    assert abs(in_a_rod / speed - 7) < 0.1  # "a seventh"


def test_struck_beads():
    words = "left and peaks of # and #, contact 30 has a heavy bead on its left and a peak of #"
    scene = struck(
        (1, float(PAPER)), 80, contact_sensors=(15, 45, 30), duration=60, samples=2401
    )
    assert told("play", words, *simulate(scene).contact_force.max(axis=1))
    words = "$#$ for weak pulses, where $k = #$ prevails, to $#$ for strong ones with $k = #$"
    weak, slow, strong, fast = (sp.Rational(x) for x in said("play", words))
    assert (weak, strong) == ((slow - 1) / (2 * slow), (fast - 1) / (2 * fast))
    errors = []
    for mass in (1.0, 1.304, 2.0):
        strike = lwa.pulse_of_strike(UNIFORM, sp.Rational(str(mass)), velocity=1)
        row = mass, *(1.0,) * 119
        (peak,) = peaks(
            struck(row, 120, contact_sensors=(60,), duration=90.0, samples=4001)
        )
        errors.append(100 * (float(strike.force.value) / peak - 1))
    limited("calculator", "the force is within # percent of the lattice", errors)


def errors_of_the_arch(k):
    """Errors in percent of the width of the force, the shift of the beads and the speed."""
    arch, lattice = canonical_wave(UNIFORM, str(k)).at_force(1), exact_wave([1], k)
    x = np.linspace(-lattice.half_period, lattice.half_period, 8001)
    shifts = (np.trapezoid(y, x) for y in (arch.along(x, "strain"), lattice.strain(x)))
    pairs = (arch.fwhm("force"), lattice.fwhm("force")), shifts, (arch.speed, lattice.c)
    return [100 * (float(ours) / theirs - 1) for ours, theirs in pairs]


def test_the_arch_of_equal_beads():
    arch, lattice = canonical_wave(UNIFORM, "3/2"), exact_wave([1], 1.5)
    widths = arch.fwhm("force"), lattice.fwhm("force")
    assert told(
        "equal", "the force is $#D$ by the arch and $#D$ on the lattice", *widths
    )
    *errors, wider, shift, faster = (
        e for k in (1.02, 1.04, 1.5) for e in errors_of_the_arch(k)
    )
    words = "shift and speed are $#$, $#$ and $#$ percent, at $k = 1.04$ they are $#$, $#$ and $#$"
    assert told(
        "equal", f"{words}, for spheres $#$, $#$ and $#$", *errors, wider, shift, faster
    )
    assert told("equal", "The arch is # % too wide at half height", wider)
    assert told(
        "calculator",
        "wave is # % slower than the lattice's and # % wider",
        -faster,
        wider,
    )
    (edge,) = said("equal", "The width is one percent off at $k = #$")
    assert abs(errors_of_the_arch(float(edge))[0] - 1) < 0.01
    assert told("equal", "the arch covers $\\pi/\\beta \\approx #$ beads", arch.sites)
    root, spacings = map(
        int, said("equal", "$\\beta = \\sqrt{#}/(#D)$: the arch covers")
    )
    assert arch.beta == sp.sqrt(root) / spacings


def test_the_papers_pulse():
    assert told("paper", "figure the arch is # percent narrower", -error(PAPER, 0))
    wave = wave_of(Dimer(m1, m2))
    assert told(
        "paper", "\\ge \\sqrt #$ grow instead", sp.limit(D**2 / wave.I, m1, 0)
    )  # κ²
    root, parts = map(int, said("closure", "the paper's closure gives $\\sqrt#/#$"))
    assert sp.limit(wave.beta.subs(m2, 1), m1, 0) == sp.sqrt(root) / (parts * D)
    words = "$k = #$ it ends at $\\omega = #$, where $V_s^2 = 0$, and for $k = #$ at $\\omega = #"
    first, last, second, end = map(int, said("paper", words))
    wave = homogenize(Dimer(m1, m2)).pde.traveling_wave()
    assert wave.at(k=first, m1=1, D=1).speed_factor.subs(m2, last) == 0
    assert wave.at(k=second, m1=1, D=1).coefficient_sum.subs(m2, end) == 0


def test_the_number_of_a_cell():
    """Contacts of two stiffnesses; mass below a stretched place, less the place, has variance I."""
    square, part, n, most = map(
        int, said("cells", "by $\\sqrt{#}/#$ for $n = #$, and by $#$ for")
    )
    stiffer = sp.Symbol("n", positive=True)
    I = canonical_wave(Cell([1, 1], stiffnesses=[1, stiffer], spacing=1), "3/2").I * 12
    assert sp.nsimplify(I.subs(stiffer, n)) == sp.Rational(square, part**2)
    assert sp.limit(I, stiffer, sp.oo) == most**2
    for cell in (Cell([1, 2, 3], stiffnesses=[1, 8, 27]), Dimer(1, 7, N=3)):
        x, shares = sp.Symbol("x"), cell.shares(sp.Rational(3, 2))
        above = cell.size * np.cumsum(cell.fractions) - np.cumsum([0, *shares[:-1]])
        parts = list(zip(above, shares, strict=True))
        mean, square = (
            sum(sp.integrate((a - x) ** n, (x, 0, c)) for a, c in parts) / cell.size
            for n in (1, 2)
        )
        assert square - mean**2 == canonical_wave(cell, "3/2").I / cell.spacing**2


# --- its accuracy


@pytest.mark.slow
def test_decay_and_width_between_the_special_ratios():
    words = "to $#$ the pulse loses more than # percent of its force at every site, at $#$, $#$ and"
    high, least, *calm = said("exact", words)
    for ratio in (*calm, "0.8", "0.55", "0.57", "0.6", "0.62", high):
        decay = 100 * trust("3/2", ratio).pulse.decay
        assert (decay > float(least)) == (ratio not in {*calm, "0.8"}), ratio
    two, one = said("exact", "The width jumps between $#$ and $#$")
    assert trust("3/2", two).pulse.width > 2.4 > 1.65 > trust("3/2", one).pulse.width


def test_the_special_ratios():
    """Turning points of the light bead under the pulse, and its oscillations about the middle."""
    xi, counts, special = np.linspace(-9, 9, 9001), [], resonances(1.5, 4)
    assert told(
        "exact", "at the special ratio $\\omega = #$ the pulse has", special[0].omega
    )
    for n, wave in enumerate(special):
        left, right = wave.strain(xi - 0.5), wave.strain(xi + 0.5, 1)
        off = (left - right) / 2
        turns = (np.diff(off)[1:] * np.diff(off)[:-1] < 0) & (np.abs(off[1:-1]) > 1e-4)
        assert turns.sum() == 4 + 2 * n
        rate = (
            np.sqrt(3 * np.sqrt(np.clip(left + right, 0, None) / 2) / wave.omega)
            / wave.c
        )
        counts.append(np.trapezoid(rate, xi) / (2 * np.pi))
    assert told("exact", "under the pulse: #, #, # and # at the four ratios", *counts)
    third, last = (wave.omega for wave in special[2:])
    guess = third * (counts[2] / (counts[2] + 1)) ** 2
    words = "should be $#\\,(#/#)^2 = #$; it is #"
    assert told("exact", words, third, counts[2], counts[2] + 1, guess, last)


@pytest.mark.slow
def test_the_special_ratios_of_other_exponents():
    xi, found = np.linspace(-9, 9, 9001), [resonances(k, 2) for k in (1.5, 2, 2.5, 3)]
    for n, words in enumerate(
        ("the largest ratio is #, #, #, #,", "the second is #, #, #, #:")
    ):
        assert told("open", words, *(waves[n].omega for waves in found))
        for waves in found:
            off = waves[n].strain(xi - 0.5) - waves[n].strain(xi + 0.5, 1)
            turns = np.diff(off)[1:] * np.diff(off)[:-1] < 0
            assert np.count_nonzero(turns & (np.abs(off[1:-1]) > 2e-4)) == 4 + 2 * n


STRIP = [
    "1/100",
    "1/30",
    "1/10",
    "1/5",
    "3/10",
    "2/5",
    "1/2",
    "7/10",
    "4/5",
    "9/10",
    "1",
]


@pytest.mark.slow
def test_the_map_of_widths():
    words = "For $\\omega \\le #$ and $\\omega \\ge #$ the width by the series is within # percent"
    low, high, off = said("expansion", words)
    summed = [
        w for w in (*STRIP, "0.08", low, high, "0.88") if not math.isnan(error(w, 2))
    ]
    assert sorted({float(sp.Rational(w)) for w in summed})[2:4] == [
        float(low),
        float(high),
    ]
    assert bounds((error(w, 2) for w in summed), off)
    (own,) = said("expansion", "estimate of its error is larger, up to # percent")
    assert bounds((100 * trust("3/2", w).estimate for w in summed), own)
    first, last = said(
        "expansion", "From $\\omega = #$ to $#$ the paper's closure is within"
    )
    assert error(first, 0) * error(last, 0) < 0
    assert all(
        abs(error(w, 0)) < 2 for w in (first, "0.12", "0.14", "0.16", "0.18", last)
    )
    words = "and is $#$ percent at $\\omega = 0.25$ and $#$ percent"
    assert told("expansion", words, error("0.25", 0), error(PAPER, 0))
    between = (*STRIP[3:8], "0.55", "0.57", "0.62", "0.65")
    most = max(abs(error(w, n)) for w in between for n in (0, 1))
    assert told("expansion", "the closed forms err by up to # percent, both", most)
    assert all(
        error(w, 1) < error(w, 0) < 0 for w in ("0.15", "0.2", "0.27", "0.35", "0.5")
    )


@pytest.mark.slow
def test_the_map_of_speeds():
    words = "within # percent of the lattice and the canonical wave within # percent"
    cells = {w: Dimer(1, w, spacing=1) for w in STRIP}
    papers = [off_in_speed(w, wave_of(cell)) for w, cell in cells.items()]
    canonical = [
        off_in_speed(w, canonical_wave(cell, "3/2")) for w, cell in cells.items()
    ]
    limited("expansion", words, papers, canonical)


@pytest.mark.slow
@pytest.mark.parametrize("exponent", ["5/4", "3/2", "7/4", "2"])
def test_the_series_knows_its_error(exponent):
    for w in (
        "1/100",
        "1/20",
        "1/10",
        "1/5",
        "7/20",
        "1/2",
        "13/20",
        "4/5",
        "9/10",
        "1",
    ):
        found = trust(exponent, w)
        assert not abs(found.errors[2]) > found.estimate + 1e-4


def test_the_series_by_hand():
    """First corrections, the approximants [1/1], and where a width by [1/1] is one percent off."""
    L, K, series = sp.log(2), sp.Symbol("K"), expand(Cell([1]), 3)

    def pade(a, e):
        return (a[0] + (a[1] - a[0] * a[2] / a[1]) * e) / (1 - a[2] / a[1] * e)

    a, b, c, d = map(int, said("expansion", "c_{[1/1]} = \\frac{#k + #}{#k + #}"))
    assert (
        sp.cancel(pade(series.c.coefficients, K - 1) - (a * K + b) / (c * K + d)) == 0
    )
    f1, f2 = series.fwhm("force").coefficients[1:3]
    assert said("expansion", "f_1 = \\frac{# - \\ln 2}{#}, \\qquad") == ["6", "60"]
    words = "f_2 = -\\frac{#}{#} + \\frac{#\\ln 2}{#} + \\frac{#\\ln^2 2}{#}"
    a, b, c, d, e, f = map(int, said("expansion", words))
    assert (
        sp.expand(
            f2 + sp.Rational(a, b) - sp.Rational(c, d) * L - sp.Rational(e, f) * L**2
        )
        == 0
    )
    edges = said(
        "expansion", "off at $k = #$ (force, too wide) and $#$ (strain, too narrow)"
    )
    for quantity, written, sign in zip(
        ("force", "strain"), edges, (1, -1), strict=True
    ):
        width, k = series.fwhm(quantity), sp.Rational(written)
        a, b = map(int, said("expansion", f"$(#-\\ln2)/#$ for the {quantity}"))
        assert sp.expand(width.coefficients[1] - (a - L) / b) == 0
        summed = float(
            width.prefactor * pade(width.coefficients, k - 1) / sp.sqrt(k - 1)
        )
        off = summed / exact_wave([1], float(k)).fwhm(quantity) - 1
        assert abs(100 * sign * off - 1) < 0.01
    least, ratio = said("expansion", "and above # at $\\omega = #$")
    quotient = expand(Dimer(1, ratio), 1).fwhm("force").coefficients[1] / f1
    assert float(least) < quotient < float(least) + 1


# --- other chains


@pytest.mark.slow
def test_other_laws():
    theta = sp.Symbol("theta", positive=True)
    B = 2 * sp.log(sp.cosh(theta))
    ours, todas = (
        2 * (sp.cosh(theta) ** 2 - 1 - B) / B**2,
        (sp.sinh(theta) / theta) ** 2,
    )
    power, parts = map(int, said("laws", "and differ by $\\theta^#/#$"))
    assert sp.series(todas - ours, theta, 0, 6).removeO() == theta**power / parts
    wave = loaded_wave(
        UNIFORM, rise=B.subs(theta, 1.0), background=0, law=named("exponential", 1)
    )
    exact = (
        np.sinh(1),
        *(2 * np.arccosh(np.sqrt([1 + np.cosh(1), 2]))),
    )  # speed and both widths
    found = float(wave.speed), float(wave.fwhm("strain")), float(wave.fwhm("force"))
    words = "speed is # percent too small, its widths of the strain and of the force are # and #"
    assert told("laws", words, *(100 * np.abs(np.divide(found, exact) - 1)))
    text = (BOOK / "laws.md").read_text()
    assert all(f"| `{name}` |" in text for name in NAMES if name != "general")
    speed = loaded_wave(
        UNIFORM, rise="65/99", background=0, law=named("polynomial", 1, -1)
    ).speed
    (front,) = said("laws", "a front with $V_s^2 = Q(\\frac23) = #$")
    assert 0 < float(sp.Rational(front)) - float(speed**2) < 1e-3


@pytest.mark.slow
def test_the_lattice_carries_todas_soliton():
    words = (
        "over $#$ sites, and the force differs from {eq}`eq-toda` by less than $10^{#}$"
    )
    sites, power = map(int, said("laws", words))
    place, c = np.arange(120.0) - 30, np.sinh(1)
    before, after = ((c / np.cosh(place[:-1] - shift)) ** 2 for shift in (0, sites))
    velocities = c * (np.tanh(place) - np.tanh(place - 1))
    scene = carrying(
        (1.0,) * 120, np.log(1 + before), velocities, law=named("exponential", 1),
        duration=sites / c, samples=2, contact_sensors=range(119),
    )  # fmt: skip
    error = np.abs(simulate(scene, rtol=1e-9).contact_force[:, -1] - after).max()
    assert 10.0 ** (power - 2) < error < 10.0**power


# --- the laboratory and the reference


def test_what_a_record_needs():
    words = "at least # samples above half of its peak; noise above # % of the peak is refused"
    samples, noise = map(int, said("experiment", words))

    def read(samples, noise):
        t = (np.arange(-8 * samples, 6 * samples) + 0.5) / samples  # in widths
        random = noise / 100 * np.random.default_rng(0).normal(size=t.size)
        return noisy_pulse(t, np.exp(-4 * math.log(2) * t**2) + random)

    for enough in ((samples, 0.1), (50, noise - 0.5)):
        width = read(*enough).numbers["fwhm"]
        assert abs(width.value - 1) < 3 * width.error
    with pytest.raises(MeasureError, match="samples lie above half"):
        read(samples - 4, 0.1)
    with pytest.raises(MeasureError, match="the noise is"):
        read(50, noise + 1)


def test_numbers_beside_the_calculator():
    series = expand(UNIFORM, 8, k="3/2")
    energy = series.energy.at().value
    mass = series.momentum.at().value ** 2 / (2 * energy)
    assert told("calculator", "$m_\\text{eff} = #$ bead masses", mass)
    assert told("calculator", "where $\\mathcal E_1 = #$ is the energy", energy)
    pair, swapped = (Cell(masses, spacing=1) for masses in ([1, PAPER], [PAPER, 1]))
    slower = -off_in_speed(PAPER, canonical_wave(pair, "3/2"))
    assert told(
        "calculator", "steel:PTFE # % slower and # % narrower", slower, -error(PAPER, 1)
    )
    turned = wave_of(swapped).at_force(1).speed / wave_of(pair).at_force(1).speed
    assert abs(float(turned) - 0.5) < 0.02  # "half of that with steel first"


@pytest.mark.slow
def test_decay_by_restitution():
    words = "falls by $#\\,(1 - e_r)$ per bead, at any strength (**rule**, within # %"
    slope, off = map(float, said("recipes", words))
    for share, blow in ((0.98, 1.0), (0.95, 1.0), (0.95, 0.1)):
        near, far = peaks(struck(
            (1.0,), 100, velocities=(blow,), contact_sensors=(30, 80), samples=8001,
            duration=125.0 * blow**-0.2, damping=Damping("restitution", share),
        ))  # fmt: skip
        assert abs(math.log(near / far) / 50 / (slope * (1 - share)) - 1) < off / 100


def test_what_integration_costs():
    width = float(canonical_wave(UNIFORM, "1.001").fwhm("force"))
    assert told(
        "integration",
        "the pulse is # sites wide, and $B \\propto V_s^{#}$",
        width,
        2000,
    )
    limit = (
        2 * exact_wave([1], 1.5).c * 2 ** (-1.5 / 3)
    )  # two contacts in series: A_eff = A 2^-k
    pulse = trust("3/2", "1/1000").pulse
    below = 100 * (1 - pulse.speed / pulse.force ** (1 / 6) / limit)
    assert told("integration", "it is # % below at $\\omega = 10^{#}$", below, -3)
    chains = (struck((1.0, w), 40, duration=20.0, samples=2) for w in (1e-2, 1e-4))
    steps = [simulate(chain).step for chain in chains]
    assert 5.5 < steps[0] / steps[1] < 6.5  # "a sixth"
    drift = abs(simulate(three_beads(False, 1500.0), rtol=1e-5).energy_drift) / 1500
    words = "at `rtol=1e-5` by $#\\cdot10^{-8}$ per unit of time"
    assert told("integration", words, 1e8 * drift)
