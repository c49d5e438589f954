"""A chain under its own weight: shape and width of a weak blow's front, and strong blows."""

import numpy as np
import pytest
import scipy

from book.studies.gravity import front_width, gravity


@pytest.mark.parametrize("k", [1.0, 1.1, 1.5, 1.75])
def test_the_top_takes_part_of_airys_front(k):
    """The continuum's own waves from the top, T^ν H_ν(ωT) at travel time T, over their momentum
    flux T^{1-2ν} d/dT of them at T → 0, with the phase ω³/3 of the way: the same front far down.
    At k = 1 it is Airy's function."""
    nu, top, far = 1 / (k + 1), 1e-12, 1e9
    y, weight = np.polynomial.legendre.leggauss(300)
    r, dr = 2 * (y + 1) ** 2, 4 * (y + 1) * weight  # smooth at 0
    omega = r * np.exp(1j * np.pi / 6)
    here = far**nu * scipy.special.hankel1e(nu, omega * far)
    flux = omega * top ** (1 - nu) * scipy.special.hankel1e(nu - 1, omega * top)
    spectrum = (
        -1j
        * omega
        * here
        / flux
        * np.exp(1j * omega**3 / 3)
        * np.exp(1j * np.pi / 6)
        * dr
    )
    z = np.linspace(-2.5, 4, 1301)
    front = (np.exp(1j * np.outer(z, omega)) @ spectrum).real
    front /= front[np.argmax(np.abs(front))]
    crossings = scipy.interpolate.CubicSpline(z, front - 0.5).roots(extrapolate=False)
    summit = z[np.argmax(front)]
    width = crossings[crossings > summit].min() - crossings[crossings < summit].max()
    assert front_width(k) == pytest.approx(width, rel=1e-4)


@pytest.fixture(scope="module")
def found():
    """The study's document on equal beads."""
    return gravity(masses=(1,), beads=1500).document()


def test_a_weak_blow(found):
    """The third root, and a prefactor that no other speed law would give."""
    assert found["ok"]
    (row,) = found["rows"]
    for name, theory in (
        ("exponent", 1 / 3),
        ("prefactor", row["prefactor_theory_value"]),
    ):
        assert abs(row[f"{name}_value"] - theory) < 2 * row[f"{name}_error_value"]
    assert row["exponent_error_value"] < 3e-3
    assert row["error_value"] == pytest.approx(0, abs=5e-3)
    constant = front_width(1.0) * (1 / 8) ** (
        1 / 3
    )  # Airy's at constant speed: (3 I x/2)^{1/3}
    assert row["prefactor_value"] > 1.2 * constant


def test_a_strong_blow_is_the_solitary_wave_of_its_depth(found):
    """Until that is wider than a weak blow's front, which the weakest of the three follows."""
    strong = found["strong"]
    deep = {row["blow_value"]: row for row in strong}  # the last place of each
    assert deep[1000]["width_value"] == pytest.approx(
        deep[1000]["solitary_value"], rel=0.03
    )
    assert deep[10]["width_value"] == pytest.approx(deep[10]["front_value"], rel=0.08)
    assert deep[10]["solitary_value"] > 2 * deep[10]["width_value"]
    last, end = [row for row in strong if row["blow_value"] == 10][-2:]
    growth = np.log(end["solitary_value"] / last["solitary_value"])
    assert growth > 0.45 * np.log(
        end["site_value"] / last["site_value"]
    )  # the front's is 1/3
    forces = [
        row["ratio_value"] * row["site_value"] for row in strong[-len(strong) // 3 :]
    ]
    assert (
        0.8 * forces[0] < forces[-1] < forces[0]
    )  # the strongest blow nearly keeps its force
