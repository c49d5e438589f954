"""Hard cases in k: near 1, at 2 and 3, and at 20, for theory, Newton's method and lattice.

Lengths in D; m1 = A = D = 1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import scipy
import sympy as sp

from lwa import Dimer, homogenize
from validation.lattice.simulate import simulate
from validation.pulses.pulse import derived
from validation.pulses.time_of_flight import passage, ratio
from validation.report.panel import Curve, Panel
from validation.report.table import Finding, Statement
from validation.scenes.chains import carrying, launched, struck
from validation.studies.hard.case import Parts, case
from validation.studies.hard.floats import ALLOWED, closed_wave, exact, in_ulps, log_amplitude
from validation.studies.hard.motion import overflow
from validation.waves.asymptotics import LAWS
from validation.waves.profile import ExactWave
from validation.waves.solver import solve
from validation.waves.theory import Compacton, theory_at


def _theory_errors(wave: ExactWave) -> dict[str, float]:
    """Theory over a uniform chain's exact wave, less 1."""
    theory = Compacton(theory_at(sp.Rational(str(wave.k)), sp.Integer(1)), 1.0)
    errors = {f"FWHM of {q}": theory.fwhm(q) / wave.fwhm(q) - 1 for q in ("force", "strain")}
    return errors | {"speed V_s at B = 1": theory.speed / wave.c - 1}


_EPSILONS = (0.1, 0.01, 0.001)  # k - 1


@case(
    "They do, and the error vanishes as it must. B has 600,000 digits before or behind the point; "
    "its logarithm is as good as any number.",
    Panel("k - 1", "|theory/Newton - 1|", scale="xy"),
)
def near_linear() -> Parts:
    """k = 1.001, a pulse of 30 sites: do theory, Newton's method and the lattice still agree?"""
    errors = [_theory_errors(solve((1.0, 1.0), 1 + epsilon)) for epsilon in _EPSILONS]
    epsilon = _EPSILONS[-1]
    yield from _amplitudes(1 + epsilon)
    for i, (quantity, error) in enumerate(errors[-1].items()):
        order, size = LAWS[quantity].order, float(LAWS[quantity].coefficient)
        law, share = f"{size:.4g} (k-1)" + f"^{order}" * (order > 1), error / epsilon**order / size
        name = f"{quantity}: theory/Newton - 1 over its law, {law}"
        # the next term of the series is O(ε) of this one
        yield Finding(name, share, 1 - 3 * epsilon, 1 + 3 * epsilon)
        yield Curve.of(quantity, _EPSILONS, [abs(e[quantity]) for e in errors], f"C{i}{'os^'[i]}")
        yield Curve.of(law, _EPSILONS, abs(size) * np.power(_EPSILONS, order), f"C{i}-")
    yield from _from_theory(epsilon)


def _amplitudes(k: float) -> Iterator[Finding]:
    """B of two speeds, as a logarithm."""
    wave = closed_wave("paper's closure")
    point = np.array([k]), np.array([1.0])
    for at, low, high, key in (
        ("1e300", 308.0, math.inf, "log10_amplitude"), ("1e-300", -math.inf, -324.0, "")
    ):  # fmt: skip
        found = wave.numeric().log_amplitude(*point, float(at))
        loss = in_ulps(found, exact(wave, log_amplitude(wave, sp.Rational(float(at))), *point))
        name = f"log10 B at V = {at}, which float64 cannot hold as B"
        yield Finding(name, float(found[0]) / math.log(10), low, high, key=key)
        yield Finding(f"loss of ln B at V = {at}, in ulps", float(loss[0]), 0.0, ALLOWED)


