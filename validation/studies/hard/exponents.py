"""Hard cases in k: near 1, at 2 and 3, and at 20, for theory, Newton's method and lattice.

Each public function is one case of `validation.studies.hard.cases`. Lengths in D; m1 = A = D = 1.
"""

from __future__ import annotations

import math

import numpy as np
import sympy as sp
from scipy.special import beta, betaincc

from lwa import Dimer, homogenize
from validation.lattice.run import IntegrationError
from validation.lattice.simulate import simulate
from validation.pulses.pulse import derived
from validation.pulses.time_of_flight import METHOD, passage, ratio
from validation.report.result import Curve, Finding, Outcome, Panel, Statement
from validation.scenes.chains import carrying
from validation.scenes.scene import Scene
from validation.studies.hard.floats import ALLOWED, closed_wave, exact, in_ulps
from validation.studies.limits import LAWS, theory_at
from validation.waves.continuation import solve
from validation.waves.profile import ExactWave
from validation.waves.theory import Compacton


def _theory_errors(wave: ExactWave) -> dict[str, float]:
    """Theory over a uniform chain's exact wave, less 1."""
    theory = Compacton(theory_at(sp.Rational(str(wave.k)), sp.Integer(1)), 1.0)
    errors = {f"FWHM of {q}": theory.fwhm(q) / wave.fwhm(q) - 1 for q in ("force", "strain")}
    return errors | {"speed V_s at B = 1": theory.speed / wave.c - 1}


def near_linear() -> Outcome:
    """k = 1.001: amplitudes in logarithms, and the theory's error against its own law."""
    k, epsilon = sp.Rational("1.001"), 0.001
    findings: list[Finding | Statement] = []
    symbolic = closed_wave("paper's closure")
    point = np.array([float(k)]), np.array([1.0])
    for power in (300, -300):
        V = sp.Rational(float(f"1e{power}"))
        form = (2 * sp.log(V) - sp.log(symbolic.speed_factor)) / (symbolic.k - 1)
        found = symbolic.numeric().log_amplitude(*point, float(V))
        loss = float(in_ulps(found, exact(symbolic, form, *point))[0])
        tens = float(found[0]) / math.log(10)
        findings += [
            Finding(f"log10 B at V = 1e{power}, which float64 cannot hold as B", tens,
                    308 if power > 0 else -math.inf, math.inf if power > 0 else -324,
                    key="log10_amplitude" if power > 0 else ""),
            Finding(f"loss of ln B at V = 1e{power}, in ulps", loss, 0.0, ALLOWED),
        ]  # fmt: skip

    epsilons = (0.1, 0.01, epsilon)
    waves = [solve((1.0, 1.0), 1 + e) for e in epsilons]
    errors = [_theory_errors(wave) for wave in waves]
    for quantity, law in LAWS.items():
        if quantity in errors[-1]:
            share = errors[-1][quantity] / epsilon**law.order / float(law.coefficient)
            name = f"{quantity}: theory/Newton - 1 over its law, {_law(law.coefficient, law.order)}"
            # the next term of the series is O(ε) of this one
            findings.append(Finding(name, share, 1 - 3 * epsilon, 1 + 3 * epsilon))

    theory = Compacton(theory_at(k, sp.Integer(1)), 1.0)
    start, sites = 160, 300
    bead = np.arange(2 * start + sites) - start
    scene = carrying(
        (1.0,) * len(bead), float(k), theory.compression(bead[:-1] + 0.5),
        theory.velocity(bead), contact_sensors=(start + 60, start + sites), samples=4001,
        duration=(sites + 0.7 * start) / theory.speed,
    )  # fmt: skip
    passed = passage(scene)
    at_one = derived(
        lambda V, u: V / u ** (epsilon / 2) / theory.speed - 1, passed.speed, passed.strain
    )
    width = ratio(passed.fwhm, theory.fwhm("force"))
    findings += [
        Finding.of("lattice, from the theory's wave: speed/theory - 1 at equal strain", at_one,
                   -(epsilon**2), epsilon**2, "lattice_speed_error"),
        Finding.of("lattice, from the theory's wave: FWHM of force/theory - 1", width,
                   -epsilon, epsilon, "lattice_fwhm_error"),
        Finding("energy drift", passed.energy_drift, -1e-9, 1e-9, key="energy_drift"),
    ]  # fmt: skip
    curves = []
    for quantity, law in LAWS.items():
        if quantity in errors[0]:
            sizes = [abs(error[quantity]) for error in errors]
            curves += [
                Curve.of(quantity, epsilons, sizes, line=False),
                Curve.of(f"{_law(law.coefficient, law.order)}", epsilons,
                         abs(float(law.coefficient)) * np.power(epsilons, law.order)),
            ]  # fmt: skip
    return Outcome(
        "k = 1.001, a pulse of 30 sites: do theory, Newton's method and the lattice still agree?",
        findings,
        "They do, and the error vanishes as it must. B has 600,000 digits before or behind the "
        "point; its logarithm is as good as any number.",
        Panel("k - 1", "|theory/Newton - 1|", tuple(curves), "xy"),
    )


