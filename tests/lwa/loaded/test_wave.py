"""Waves of any lattice: the chains of one law, rarefactions, resonators, packings, their errors."""

import math

import mpmath
import numpy as np
import pytest
import sympy as sp

from book.studies.links import exact
from lwa import (
    Cell,
    InputError,
    Lattice,
    Link,
    Power,
    Resonator,
    canonical_wave,
    hexagonal,
    loaded_wave,
)
from lwa.base.words import QUANTITIES
from lwa.law import named
from validation import exact_wave

HERTZ = Power("3/2")
LAWS = (named("hertz2", 1, "1/2"), named("exponential", "1/2"), named("magnetic", 4, 3))


def random_chain(seed):
    """A cell of 1 … 4 particles, a law, a peak force and a load."""
    draw = np.random.default_rng(seed)
    P = int(draw.integers(1, 5))
    masses, A = np.exp(draw.uniform(-1.5, 1.5, (2, P))).round(3)
    F = sp.Rational(str(round(draw.uniform(0.5, 3), 2)))
    law, loads = Power(str(round(draw.uniform(1.1, 5), 1))), ["0", "1/100", "1/2"]
    if seed % 3 == 0:  # unlike contacts have powers
        A, law, loads = [2] * P, LAWS[seed // 3 % 3], ["1/10", "1/2"]
    return Cell(masses, A, "3/2"), law, F, F * sp.Rational(str(draw.choice(loads)))


# laws that soften: B < 0
FALLING = (Cell([1, 2], spacing=1), Power("1/2"), sp.S.Half, sp.S.One)
CHAINS = [random_chain(seed) for seed in range(4)]


@pytest.mark.parametrize(("cell", "law", "F", "load"), [*CHAINS, FALLING], ids=str)
def test_a_chain_of_one_law_is_the_canonical_wave(cell, law, F, load):
    """The lattice's statics and quadrature, and the closed forms of cells."""
    lattice = Lattice.of_cell(cell, law)
    waves = [
        loaded_wave(lattice, force=F, precompression=load),
        loaded_wave(cell, force=F, precompression=load, law=law),
    ]
    if isinstance(law, Power) and law.k > 1:
        compact = canonical_wave(cell, law.k)
        waves.append(compact.at_force(F, precompression=load))
    rows = []
    for wave in waves:
        row = [wave.speed, wave.strain, wave.fwhm("force", "time")]
        row += [wave.fwhm(quantity) for quantity in QUANTITIES]
        if load:
            row.append(wave.sound_speed)
        rows.append([float(sp.N(value, 20)) for value in row])
    for row in rows[1:]:
        assert row == pytest.approx(rows[0], rel=1e-12)


def test_a_profile_has_its_own_width():
    pair = Lattice([1, 2], [Link(0, 1, HERTZ), Link(1, 2, Power(3))], spacing="1/2")
    wave = loaded_wave(pair, force=2, precompression=1)
    for quantity, peak in (
        ("force", 1),
        ("strain", wave.strain),
        ("velocity", wave.bead_velocity),
    ):
        half = float(wave.fwhm(quantity)) / 2
        found = wave.along([0.0, half, -half], quantity)
        assert found == pytest.approx(float(peak) * np.array([1, 0.5, 0.5]), rel=1e-12)


def test_the_width_with_resonators_obeys_its_integral():
    """(F′I + R V⁴) v′² = m̄V² v² - 2W of F = δ²: ξ = ∫ √(J/(Q(1) - Q(v))) dv/v by mpmath."""
    square = mpmath.mpf(2) / 3  # m̄V² = 2W/B², W = δ³/3, and m̄ = 3/2

    def rate(t):  # v = 1 - t² takes the root out of the peak
        v = 1 - t * t
        J = v / 6 + (square / 1.5) ** 2 / 80  # R = (1/2)²/20
        return 2 * mpmath.sqrt(J / square) / v

    width = 2 * mpmath.quad(rate, [0, mpmath.sqrt(0.5)])
    for P in (1, 2):
        links = [Link(n, n + 1, Power(2)) for n in range(P)]
        resonators = [Resonator(n, "1/2", 20) for n in range(P)]
        wave = loaded_wave(Lattice([1] * P, links, resonators), force=1)
        assert float(wave.speed) == pytest.approx(2 / 3, rel=1e-14)
        assert float(wave.fwhm("strain")) == pytest.approx(float(width), rel=1e-12)


def test_slow_resonators_are_refused():
    def chain(stiffness):
        return Lattice(
            [1], [Link(0, 1, HERTZ)], [Resonator(0, 1, stiffness)], spacing=2
        )

    rate = math.sqrt(4 / 5 / 2)  # V/D of spheres of the mass 2 with A = 1
    least = (1.2 * 2 * math.pi * rate) ** 2 / 2
    assert loaded_wave(chain(str(round(least * 1.01, 6))), force=1).speed > 0
    with pytest.raises(InputError, match="resonator"):
        loaded_wave(chain(str(round(least * 0.99, 6))), force=1)


def test_plane_waves_of_hexagonal_packings():
    """Across: A_eff = 2A(√3/2)^{k+1}, a√3/2 apart. Along: 2A(½)^{k+1}, and A of range 2."""
    a = math.sqrt(3) / 2
    near, far = Link(0, 1, HERTZ, str(2 * 0.5**2.5)), Link(0, 2, HERTZ)
    chains = {
        "across": Lattice([1], [Link(0, 1, HERTZ, str(2 * a**2.5))], spacing=str(a)),
        "along": Lattice([1], [near, far], spacing="1/2"),
    }
    for direction, chain in chains.items():
        rows = []
        for lattice in (hexagonal(HERTZ, direction), chain):
            wave = loaded_wave(lattice, force=2, precompression=1)
            rows.append(list(map(float, (wave.speed, wave.sound_speed, wave.fwhm()))))
        assert rows[0] == pytest.approx(rows[1], rel=1e-12)
    other = hexagonal(2, "across", mass=2, diameter=3)
    assert other.equilibrium(1).compressions[0] ** 2 * sp.sqrt(3) == 1
    assert (other.mass, other.spacing) == (2, 3 * sp.sqrt(3) / 2)


CUBIC = Power(3)
CURVED = named("polynomial", 0, 1)  # F″ = 0 at the start
INFLECTED = named("polynomial", "-3/10", "3/10")  # F″ < 0 there


def alike(*masses):
    return Lattice.of_cell(Cell(masses, spacing=1), HERTZ)


def pair(law, first=HERTZ, factor=1):
    return Lattice([1, 1], [Link(0, 1, first), Link(1, 2, law, factor)])


def chain(law, second=None):
    farther = [] if second is None else [Link(0, 2, law, second)]
    return Lattice([1], [Link(0, 1, law), *farther])


HARD = pair(CUBIC)


@pytest.mark.parametrize(
    ("lattice", "force", "load"),
    [
        (alike(1, 2, 3), 2, 1),
        (HARD, 9, 1),
        (Lattice([1], [Link(0, 1, HERTZ)], [Resonator(0, 1, 1000)]), 2, 1),
        # It radiates.
        (alike(1, 2), 1, 0),
        (chain(Power("1/2")), "1/2", 1),
        (HARD, 1, 0),
    ],
    ids=str,
)
def test_errors_are_nan_where_nothing_was_measured(lattice, force, load):
    wave = loaded_wave(lattice, force=force, precompression=load)
    assert math.isnan(wave.estimate("fwhm").error)
    # Only the speed of a pair of equal masses without load is known.
    bare_pair = lattice == HARD and not load
    assert math.isnan(wave.estimate("speed").error) != bare_pair


def test_unlike_masses_without_load_have_no_bound_near_k_1():
    wave = loaded_wave(Cell([1, 2], spacing=1), force=1, k="1.04")
    assert math.isnan(wave.estimate("speed").error)


def covers(estimate, true):
    missed = abs(estimate.value - true)
    assert missed < estimate.error < 5 * missed


def slow(*row):
    return pytest.param(*row, marks=pytest.mark.slow)


@pytest.mark.parametrize(
    ("lattice", "force", "load"),
    [
        (HARD, 1.5, 1.0),
        slow(HARD, 1.02, 1.0),
        slow(HARD, 3.0, 1.0),
        slow(pair(HERTZ, factor=8), 3.0, 1.0),
        slow(pair(Power(6)), 2.0, 1.0),
        slow(pair(Power(1)), 1.5, 1.0),
        (pair(Power(1), factor=3), 1.2, 1.0),
        (chain(HERTZ), 1.0, 0.0),
        (pair(CURVED, CURVED), 0.1, 0.0),
        slow(pair(INFLECTED, INFLECTED), 1.8375, 0.0),
        (chain(HERTZ), 1.5, 1.0),
        slow(chain(CUBIC), 1.0, 0.0),
        slow(chain(HERTZ, "1/4"), 1.2, 1.0),
        (chain(HERTZ, "1/4"), 3.0, 1.0),
        (chain(HERTZ, "1/4"), 1.0, 0.0),
    ],
    ids=str,
)
def test_errors_cover_the_exact_wave(lattice, force, load):
    known = exact(lattice, force, load)
    wave = loaded_wave(lattice, force=force, precompression=load)
    speed = wave.estimate("speed")
    covers(speed, math.sqrt(known.square))
    width = wave.estimate("fwhm", known.of)
    covers(width, known.fwhm)
    # The time of passage is a quotient, and relative errors add.
    time = wave.estimate("fwhm", known.of, "time")
    relative = width.error / width.value + speed.error / speed.value
    assert time.error / time.value == pytest.approx(relative)


def test_errors_of_all_widths_cover_the_wave_of_equal_beads():
    """Velocities are narrower than strains, for which the theory has the same width."""
    known = exact_wave([1], 5, background=0.4)
    wave = loaded_wave(chain(Power(5)), force=1, precompression=0.4**5)
    for quantity in QUANTITIES:
        covers(wave.estimate("fwhm", quantity), known.fwhm(quantity))


def test_four_particles_with_an_exponential_second_neighbour():
    """Far beyond the wave its forces are infinite: no warning, and the wave of one particle."""
    law = named("exponential", 1)
    waves = []
    for P in (1, 3, 4):
        links = [Link(i, i + n, (HERTZ, law)[n - 1]) for i in range(P) for n in (1, 2)]
        waves.append(loaded_wave(Lattice([1] * P, links), force=10))
    for wave in waves[1:]:
        assert float(wave.speed) == pytest.approx(float(waves[0].speed), rel=1e-12)
        assert float(wave.fwhm()) == pytest.approx(float(waves[0].fwhm()), rel=1e-11)