def _from_theory(epsilon: float) -> Iterator[Finding]:
    """What the lattice makes of the theory's wave at k = 1 + ε."""
    theory = Compacton(theory_at(sp.Rational(str(1 + epsilon)), sp.Integer(1)), 1.0)
    start, sites = 160, 300
    bead = np.arange(2 * start + sites) - start
    passed = passage(carrying(
        (1.0,) * len(bead), theory.k, theory.compression(bead[:-1] + 0.5), theory.velocity(bead),
        contact_sensors=(start + 60, start + sites), samples=4001,
        duration=(sites + 0.7 * start) / theory.speed,
    ))  # fmt: skip
    at_one = derived(
        lambda V, u: V / u ** (epsilon / 2) / theory.speed - 1, passed.speed, passed.strain
    )
    lattice = "lattice, from the theory's wave"
    yield from (
        Finding.of(f"{lattice}: speed/theory - 1 at equal strain", at_one,
                   -(epsilon**2), epsilon**2, "lattice_speed_error"),
        Finding.of(f"{lattice}: FWHM of force/theory - 1",
                   ratio(passed.fwhm, theory.fwhm("force")), -epsilon, epsilon,
                   "lattice_fwhm_error"),
        Finding("energy drift", passed.energy_drift, -1e-9, 1e-9, key="energy_drift"),
    )  # fmt: skip


@case(
    "Nothing: at k = 2 the term of G is gone and at k = 3 some of the next order's; theory and "
    "lattice pass through both smoothly. The theory's error grows with k.",
    Panel("k", "theory/Newton - 1 (%)"),
)
def vanishing_terms() -> Parts:
    """k = 2 and k = 3, where terms of the wave equation vanish: does anything break?"""
    exponents: list[float] = [1.5, 1.75, 1.95, 2.0, 2.05, 2.5, 2.95, 3.0, 3.05, 3.5]
    waves = {k: solve((1.0, 1.0), k) for k in exponents}
    errors = {k: _theory_errors(wave) for k, wave in waves.items()}
    yield from map(_terms, ("5/2", "2", "3"))
    for k in (2.0, 3.0):
        for quantity, error in errors[k].items():
            sides = (errors[k - 0.05][quantity] + errors[k + 0.05][quantity]) / 2
            yield Finding(f"k = {k:g}, {quantity}: theory/Newton - 1", error)
            name = f"k = {k:g}, {quantity}: less its mean at k ± 0.05"
            # a smooth function's second difference over 0.05² is of the size of 1/10
            yield Finding(name, error - sides, -2.5e-4, 2.5e-4)
        passed = passage(launched(waves[k], 12, 60), 1e-7)
        for what, found, key in (
            ("speed", ratio(passed.speed, waves[k].c), "speed"),
            ("FWHM of force", ratio(passed.fwhm, waves[k].fwhm("force")), "fwhm"),
        ):
            name = f"k = {k:g}, lattice from Newton's wave: {what}/Newton - 1"
            yield Finding.of(name, found, -1e-6, 1e-6, f"{key}_error_k{k:g}")
    for quantity in errors[2.0]:
        yield Curve.of(quantity, exponents, [100 * errors[k][quantity] for k in exponents])


def _terms(k: str) -> Statement:
    """How many there are, and that only at k = 2 the one of G is not."""
    paper = homogenize(Dimer("m1", "m2"), k=k).pde
    full = homogenize(Dimer("m1", "m2"), 6, k=k, closure="full", field="center").pde
    three, five = (sum(c != 0 for c in full.coefficients[n].values()) for n in (3, 5))
    says = (
        f"G {'=' if paper.G == 0 else '≠'} 0 in both closures; canonical field: "
        f"{three} terms at D^(k+3), {five} at D^(k+5)"
    )
    return Statement(f"k = {k}", says, all((G == 0) == (k == "2") for G in (paper.G, full.G)))


