"""Hard cases in ω = m2/m1: the extremes, the resonance, and where the theory has no wave.

Each public function is one case of `validation.studies.hard.cases`. Lengths in D; A = D = 1.
"""

from __future__ import annotations

import math

import numpy as np
import sympy as sp

from lwa import Dimer, NoSolitaryWave, TravelingWave, canonical_wave, homogenize
from validation.lattice.simulate import simulate
from validation.pulses.pulse import derived, measure
from validation.pulses.steady import STRETCH, point
from validation.pulses.time_of_flight import METHOD, passage, ratio
from validation.report.result import Curve, Finding, Outcome, Panel, Statement
from validation.scenes.chains import carrying
from validation.scenes.scene import Scene
from validation.studies.limits import theory_at
from validation.waves.continuation import NoWave, solve
from validation.waves.profile import ExactWave
from validation.waves.theory import Compacton

EXPONENT = sp.Rational(3, 2)

RATIOS = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
"""ω, and 1/ω, of `mass_ratios`."""


def mass_ratios() -> Outcome:
    """ω from 1e-6 to 1e6 at k = 3/2: the light beads only hand the force on.

    As ω → 0 a heavy bead has the next one behind two springs in a row, of 2^{-k}: the uniform
    chain of spacing 2D, whose wave is √2 times as fast at equal force. Light first or heavy first,
    the chain is the same in other units of mass.
    """
    uniform = solve((1.0, 1.0), 1.5)
    limit, wide = math.sqrt(2) * uniform.c, 2 * uniform.fwhm("force")
    findings: list[Finding | Statement] = []
    off, costs, drifts, leaks = [], [], [], []
    for omega in RATIOS:
        passed = passage(_slaved(uniform, 1.0, omega), 1e-5)
        mirrored = passage(_slaved(uniform, 1 / omega, 1.0), 1e-5)
        off.append(ratio(passed.speed, limit))
        costs.append(passed.evaluations / 70)
        drifts += [abs(passed.energy_drift), abs(mirrored.energy_drift)]
        leaks += [abs(passed.momentum_drift), abs(mirrored.momentum_drift)]
        findings += [
            Finding.of(f"ω = {omega:g}: speed/limit - 1, over ω",
                       derived(lambda x, w=omega: x / w, off[-1]), -0.5, 0.0,
                       "speed_slope" if omega == RATIOS[0] else ""),
            Finding(f"ω = {1 / omega:g}: speed √ω over that at 1/ω, less 1",
                    mirrored.speed.value / math.sqrt(omega) / passed.speed.value - 1, -1e-9, 1e-9),
        ]  # fmt: skip
    growth = float(np.polyfit(np.log(RATIOS), np.log(costs), 1)[0])
    findings += [
        Finding("largest energy drift of all", max(drifts), 0.0, 1e-9, key="energy_drift"),
        Finding("largest momentum drift of all", max(leaks), 0.0, 1e-12),
        Finding("evaluations of the forces per site at ω = 1e-6", costs[0]),
        Finding("power of ω with which they grow", growth, -0.51, -0.49, key="cost_power"),
    ]
    # The canonical theory's own limit is that of the uniform chain, and so is its error.
    slaved = Compacton(theory_at(EXPONENT, sp.Integer(1)), 1.0).fwhm("force")
    slaved = slaved / uniform.fwhm("force") - 1
    for omega in (sp.Rational(1, 10**6), sp.Integer(10**6)):
        canonical = canonical_wave(Dimer(1, omega, spacing=1), EXPONENT)
        for name, wave in (("paper's", theory_at(EXPONENT, omega)),
                           ("canonical", canonical)):  # fmt: skip
            error = Compacton(wave, 1.0).fwhm("force") / wide - 1
            bounds = (-math.inf, math.inf)
            if name == "canonical":
                bounds = slaved - 1e-5, slaved + 1e-5
            label = f"ω = {float(omega):g}: FWHM of force, {name} theory/lattice's limit - 1"
            findings.append(Finding(label, error, *bounds))
    sizes = [abs(x.value) for x in off]
    inverse = [1 / w for w in RATIOS]
    return Outcome(
        "ω from 1e-6 to 1e6: does the lattice reach the limit of slaved light beads?",
        findings,
        "It does, to O(ω), and ω → 1/ω is the same chain; the cost grows like the light beads' "
        "frequency, 1/√ω. The canonical theory is 5.6 % wide at both ends, the paper's at ω ≪ 1 "
        "only.",
        Panel(
            "ω = m2/m1", "|speed/limit - 1|",
            (Curve.of("ω < 1", RATIOS, sizes), Curve.of("ω > 1 (the reciprocal)", inverse, sizes)),
            "xy",
        ),
    )  # fmt: skip


