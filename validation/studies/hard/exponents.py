"""Hard cases in k: near 1, at 2 and 3, and at 20, for theory, Newton's method and lattice.

The public functions that return a `Report` are cases of `validation.studies.hard.cases`. Lengths in
D; m1 = A = D = 1.
"""

from __future__ import annotations

import math

import numpy as np
import scipy
import sympy as sp

from lwa import Dimer, homogenize
from validation.lattice.simulate import simulate
from validation.pulses.pulse import derived
from validation.pulses.time_of_flight import METHOD, passage, ratio
from validation.report.panel import Curve, Panel
from validation.report.result import Report
from validation.report.table import Finding, Statement
from validation.scenes.chains import carrying, launched
from validation.scenes.scene import Scene
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


EPSILONS = (0.1, 0.01, 0.001)
"""k - 1, the last that of `near_linear`."""


def near_linear() -> Report:
    """k = 1.001: amplitudes in logarithms, and the theory's error against its own law."""
    errors = [_theory_errors(solve((1.0, 1.0), 1 + epsilon)) for epsilon in EPSILONS]
    epsilon = EPSILONS[-1]
    findings, curves = _amplitudes(1 + epsilon), []
    for i, (quantity, error) in enumerate(errors[-1].items()):
        order, size = LAWS[quantity].order, float(LAWS[quantity].coefficient)
        law, share = f"{size:.4g} (k-1)" + f"^{order}" * (order > 1), error / epsilon**order / size
        name = f"{quantity}: theory/Newton - 1 over its law, {law}"
        # the next term of the series is O(ε) of this one
        findings.append(Finding(name, share, 1 - 3 * epsilon, 1 + 3 * epsilon))
        curves += [
            Curve.of(quantity, EPSILONS, [abs(e[quantity]) for e in errors], f"C{i}{'os^'[i]}"),
            Curve.of(law, EPSILONS, abs(size) * np.power(EPSILONS, order), f"C{i}-"),
        ]
    return Report(
        "k = 1.001, a pulse of 30 sites: do theory, Newton's method and the lattice still agree?",
        findings=(*findings, *_from_theory(epsilon)),
        panels=(Panel("k - 1", "|theory/Newton - 1|", tuple(curves), "xy"),),
        notes=("They do, and the error vanishes as it must. B has 600,000 digits before or behind "
               "the point; its logarithm is as good as any number.",),
    )  # fmt: skip


def _amplitudes(k: float) -> list[Finding]:
    """B of two speeds, as a logarithm."""
    wave = closed_wave("paper's closure")
    point = np.array([k]), np.array([1.0])
    findings = []
    for power, low, high, key in (
        (300, 308.0, math.inf, "log10_amplitude"), (-300, -math.inf, -324.0, "")
    ):  # fmt: skip
        V, at = float(f"1e{power}"), f"V = 1e{power}"
        found = wave.numeric().log_amplitude(*point, V)
        loss = in_ulps(found, exact(wave, log_amplitude(wave, sp.Rational(V)), *point))
        findings += [
            Finding(f"log10 B at {at}, which float64 cannot hold as B",
                    float(found[0]) / math.log(10), low, high, key=key),
            Finding(f"loss of ln B at {at}, in ulps", float(loss[0]), 0.0, ALLOWED),
        ]  # fmt: skip
    return findings


def _from_theory(epsilon: float) -> list[Finding]:
    """What the lattice makes of the theory's wave at k = 1 + ε."""
    theory = Compacton(theory_at(sp.Rational(str(1 + epsilon)), sp.Integer(1)), 1.0)
    start, sites = 160, 300
    bead = np.arange(2 * start + sites) - start
    scene = carrying(
        (1.0,) * len(bead), theory.k, theory.compression(bead[:-1] + 0.5),
        theory.velocity(bead), contact_sensors=(start + 60, start + sites), samples=4001,
        duration=(sites + 0.7 * start) / theory.speed,
    )  # fmt: skip
    passed = passage(scene)
    at_one = derived(
        lambda V, u: V / u ** (epsilon / 2) / theory.speed - 1, passed.speed, passed.strain
    )
    return [
        Finding.of("lattice, from the theory's wave: speed/theory - 1 at equal strain", at_one,
                   -(epsilon**2), epsilon**2, "lattice_speed_error"),
        Finding.of("lattice, from the theory's wave: FWHM of force/theory - 1",
                   ratio(passed.fwhm, theory.fwhm("force")), -epsilon, epsilon,
                   "lattice_fwhm_error"),
        Finding("energy drift", passed.energy_drift, -1e-9, 1e-9, key="energy_drift"),
    ]  # fmt: skip


