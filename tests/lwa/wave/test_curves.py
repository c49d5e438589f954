"""A wave in numbers: curves over time, forces of beads."""

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Dimer, InputError, Material, Sphere, canonical_wave, homogenize
from lwa.base.words import QUANTITIES
from tests.identity import same

STEEL = Material.named("steel 316")
BALL = Sphere.solid("0.01", STEEL)
CHAIN = canonical_wave(Cell.of_spheres([BALL]), "3/2")
UNEQUAL = canonical_wave(
    Cell.of_spheres([BALL, Sphere.solid("0.01", Material.named("PTFE"))]), "3/2"
)
THEORIES = (
    CHAIN,
    UNEQUAL,
    canonical_wave(Dimer(1, "1/3", spacing=2), 2),
    homogenize(Dimer(3, 1, spacing="1/2"), k="5/4").pde.traveling_wave(),
)


@pytest.mark.parametrize("wave", THEORIES)
def test_a_curve_is_the_profile_as_it_passes(wave):
    answer = wave.at_force(12)
    times = np.linspace(-1.5, 1.5, 7) * float(answer.fwhm("strain", "time"))
    strain = answer.curve(times, "strain")
    speed = float(answer.speed)
    profile = sp.lambdify("xi", wave.profile("xi", answer.strain))
    known = [float(profile(xi)) for xi in speed * times]
    assert strain == pytest.approx(known, rel=1e-10, abs=1e-20)
    A, k, D = (float(x) for x in (wave.cell.stiffness(wave.k), wave.k, wave.D))
    # F = A δ^k
    assert answer.curve(times) == pytest.approx(A * (D * strain) ** k, rel=1e-12)
    velocity = answer.curve(times, "velocity")
    assert velocity == pytest.approx(speed * strain, rel=1e-13)
    for quantity in QUANTITIES:
        half = float(answer.fwhm(quantity, "time")) / 2
        peak, fallen = answer.curve([0, half], quantity)
        assert fallen == pytest.approx(peak / 2, rel=1e-12)
        assert answer.along(half * speed, quantity) == pytest.approx(fallen, rel=1e-12)


@pytest.mark.parametrize("wave", THEORIES)
def test_a_bead_bears_the_mean_of_its_contacts(wave):
    answer = wave.at_force(5)
    shift = float(wave.D / answer.speed) / 2
    t = np.linspace(-1, 1, 51) * float(answer.fwhm("force", "time")) * 2
    mean = (answer.curve(t - shift) + answer.curve(t + shift)) / 2
    assert np.allclose(answer.curve(t, of="bead"), mean, rtol=0, atol=5e-13)
    assert float(answer.bead_force) == pytest.approx(mean.max(), rel=1e-12)
    back = wave.at_force(answer.bead_force, of="bead")
    assert float(back.contact_force) == pytest.approx(5, rel=1e-14)


def test_symbols_in_the_force_of_a_bead():
    answer = canonical_wave(Cell(["m"], ["A"]), "3/2").at_force("F", of="bead")
    share = sp.cos(sp.sqrt(10) / 10) ** 6
    assert same(answer.contact_force * share, sp.Symbol("F", positive=True))


def test_where_contacts_peak_one_after_the_other_a_bead_has_no_peak_force():
    wave = canonical_wave(Cell([1], spacing=1), 5)
    curve = wave.at_force(1).curve(np.linspace(-2, 2, 401), of="bead")
    assert curve[200] < 0.9 * curve.max()
    with pytest.raises(InputError, match="peak one after the other"):
        wave.at_force(1, of="bead")