def _slaved(uniform: ExactWave, heavy: float, light: float) -> Scene:
    """Heavy beads with the uniform chain's wave at spacing 2D, the light ones between at rest
    among them: both contacts have half of the strain 2 r, velocities are √2 times as large."""
    start, cells = 20, 60
    site = np.arange(2 * cells) - start
    pair = np.floor(site[:-1] / 2) + 0.5
    behind, ahead = (uniform.velocity(np.floor((site + i) / 2)) for i in (0, 1))
    pace = math.sqrt(2) * uniform.c / math.sqrt(heavy)
    masses = np.where(site % 2 == 0, heavy, light)
    return carrying(
        tuple(masses), uniform.k, uniform.strain(pair),
        (behind + ahead) / 2 * math.sqrt(2 / heavy),
        duration=70 / pace, contact_sensors=(40, 80), samples=4001,
    )  # fmt: skip


RESONANT = (0.55, 0.58, 0.6, 0.62)
"""ω at which the light beads oscillate in step with the passing pulse."""

QUIET = (0.34284539, 1.0)
"""ω at which they do not: the largest special ratio, and the uniform chain, for comparison."""

_KEYS = {0.6: "decay", QUIET[0]: "decay_at_special_ratio", QUIET[1]: "decay_at_equal_masses"}

_DECAYING, _STEADY = tuple(range(12, 73, 4)), tuple(range(40, 101, 4))
"""Contacts: before the pulse's tail overtakes it, and where it has formed."""


def resonance() -> Outcome:
    """ω = 0.55 … 0.62 at k = 3/2: a struck chain's pulse radiates and decays; there is no wave."""
    findings: list[Finding | Statement] = []
    curves = []
    symbols = homogenize(Dimer("m1", "m2", spacing=1)).pde.traveling_wave().numeric()
    for omega in RESONANT + QUIET:
        sites = _DECAYING if omega in RESONANT else _STEADY
        rate = point(EXPONENT, sp.Rational(str(omega)), STRETCH).numbers["decay"]
        bounds = (0.005, 0.02) if omega in RESONANT else (-1e-7, 1e-7)
        findings.append(
            Finding.of(
                f"ω = {omega:g}: decay of the peak force per site",
                rate,
                *bounds,
                _KEYS.get(omega, ""),
            )
        )
        curves.append(Curve.of(f"ω = {omega:g}", sites, _peaks(omega, sites)))
    for omega in RESONANT:
        wave = _least_tail(omega)
        says = (
            "no wave found" if wave is None
            else f"tail {wave.tail:.2f} of the peak strain, residual {wave.residual:.0e}: "
            f"{'a solitary wave' if wave.solitary else 'a nanopteron, not solitary'}"
        )  # fmt: skip
        findings.append(
            Statement(f"ω = {omega:g}: Newton's method", says, wave is not None and wave.tail > 0.1)
        )
        width = float(symbols.width(1.5, omega))
        findings.append(Finding(f"ω = {omega:g}: sites of the wave that the theory has", width))
    return Outcome(
        "ω = 0.55 … 0.62 at k = 3/2, the resonance: is there a solitary wave?",
        findings,
        "There is none. A pulse loses about 1 to 2 % of its force with every site to the light "
        "beads, and Newton's method finds only waves on a tail that never ends. The theory, which "
        "slaves the light beads, has a wave there all the same: do not use it.",
        Panel("contact", "peak force", tuple(curves), "y"),
    )


