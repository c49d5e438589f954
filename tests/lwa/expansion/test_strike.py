"""The pulse of a strike: units, drops, errors, the limits of light and heavy strikers."""

import pytest

from lwa import Cell, pulse_of_strike
from tests.test_errors import holds
from validation import Scene, simulate

EQUAL = Cell([1], spacing=1)


def struck(mass, k):
    """Peak force of the leading pulse at the sixtieth contact of a struck chain."""
    beads = 100
    blow = Scene(
        masses=(mass, *beads * (1,)),
        stiffnesses=beads * (1,),
        k=k,
        duration=200 / min(mass, 1) ** 0.4,
        velocities=(1,),
        contact_sensors=(60,),
        samples=100001,
    )
    (force,) = simulate(blow).contact_force
    front = (force > 0.3 * force.max()).argmax()
    rising = force[front:-1] <= force[front + 1 :]
    return force[front + rising.argmin()]


@pytest.mark.parametrize(
    ("k", "mass"),
    [
        ("5/4", 0.5), ("5/4", 1), ("5/4", 1.3), ("5/4", 8), ("3/2", 0.02), ("3/2", 0.3), ("3/2", 4),
        ("3/2", 1000), ("5/2", 2), ("5/2", 50), ("5", 0.3), ("20", 50),
    ],
)  # fmt: skip
def test_the_error_of_a_strike(engine, k, mass):
    found = pulse_of_strike(EQUAL, mass, 1, k=k)
    peak = struck(mass, float(found.k))
    deviation = abs(found.force.value - peak)
    assert deviation <= found.force.error
    # next to m_eff, and at large k, the rule passes through the lattice's force
    assert mass == 1.3 or found.k > 5 or holds(found.force.error, deviation, 2e-5)
    assert found.train == (mass > 2)


def test_a_strike_in_si_units_and_by_its_drop():
    """F ~ v^{2k/(k+1)} (m^k A)^{1/(k+1)}, as dimensions demand; a drop h gives √(2 g h)."""
    one = pulse_of_strike(EQUAL, 1, 1)
    other = pulse_of_strike(Cell(["1/2000"], ["1e9"], "1/200"), "1/2000", 3)
    ratio = 3 ** (6 / 5) * (5e-4**1.5 * 1e9) ** (2 / 5)
    assert other.force.value == pytest.approx(ratio * one.force.value, rel=1e-12)
    assert other.fwhm("force", "length") == other.wave.estimate("fwhm", "force")
    share = other.force.relative_error / 6
    for found, exact in (
        (other.speed, other.wave.estimate("speed")),
        (other.fwhm(), other.wave.estimate("fwhm", "force", "time")),
    ):
        assert found.value == exact.value
        assert found.error == pytest.approx(exact.error + share * found.value)
    dropped = pulse_of_strike(other.chain, "1/2000", drop=0.5)
    same = pulse_of_strike(other.chain, "1/2000", (2 * 9.81 * 0.5) ** 0.5)
    assert dropped.force.value == pytest.approx(same.force.value, rel=1e-12)
    assert one._repr_latex_().count("&=") == 3