def _law(coefficient: sp.Expr, order: int) -> str:
    return f"{float(coefficient):.4g} (k-1)" + (f"^{order}" if order > 1 else "")


def vanishing_terms() -> Outcome:
    """k = 2, where G = 0, and k = 3: fewer terms, and nothing else changes."""
    findings: list[Finding | Statement] = []
    for exponent in ("5/2", "2", "3"):
        paper = homogenize(Dimer("m1", "m2"), k=exponent).pde
        full = homogenize(Dimer("m1", "m2"), 6, k=exponent, closure="full", field="center").pde
        counts = [sum(c != 0 for c in full.coefficients[n].values()) for n in (3, 5)]
        says = (
            f"G {'=' if paper.G == 0 else '≠'} 0 in both closures; canonical field: "
            f"{counts[0]} terms at D^(k+3), {counts[1]} at D^(k+5)"
        )
        as_it_must = all((G == 0) == (exponent == "2") for G in (paper.G, full.G))
        findings.append(Statement(f"k = {exponent}", says, as_it_must))
    exponents: list[float] = [1.5, 1.75, 1.95, 2.0, 2.05, 2.5, 2.95, 3.0, 3.05, 3.5]
    waves = {k: solve((1.0, 1.0), k) for k in exponents}
    errors = {k: _theory_errors(wave) for k, wave in waves.items()}
    for k in (2.0, 3.0):
        for quantity, error in errors[k].items():
            sides = (errors[k - 0.05][quantity] + errors[k + 0.05][quantity]) / 2
            findings += [
                Finding(f"k = {k:g}, {quantity}: theory/Newton - 1", error),
                # a smooth function's second difference over 0.05² is of the size of 1/10
                Finding(
                    f"k = {k:g}, {quantity}: less its mean at k ± 0.05",
                    error - sides,
                    -2.5e-4,
                    2.5e-4,
                ),
            ]
        wave = waves[k]
        passed = passage(uniform(wave, 12, 60), 1e-7)
        findings += [
            Finding.of(f"k = {k:g}, lattice from Newton's wave: speed/Newton - 1",
                       ratio(passed.speed, wave.c), -1e-6, 1e-6, f"speed_error_k{k:g}"),
            Finding.of(f"k = {k:g}, lattice from Newton's wave: FWHM of force/Newton - 1",
                       ratio(passed.fwhm, wave.fwhm("force")), -1e-6, 1e-6,
                       f"fwhm_error_k{k:g}"),
        ]  # fmt: skip
    curves = [
        Curve.of(quantity, exponents, [100 * errors[k][quantity] for k in exponents])
        for quantity in errors[2.0]
    ]
    return Outcome(
        "k = 2 and k = 3, where terms of the wave equation vanish: does anything break?",
        findings,
        "Nothing: at k = 2 the term of G is gone and at k = 3 some of the next order's; theory and "
        "lattice pass through both smoothly. The theory's error grows with k.",
        Panel("k", "theory/Newton - 1 (%)", tuple(curves)),
    )


