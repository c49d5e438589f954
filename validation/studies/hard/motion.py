"""Hard cases of the integration: contacts that open, 10⁶ time units, and a light bead that rattles.

Chains of a few beads, small enough for many runs; A = 1 unless said otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.run import IntegrationError
from validation.lattice.simulate import simulate
from validation.pulses.pulse import measure
from validation.report.panel import Curve, Panel
from validation.report.table import Finding, Statement
from validation.scenes.scene import Scene
from validation.studies.hard.case import Parts, case

METHOD = "SRKN14"

# The mean error is that of runs from so many initial velocities, and of a step times these factors:
# what an opening costs depends on where in a step it falls.
_STARTS, _SHAKEN = 6, np.linspace(0.8, 1.25, 9)

_ORDERS: Sequence[tuple[float, bool, tuple[float, float], float]] = (
    (1.5, False, (0.2, 0.1), 6.0),
    (1.5, True, (0.2, 0.012), 2.5),
    (2.0, True, (0.15, 0.012), 3.0),
    (3.0, True, (0.15, 0.012), 4.0),
)
"""k, whether contacts open, coarsest and finest step, and the order that must come out."""


@case(
    "k + 1: 2.5 of 6 at k = 3/2. A smaller step, not a higher order, is what helps the splitting, "
    "whose step follows this law; the adaptive pair treats kinks on their own.",
    Panel("step", "error of the displacements at t = 8", scale="xy"),
)
def contact_loss() -> Parts:
    """Contacts that open and close again, where F = δ^k has only k derivatives: what is left of
    the splitting's order?

    Six unequal beads under a load against a wall. Light blows leave all contacts closed, and it
    has its own order 6; blows ten times as strong open them, and it has k + 1.
    """
    for k, opens, (coarse, fine), order in _ORDERS:
        steps = np.geomspace(coarse, fine, 5)
        errors, again = _errors(k, opens, steps)
        (slope, _), covariance = np.polyfit(np.log(steps), np.log(errors), 1, cov=True)
        how = "opening" if opens else "closed"
        name = f"{METHOD}, k = {k:g}, contacts {how}"
        yield Finding(f"{name}: order", float(slope), order - 0.35, order + 0.35,
                      math.sqrt(covariance[0, 0]),
                      f"order_{how}" if k == 1.5 else "")  # fmt: skip
        yield Finding(f"{name}: re-contacts in {_STARTS} runs", again,
                      *((_STARTS, math.inf) if opens else (0, 0)))  # fmt: skip
        if k == 1.5:
            yield Curve.of(how, steps, errors)


def _errors(k: float, opens: bool, steps: Array) -> tuple[Array, int]:
    """Root mean square error at each step, and how often a contact closed again."""
    squares, again = np.zeros(len(steps)), 0
    for start in np.random.default_rng(8).uniform(-1, 1, (_STARTS, 6)):
        scene = Scene(
            masses=(1.0, 0.3, 2.0, 0.7, 1.1, 0.5), stiffnesses=(1.0, 2.0, 0.5, 1.5, 3.0), wall=1.0,
            k=k, precompression=0.2 if opens else 1.0, contact_sensors=tuple(range(6)),
            velocities=tuple(start if opens else start / 10), duration=8.0, samples=401,
        )  # fmt: skip
        reference = simulate(scene, method=METHOD, step=5e-4)
        again += _closures(reference.compression)
        for i, step in enumerate(steps):
            for factor in _SHAKEN:
                run = simulate(scene, method=METHOD, step=step * factor)
                squares[i] += np.abs(run.displacements - reference.displacements).max() ** 2
    return np.sqrt(squares / _STARTS / len(_SHAKEN)), again


def _closures(compression: Array) -> int:
    """How often an open contact closes in a record."""
    closed = compression > 0
    return int(np.count_nonzero(closed[:, 1:] & ~closed[:, :-1]))


# Time units of `long_run`, in so many runs that hand on their state.
_LASTING, _SEGMENTS = 1e6, 200


@case(
    "As long as contacts stay closed it does not, while DOP853's drifts in proportion to the time. "
    "Contacts that open make it walk at random, some percent in 10⁶ at this step: no splitting is "
    "symplectic enough for a force without a second derivative.",
    Panel("time", "|energy error|, relative", scale="xy"),
)
def long_run() -> Parts:
    """10⁶ time units of three beads against a wall: does the energy drift?

    Where no contact opens the motion is smooth and the splitting symplectic: its energy error
    swings but stays. One that opens adds an error of order h^{k+1} of either sign.
    """
    smooth = _energy(_box(False, _LASTING / _SEGMENTS), 0.5)
    walk = _energy(_box(True, _LASTING / _SEGMENTS), 0.25)
    largest, tenth = float(np.abs(smooth).max()), _SEGMENTS // 10
    early, late = (float(np.abs(part).max()) for part in (smooth[:tenth], smooth[-tenth:]))
    time = _LASTING / _SEGMENTS * np.arange(_SEGMENTS + 1)
    half, full = (simulate(_box(False, T), method="DOP853").energy_drift for T in (5e2, 1e3))
    yield from (
        Finding(f"closed contacts, {METHOD} at 0.5: largest energy error", largest, 0.0, 5e-5,
                key="energy_error"),
        Finding("closed contacts: largest in the last tenth of the time over that in the first",
                late / early, 0.5, 1.5, key="last_over_first"),
        Finding("closed contacts: linear trend over all the time, over the largest error",
                float(np.polyfit(time, smooth, 1)[0]) * _LASTING / largest, -0.2, 0.2, key="trend"),
        Finding("closed contacts, DOP853 at 1e-9: drift after 1000 time units over that after 500",
                full / half, 1.9, 2.1),
        Finding("closed contacts, DOP853 at 1e-9: which makes after 10⁶", full * _LASTING / 1000.0),
        Finding(f"opening contacts, {METHOD} at 0.25: largest energy error",
                float(np.abs(walk).max()), 0.0, 0.3, key="energy_error_opening"),
        Finding("opening contacts: power of the time by which it spreads, 1/2 at random",
                spreading(walk), 0.3, 0.75, key="power_of_walk"),
        Curve.of("contacts closed", time[1:], np.abs(smooth[1:])),
        Curve.of("contacts opening", time[1:], np.abs(walk[1:])),
        Curve.of("closed, DOP853 at 1e-9, extrapolated", time[1:], abs(full) / 1000.0 * time[1:]),
    )  # fmt: skip


def _box(opens: bool, duration: float) -> Scene:
    return Scene(
        masses=(1.0, 0.3, 2.0), stiffnesses=(1.0, 2.0), wall=1.0, k=1.5, samples=2,
        precompression=0.2 if opens else 1.0, duration=duration,
        velocities=(0.0, 0.8, -0.6) if opens else (0.0, 0.1, -0.05),
    )  # fmt: skip


def _energy(scene: Scene, step: float) -> Array:
    """The energy's relative error at the ends of the segments, 0 first."""
    energy = [1.0]
    for _ in range(_SEGMENTS):
        run = simulate(scene, method=METHOD, step=step)
        energy.append(energy[-1] * (1 + run.energy_drift))
        displacements, velocities = tuple(run.displacements), tuple(run.velocities)
        scene = replace(scene, displacements=displacements, velocities=velocities)
    return np.array(energy) - 1