def vanishing_terms() -> Report:
    """k = 2, where G = 0, and k = 3: fewer terms, and nothing else changes."""
    exponents: list[float] = [1.5, 1.75, 1.95, 2.0, 2.05, 2.5, 2.95, 3.0, 3.05, 3.5]
    waves = {k: solve((1.0, 1.0), k) for k in exponents}
    errors = {k: _theory_errors(wave) for k, wave in waves.items()}
    findings: list[Finding | Statement] = [_terms(k) for k in ("5/2", "2", "3")]
    for k in (2.0, 3.0):
        for quantity, error in errors[k].items():
            sides = (errors[k - 0.05][quantity] + errors[k + 0.05][quantity]) / 2
            findings += [
                Finding(f"k = {k:g}, {quantity}: theory/Newton - 1", error),
                # a smooth function's second difference over 0.05² is of the size of 1/10
                Finding(f"k = {k:g}, {quantity}: less its mean at k ± 0.05", error - sides,
                        -2.5e-4, 2.5e-4),
            ]  # fmt: skip
        passed = passage(launched(waves[k], 12, 60), 1e-7)
        findings += [
            Finding.of(f"k = {k:g}, lattice from Newton's wave: speed/Newton - 1",
                       ratio(passed.speed, waves[k].c), -1e-6, 1e-6, f"speed_error_k{k:g}"),
            Finding.of(f"k = {k:g}, lattice from Newton's wave: FWHM of force/Newton - 1",
                       ratio(passed.fwhm, waves[k].fwhm("force")), -1e-6, 1e-6,
                       f"fwhm_error_k{k:g}"),
        ]  # fmt: skip
    curves = [
        Curve.of(quantity, exponents, [100 * errors[k][quantity] for k in exponents])
        for quantity in errors[2.0]
    ]
    return Report(
        "k = 2 and k = 3, where terms of the wave equation vanish: does anything break?",
        findings=tuple(findings),
        panels=(Panel("k", "theory/Newton - 1 (%)", tuple(curves)),),
        notes=("Nothing: at k = 2 the term of G is gone and at k = 3 some of the next order's; "
               "theory and lattice pass through both smoothly. The theory's error grows with k.",),
    )  # fmt: skip


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


def hard_spheres() -> Report:
    """k = 20: two beads collide as in closed form, and the pulse is a row of such collisions."""
    k = 20.0
    wave = solve((1.0, 1.0), 3.0)
    for exponent, points in ((5.0, 90), (8.0, 110), (12.0, 140), (k, 160)):
        wave = solve((1.0, 1.0), exponent, points=points, start=wave)
    # A collision of two equal beads whose force peaks at 1, as the wave's does.
    velocity = 2 / math.sqrt(k + 1)
    scene = launched(wave, 10, 40)
    passed = passage(scene, 1e-7)
    findings: list[Finding | Statement] = [
        *_collision(k, 1.0),
        *_collision(k, 0.3),
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
        overflow("rtol = 1e-3 is too coarse here, and is told", scene, rtol=1e-3),
        *(Finding(f"{quantity}: theory/Newton - 1", error)
          for quantity, error in _theory_errors(wave).items()),
    ]  # fmt: skip
    theory = Compacton(theory_at(20, 1), 1.0)
    xi = np.linspace(-1, 1, 401)
    newton, long_wave = wave.force(xi), theory.contact_force(xi)
    curves = Curve.of("Newton", xi, newton), Curve.of("theory", xi, long_wave)
    return Report(
        "k = 20, near hard spheres: does a pulse become a row of collisions of two?",
        findings=tuple(findings),
        panels=(Panel("ξ / D", "force of a contact", curves),),
        notes=("It does: force and bead velocity are those of two beads alone. The force is less "
               "than 0.2 sites wide; a long-wave theory, several times too wide here, is not to be "
               "used.",),
    )  # fmt: skip


def _collision(k: float, omega: float) -> list[Finding]:
    """Beads of masses 1 and ω on the lattice against the closed forms."""
    scene = Scene(masses=(1, omega), stiffnesses=(1,), k=k, duration=6, velocities=(1,),
                  contact_sensors=(0,), samples=2)  # fmt: skip
    run = simulate(scene, method=METHOD, rtol=1e-9)
    # Apart, the beads leave with the relative velocity 1 at which they met.
    lasted = scene.duration + float(run.compression[0, -1])
    left = float(run.velocities[0]) - (1 - omega) / (1 + omega)
    return [
        Finding(f"two beads, 1 : {omega:g}: velocity of the first less its exact value", left,
                -1e-10, 1e-10),
        Finding(f"two beads, 1 : {omega:g}: time of contact/closed form - 1",
                lasted / contact_time(k, omega) - 1, -1e-10, 1e-10),
    ]  # fmt: skip


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
    return float(
        2 * scipy.special.beta(1 / n, 0.5) / n * scipy.special.betaincc(1 / n, 0.5, 0.5 ** (n / k))
    )