@case(
    "It does: force and bead velocity are those of two beads alone. The force is less than 0.2 "
    "sites wide; a long-wave theory, several times too wide here, is not to be used.",
    Panel("ξ / D", "force of a contact"),
)
def hard_spheres() -> Parts:
    """k = 20, near hard spheres: does a pulse become a row of collisions of two?"""
    k = 20.0
    wave = solve((1.0, 1.0), 3.0)
    for exponent, points in ((5.0, 90), (8.0, 110), (12.0, 140), (k, 160)):
        wave = solve((1.0, 1.0), exponent, points=points, start=wave)
    # A collision of two equal beads whose force peaks at 1, as the wave's does.
    velocity = 2 / math.sqrt(k + 1)
    scene = launched(wave, 10, 40)
    passed = passage(scene, 1e-9)
    yield from (
        *_collision(k, 1.0), *_collision(k, 0.3),
        Finding("Newton's wave: bead velocity/that before a collision of two - 1",
                wave.peak("velocity")[1] / velocity - 1, -1e-5, 1e-5),
        Finding("Newton's wave: FWHM of force in time/that of a collision of two - 1",
                wave.fwhm("force") / wave.c / (collision_fwhm(k) / velocity) - 1, -1e-10, 1e-10,
                key="collision_error"),
        Finding("Newton's wave: FWHM of force, sites", wave.fwhm("force"), 0.0, 0.2, key="fwhm"),
        Finding.of("lattice from Newton's wave: speed/Newton - 1", ratio(passed.speed, wave.c),
                   -1e-5, 1e-5, "lattice_speed_error"),
        Finding.of("lattice from Newton's wave: FWHM of force/Newton - 1",
                   ratio(passed.fwhm, wave.fwhm("force")), -1e-4, 1e-4, "lattice_fwhm_error"),
        Finding("energy drift", passed.energy_drift, -1e-10, 1e-10, key="energy_drift"),
        Finding("evaluations of the forces per site", passed.evaluations / 40),
    )  # fmt: skip
    yield overflow("rtol = 1e-3 is too coarse here, and is told", scene, rtol=1e-3)
    for quantity, error in _theory_errors(wave).items():
        yield Finding(f"{quantity}: theory/Newton - 1", error)
    xi = np.linspace(-1, 1, 401)
    yield Curve.of("Newton", xi, wave.force(xi))
    yield Curve.of("theory", xi, Compacton(theory_at(20, 1), 1.0).contact_force(xi))


def _collision(k: float, omega: float) -> Iterator[Finding]:
    """Beads of masses 1 and ω on the lattice against the closed forms."""
    scene = struck((1, omega), 2, k, duration=6, contact_sensors=(0,), samples=2)
    run = simulate(scene, rtol=1e-9)
    # Apart, the beads leave with the relative velocity 1 at which they met.
    lasted = scene.duration + float(run.compression[0, -1])
    left = float(run.velocities[0]) - (1 - omega) / (1 + omega)
    name = f"two beads, 1 : {omega:g}"
    yield Finding(f"{name}: velocity of the first less its exact value", left, -1e-10, 1e-10)
    off = lasted / contact_time(k, omega) - 1
    yield Finding(f"{name}: time of contact/closed form - 1", off, -1e-10, 1e-10)


def contact_time(k: float, omega: float) -> float:
    """How long beads of masses 1 and ω touch that meet with relative velocity 1; A = 1.

    2 ∫ dδ / √(1 - (δ/d)^n), n = k + 1, from 0 to the deepest compression d: a beta function.
    """
    n = k + 1
    deepest = (n * omega / (1 + omega) / 2) ** (1 / n)
    return float(2 * deepest * scipy.special.beta(1 / n, 0.5) / n)


def collision_fwhm(k: float) -> float:
    """The FWHM in time of the force of a collision whose compression peaks at 1, times the
    relative velocity: twice ∫ dδ / √(1 - δ^n), n = k + 1, from half the force, δ^k = 1/2, to 1."""
    n = k + 1
    share = scipy.special.betaincc(1 / n, 0.5, 0.5 ** (n / k))
    return float(2 * scipy.special.beta(1 / n, 0.5) / n * share)