def spreading(walk: Array) -> float:
    """Exponent of the root mean square of its differences in their lag."""
    lags = 2 ** np.arange(6)
    spread = [math.sqrt(np.mean((walk[lag:] - walk[:-lag]) ** 2)) for lag in lags]
    return float(np.polyfit(np.log(lags), np.log(spread), 1)[0])


# Mass of the light bead; its two contacts' stiffness, name, and what peak and force may err by: in
# weak ones a step of the heavy beads' is too long to see an opening well.
_LIGHT, _CONTACTS = 1e-3, {1.0: ("stiff", 1e-8, 1e-6), 1e-4: ("weak", 1e-5, 1e-3)}


@case(
    "It is. In stiff contacts the light bead sets the step, a small part of the others'; at theirs "
    "the motion overflows, and that is told. In weak ones it is as slow as the others, but as it "
    "lets go and is caught the smooth error is lost: forces err by up to 1e-3 of the peak at some "
    "time, though the pulse's peak by less than 1e-5.",
    Panel("step", "largest error of a force, over the peak", scale="xy"),
)
def light_bead() -> Parts:
    """A bead of 1/1000 between heavy ones, in contacts as stiff or 10,000 times weaker: is its
    rattling resolved?

    Measured is the pulse behind it against DOP853 at 1e-12, at the step that the engine chooses and
    at the one it would choose without the light bead.
    """
    heavy = simulate(_with_light_bead(1.0, 1.0), method=METHOD, rtol=1e-6, window=False).step
    for stiffness, (key, peak_error, force_error) in _CONTACTS.items():
        scene, name = _with_light_bead(_LIGHT, stiffness), f"contacts of {stiffness:g}"
        reference = simulate(scene, method="DOP853", rtol=1e-12, atol=1e-12)
        runs = [simulate(scene, method=METHOD, rtol=10.0**-n, window=False) for n in (4, 5, 6, 7)]
        off = [np.abs(run.contact_force - reference.contact_force).max() for run in runs]
        errors = [float(error / reference.contact_force.max()) for error in off]
        run, error = runs[2], errors[2]
        # between its contacts, 3/2 √δ each
        springs = 1.5 * stiffness * np.sqrt(np.maximum(reference.compression[:2], 0.0))
        spring = float(springs.sum(axis=0).max())
        peak, exact = (measure(r.time, r.contact_force[2]).peak for r in (run, reference))
        yield from (
            Finding(f"{name}: closures of the light bead's contacts",
                    _closures(reference.compression[:2]), 10, key=f"{key}_closures"),
            Finding(f"{name}: peak force behind it, engine at 1e-6/DOP853 - 1",
                    peak / exact - 1, -peak_error, peak_error, key=f"{key}_peak_error"),
            Finding(f"{name}: largest error of a force at any time, over the peak", error,
                    0.0, force_error, key=f"{key}_force_error"),
            Finding(f"{name}: energy drift", run.energy_drift, -1e-4, 1e-4),
            Finding(f"{name}: step/time of the light bead, √(m/spring)",
                    run.step * math.sqrt(spring / _LIGHT)),
            Finding(f"{name}: step/that without the light bead", run.step / heavy),
            Curve.of(name, [run.step for run in runs], errors),
        )  # fmt: skip
    scene = _with_light_bead(_LIGHT, 1.0)
    yield overflow("contacts of 1, step without the light bead", scene, step=heavy)


def _with_light_bead(mass: float, stiffness: float) -> Scene:
    return Scene(
        masses=(*[1.0] * 10, mass, *[1.0] * 10), k=1.5, velocities=(1.0,), samples=4001,
        stiffnesses=(*[1.0] * 9, stiffness, stiffness, *[1.0] * 9), contact_sensors=(9, 10, 13),
        # The weaker the contacts, the longer the heavy beads take to exchange their momentum.
        duration=30.0 + 8 * (stiffness**-0.4 - 1),
    )  # fmt: skip


def overflow(name: str, scene: Scene, **options: Any) -> Statement:
    """That the engine refuses to go on at a step, or tolerance, that is too coarse."""
    try:
        run = simulate(scene, method=METHOD, window=False, **options)
    except IntegrationError as error:
        return Statement(name, str(error), True)
    return Statement(name, f"energy drift {run.energy_drift:.0e}", False)