def _peaks(omega: float, sites: tuple[int, ...]) -> list[float]:
    """Peak forces at these contacts of a struck chain."""
    n = 160
    scene = Scene(
        masses=(1.0, omega) * (n // 2), stiffnesses=(1.0,) * (n - 1), k=1.5, velocities=(1.0,),
        contact_sensors=sites, duration=140.0, samples=5601,
    )  # fmt: skip
    run = simulate(scene, method=METHOD, rtol=1e-6, window=False)
    return [measure(run.time, force).peak for force in run.contact_force]


def _least_tail(omega: float) -> ExactWave | None:
    """The wave with the smaller tail, of two half periods at which Newton's method finds some."""
    waves = []
    for half_period in (10.4, 11.2):
        try:
            waves.append(solve((1.0, omega), 1.5, half_period))
        except NoWave:
            continue
    return min(waves, key=lambda wave: wave.tail, default=None)


def no_compact_wave() -> Outcome:
    """G+H+I ≤ 0 and V² ≤ 0: the paper's closure has no wave, the chain has one.

    Special ratios m2/m1 < 1 are those of solitary waves; the same chain, its beads named the other
    way round, has 1/ω, which the paper's closure treats as another one.
    """
    findings: list[Finding | Statement] = []
    k3 = homogenize(Dimer("m1", "m2", spacing=1), k=3).pde.traveling_wave()
    m1, m2 = k3.cell.masses
    (border,) = (x for x in sp.solve(sp.numer(k3.dispersion.subs(m1, 1)), m2) if x.is_positive)
    says = f"G+H+I > 0 for ω < {border} only; at ω = {border}: {_refusal(sp.Integer(3), border)}"
    findings.append(Statement("k = 3, paper's closure", says, border == 3))
    curves = []
    for k, wave, sign in (
        (sp.Integer(3), _continued((1.6, 2.0, 2.5, 3.0)), "G+H+I"),
        (sp.Rational(8, 5), _continued((1.6,)), "V²"),
    ):
        omega = sp.Rational(f"{1 / wave.omega:.4f}")
        name = f"k = {k}, ω = {float(omega):g}"
        refusal = _refusal(k, omega)
        findings += [
            Statement(f"{name}: paper's closure", refusal, refusal.startswith((f"({sign}", sign))),
            Finding(
                f"{name}: Newton's wave: tail over peak strain",
                wave.tail,
                0.0,
                1e-9,
                key=f"tail_k{k.p}_{k.q}" if k.q > 1 else f"tail_k{k}",
            ),
            Finding(f"{name}: residual of the equations of motion", wave.residual, 0.0, 1e-9),
        ]
        passed = passage(_dimer(wave, 24, 64), 1e-7)
        findings += [
            Finding.of(f"{name}: lattice from Newton's wave: speed/Newton - 1",
                       ratio(passed.speed, wave.c), -1e-5, 1e-5,
                       "lattice_speed_error" if k == 3 else ""),
            Finding.of(f"{name}: lattice from Newton's wave: peak force - 1",
                       ratio(passed.force, 1.0), -1e-4, 1e-4),
        ]  # fmt: skip
        theory = canonical_wave(Dimer(1, sp.Rational(wave.omega), spacing=1), k)
        pace = Compacton(theory, 1.0).speed
        findings.append(
            Finding(f"{name}: canonical theory's speed/Newton - 1", pace / wave.c - 1, -0.05, 0.05)
        )
        xi = np.linspace(-8, 8, 801)
        curves.append(Curve.of(name, xi, (wave.force(xi - 0.5) + wave.force(xi + 0.5, 1)) / 2))
    return Outcome(
        "G+H+I ≤ 0 (k > 2, ω ≫ 1) or V² ≤ 0 (k = 8/5, ω ≫ 1) in the paper's closure: is there no "
        "wave?",
        findings,
        "The closure has none, and says which number forbids it; the lattice has a solitary wave, "
        "and the canonical field's theory has it too.",
        Panel("ξ / D", "force of a heavy bead, mean of its contacts", tuple(curves)),
    )


def _refusal(k: sp.Expr, omega: sp.Expr) -> str:
    """What the paper's closure says to these parameters."""
    try:
        wave: TravelingWave = theory_at(k, omega)
    except NoSolitaryWave as reason:
        return str(reason)
    return f"has a wave, of {float(wave.sites):g} sites"


def _continued(exponents: tuple[float, ...]) -> ExactWave:
    """The second special ratio's wave, 0.1548 at k = 3/2, followed to the last exponent."""
    wave = solve((1.0, 0.1548), 1.5, free=True)
    for k in exponents:
        wave = solve(wave.masses, k, start=wave, free=True)
    return wave


def _dimer(wave: ExactWave, start: int, sites: int) -> Scene:
    """A dimer with its wave at the heavy bead ``start``, to run ``sites`` further."""
    n = 2 * start + sites
    bead = np.arange(n) - start
    at = bead[:-1] + 0.5
    even = bead % 2 == 0
    return carrying(
        tuple(np.where(even, *wave.masses)), wave.k,
        np.where(even[:-1], wave.strain(at, 0), wave.strain(at, 1)),
        np.where(even, wave.velocity(bead, 0), wave.velocity(bead, 1)),
        contact_sensors=(start + sites // 2, start + sites), samples=8001,
        duration=(sites + start / 2) / wave.c,
    )  # fmt: skip
