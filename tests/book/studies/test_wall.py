"""The pulse that a wall sends back: scaling, another integrator, and the modulus from the delay."""

import numpy as np
import pytest
import scipy

from book.studies.wall import BEAD, SOFTEST, STIFFEST, echo, modulus, wall
from lwa import Estimate
from validation.scenes.checks import SceneError


def test_softer_walls_answer_later():
    rows = wall().document()["rows"]
    delays = [row["delay_value"] for row in rows]
    assert np.all(np.diff(delays) < 0)
    assert all(row["delay_error_value"] < 1e-8 for row in rows)


def test_times_scale_with_the_blow_and_the_ratio_does_not_change():
    slow, fast = (echo(SOFTEST, velocity=v) for v in (1e-6, 5))
    assert slow[0].value / fast[0].value == pytest.approx(5e6**0.2, rel=1e-9)
    assert slow[1].value == pytest.approx(fast[1].value, rel=1e-9)


@pytest.mark.parametrize(("E", "compliance"), [(3e9, 1 / 3e9), (1e18, 0)])
def test_another_integrator_gives_the_same_echo(E, compliance):
    """Hertz's formula and Newton's equations by SciPy; a soft and a rigid wall."""
    n, m = 20, float(BEAD.mass)
    A = np.full(n, 4 / 3 * np.sqrt(9.525e-3 / 2) / (2 * 0.91 / 193e9))
    A[-1] = 4 / 3 * np.sqrt(9.525e-3) / (0.91 * (1 / 193e9 + compliance))

    def force(y):
        return A * np.maximum(y - np.append(y[1:], 0), 0) ** 1.5

    def rates(t, state):
        push = force(state[:n])
        return np.append(state[n:], (np.append(0, push[:-1]) - push) / m)

    start = np.zeros(2 * n)
    start[n] = 0.5
    times = np.linspace(0, 1.5e-3, 3001)
    span, fine = (0, times[-1]), dict(rtol=1e-9, atol=1e-13)
    found = scipy.integrate.solve_ivp(rates, span, start, "DOP853", times, **fine)
    values = [force(y)[9] for y in found.y[:n].T]
    F = scipy.interpolate.CubicSpline(times, values)
    flat = F.derivative().roots(extrapolate=False)
    first, second = (t for t in flat if F(t) > max(values) / 2 and F(t, 2) < 0)
    delay, ratio = echo(E)
    assert second - first == pytest.approx(delay.value, abs=2e-10)
    assert F(second) / F(first) == pytest.approx(ratio.value, rel=1e-5)


def test_the_modulus_is_read_from_the_delay_with_its_error():
    """The ± is the larger change of the modulus at both ends of the delay's error."""
    delay, _ = echo(70e9)
    read = modulus(Estimate(delay.value, 1e-6))
    assert read.value == pytest.approx(70e9, rel=1e-7)
    ends = [echo(read.value + side * read.error)[0].value for side in (1, -1)]
    assert delay.value - ends[0] == pytest.approx(
        1e-6, rel=1e-3
    )  # the stiffer wall errs more
    assert 1e-6 < ends[1] - delay.value < 1.1e-6
    assert 1e-2 < read.relative_error < 5e-2


@pytest.mark.parametrize("E", [SOFTEST / 2, 2 * STIFFEST])
def test_delays_of_no_wall_are_refused(E):
    delay, _ = echo(E)
    with pytest.raises(SceneError, match="delay is"):
        modulus(delay)