def hard_spheres() -> Outcome:
    """k = 20: two beads collide as in closed form, and the pulse is a row of such collisions."""
    k = 20.0
    findings: list[Finding | Statement] = []
    for omega in (1.0, 0.3):
        scene = Scene(masses=(1, omega), stiffnesses=(1,), k=k, duration=6, velocities=(1,),
                      contact_sensors=(0,), samples=2)  # fmt: skip
        run = simulate(scene, method=METHOD, rtol=1e-9)
        # Apart, the beads leave with the relative velocity 1 at which they met.
        lasted = scene.duration + float(run.compression[0, -1])
        left = float(run.velocities[0]) - (1 - omega) / (1 + omega)
        findings += [
            Finding(f"two beads, 1 : {omega:g}: velocity of the first less its exact value", left,
                    -1e-10, 1e-10),
            Finding(f"two beads, 1 : {omega:g}: time of contact/closed form - 1",
                    lasted / contact_time(k, omega) - 1, -1e-10, 1e-10),
        ]  # fmt: skip
    wave: ExactWave | None = None
    for exponent, points in ((3.0, None), (5.0, 90), (8.0, 110), (12.0, 140), (k, 160)):
        wave = solve((1.0, 1.0), exponent, points=points, start=wave)
    assert wave is not None
    # A collision of two equal beads whose force peaks at 1, as the wave's does.
    velocity = 2 / math.sqrt(k + 1)
    fwhm = collision_fwhm(k) / velocity
    findings += [
        Finding("Newton's wave: bead velocity/that before a collision of two - 1",
                wave.peak("velocity")[1] / velocity - 1, -1e-5, 1e-5),
        Finding("Newton's wave: FWHM of force in time/that of a collision of two - 1",
                wave.fwhm("force") / wave.c / fwhm - 1, -1e-10, 1e-10,
                key="collision_error"),
        Finding("Newton's wave: FWHM of force, sites", wave.fwhm("force"), 0.0, 0.2, key="fwhm"),
    ]  # fmt: skip
    scene = uniform(wave, 10, 40)
    passed = passage(scene, 1e-7)
    findings += [
        Finding.of("lattice from Newton's wave: speed/Newton - 1", ratio(passed.speed, wave.c),
                   -1e-5, 1e-5, "lattice_speed_error"),
        Finding.of("lattice from Newton's wave: FWHM of force/Newton - 1",
                   ratio(passed.fwhm, wave.fwhm("force")), -1e-4, 1e-4, "lattice_fwhm_error"),
        Finding("energy drift", passed.energy_drift, -1e-10, 1e-10, key="energy_drift"),
        Finding("evaluations of the forces per site", passed.evaluations / 40),
        _too_coarse(scene),
    ]  # fmt: skip
    findings += [
        Finding(f"{quantity}: theory/Newton - 1", error)
        for quantity, error in _theory_errors(wave).items()
    ]
    theory = Compacton(theory_at(sp.Integer(20), sp.Integer(1)), 1.0)
    xi = np.linspace(-1, 1, 401)
    return Outcome(
        "k = 20, near hard spheres: does a pulse become a row of collisions of two?",
        findings,
        "It does: force and bead velocity are those of two beads alone. The force is less than 0.2 "
        "sites wide; a long-wave theory, several times too wide here, is not to be used.",
        Panel(
            "ξ / D", "force of a contact",
            (Curve.of("Newton", xi, wave.force(xi)),
             Curve.of("theory", xi, theory.contact_force(xi))),
        ),
    )  # fmt: skip


def contact_time(k: float, omega: float) -> float:
    """How long beads of masses 1 and ω touch that meet with relative velocity 1; A = 1.

    2 ∫ dδ / √(1 - (δ/d)^n), n = k + 1, from 0 to the deepest compression d: a beta function.
    """
    n = k + 1
    deepest = (n * omega / (1 + omega) / 2) ** (1 / n)
    return float(2 * deepest * beta(1 / n, 0.5) / n)


def collision_fwhm(k: float) -> float:
    """The FWHM in time of the force of a collision whose compression peaks at 1, times the
    relative velocity: twice ∫ dδ / √(1 - δ^n), n = k + 1, from half the force, δ^k = 1/2, to 1."""
    n = k + 1
    return float(2 * beta(1 / n, 0.5) / n * betaincc(1 / n, 0.5, 0.5 ** (n / k)))


def _too_coarse(scene: Scene) -> Statement:
    try:
        simulate(scene, method=METHOD, rtol=1e-3, window=False)
    except IntegrationError as error:
        return Statement("rtol = 1e-3 is too coarse here, and is told", str(error), True)
    return Statement("rtol = 1e-3 is too coarse here, and is told", "nothing is said", False)


def uniform(wave: ExactWave, start: int, sites: int) -> Scene:
    """A uniform chain with its wave at bead ``start``, to run ``sites`` further."""
    n = 2 * start + sites
    bead = np.arange(n) - start
    return carrying(
        (1.0,) * n, wave.k, wave.strain(bead[:-1] + 0.5), wave.velocity(bead),
        contact_sensors=(start + sites // 2, start + sites), samples=4001,
        duration=(sites + start // 2) / wave.c,
    )  # fmt: skip
