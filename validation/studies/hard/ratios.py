"""Hard cases in ω = m2/m1: the extremes, the resonance, and where the theory has no wave.

Lengths in D; A = D = 1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress

import numpy as np
import sympy as sp

from lwa import Dimer, NoSolitaryWave, homogenize
from validation.lattice.simulate import simulate
from validation.pulses.pulse import derived, measure
from validation.pulses.steady import STRETCH, point
from validation.pulses.time_of_flight import passage, ratio
from validation.report.panel import Curve, Panel
from validation.report.table import Finding, Statement
from validation.scenes.chains import carrying, launched, struck
from validation.scenes.scene import Scene
from validation.studies.hard.case import Parts, case
from validation.studies.hard.floats import closed_wave
from validation.waves.profile import ExactWave
from validation.waves.solver import NoWave, solve
from validation.waves.theory import Compacton, theory_at

RATIOS = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)  # ω, and 1/ω, of `mass_ratios`


@case(
    "It does, to O(ω), and ω → 1/ω is the same chain; the cost grows no faster than the "
    "light beads' frequency, 1/√ω. The canonical theory is 5.6 % wide at both ends, the "
    "paper's at ω ≪ 1 only.",
    Panel("ω = m2/m1", "|speed/limit - 1|", scale="xy"),
)
def mass_ratios() -> Parts:
    """ω from 1e-6 to 1e6: does the lattice reach the limit of slaved light beads?

    At k = 3/2. As ω → 0 a heavy bead has the next one behind two springs in a row, of 2^{-k}: the
    uniform chain of spacing 2D, whose wave is √2 times as fast at equal force. Light first or heavy
    first, the chain is the same in other units of mass.
    """
    uniform = solve((1.0, 1.0), 1.5)
    runs, off = [], []
    for omega in RATIOS:
        passed = passage(_slaved(uniform, 1.0, omega), 1e-9)
        mirrored = passage(_slaved(uniform, 1 / omega, 1.0), 1e-9)
        runs += [passed, mirrored]
        off.append(ratio(passed.speed, math.sqrt(2) * uniform.c))
        per_omega = derived(lambda x, w=omega: x / w, off[-1])
        key = "speed_slope" if omega == RATIOS[0] else ""
        yield Finding.of(f"ω = {omega:g}: speed/limit - 1, over ω", per_omega, -0.5, 0.0, key)
        yield Finding(f"ω = {1 / omega:g}: speed √ω over that at 1/ω, less 1",
                      mirrored.speed.value / math.sqrt(omega) / passed.speed.value - 1,
                      -1e-9, 1e-9)  # fmt: skip
    costs = [run.evaluations / 70 for run in runs[::2]]
    growth = float(np.polyfit(np.log(RATIOS), np.log(costs), 1)[0])
    yield from (
        Finding("largest energy drift of all", max(abs(run.energy_drift) for run in runs),
                0.0, 1e-9, key="energy_drift"),
        Finding("largest momentum drift of all", max(abs(run.momentum_drift) for run in runs),
                0.0, 1e-12),
        Finding("evaluations of the forces per site at ω = 1e-6", costs[0]),
        Finding("power of ω with which they grow", growth, -0.51, 0.0, key="cost_power"),
    )  # fmt: skip
    yield from _limits(uniform.fwhm("force"))
    sizes = [abs(x.value) for x in off]
    yield Curve.of("ω < 1", RATIOS, sizes)
    yield Curve.of("ω > 1 (the reciprocal)", [1 / w for w in RATIOS], sizes)


def _limits(fwhm: float) -> Iterator[Finding]:
    """Widths of the two theories at both ends over the lattice's, twice the uniform chain's."""
    # The canonical theory's own limit is that of the uniform chain, and so is its error.
    slaved = Compacton(theory_at("3/2", 1), 1.0).fwhm("force") / fwhm - 1
    for omega in (sp.Rational(1, 10**6), sp.Integer(10**6)):
        for name, closure, by in (
            ("paper's", "linear", math.inf),
            ("canonical", "canonical", 1e-5),
        ):
            width = Compacton(theory_at("3/2", omega, closure), 1.0).fwhm("force")
            label = f"ω = {float(omega):g}: FWHM of force, {name} theory/lattice's limit - 1"
            yield Finding(label, width / (2 * fwhm) - 1, slaved - by, slaved + by)


def _slaved(uniform: ExactWave, heavy: float, light: float) -> Scene:
    """Heavy beads with the uniform chain's wave at spacing 2D, the light ones between at rest
    among them: both contacts have half of the strain 2 r, velocities are √2 times as large."""
    start, cells = 20, 60
    site = np.arange(2 * cells) - start
    pair = np.floor(site[:-1] / 2) + 0.5
    behind, ahead = (uniform.velocity(np.floor((site + i) / 2)) for i in (0, 1))
    pace = math.sqrt(2) * uniform.c / math.sqrt(heavy)
    return carrying(
        tuple(np.where(site % 2 == 0, heavy, light)), uniform.k, uniform.strain(pair),
        (behind + ahead) / 2 * math.sqrt(2 / heavy),
        duration=70 / pace, contact_sensors=(40, 80), samples=4001,
    )  # fmt: skip


# ω at which the light beads oscillate in step with the passing pulse, and at which they do not: the
# largest special ratio, and the uniform chain, for comparison.
RESONANT, QUIET = (0.55, 0.58, 0.6, 0.62), (0.34284539, 1.0)

_KEYS = {0.6: "decay", QUIET[0]: "decay_at_special_ratio", QUIET[1]: "decay_at_equal_masses"}
# Contacts: before the pulse's tail overtakes it, and where it has formed.
_DECAYING, _STEADY = tuple(range(12, 73, 4)), tuple(range(40, 101, 4))


@case(
    "There is none. A pulse loses about 1 to 2 % of its force with every site to the light beads, "
    "and Newton's method finds only waves on a tail that never ends. The theory, which slaves the "
    "light beads, has a wave there all the same: do not use it.",
    Panel("contact", "peak force", scale="y"),
)
def resonance() -> Parts:
    """ω = 0.55 … 0.62 at k = 3/2, the resonance: is there a solitary wave?"""
    theory = closed_wave("paper's closure").numeric()
    for omega in RESONANT + QUIET:
        near = omega in RESONANT
        bounds, sites = ((0.005, 0.02), _DECAYING) if near else ((-1e-7, 1e-7), _STEADY)
        rate = point(sp.Rational(3, 2), sp.Rational(str(omega)), STRETCH).numbers["decay"]
        name = f"ω = {omega:g}: decay of the peak force per site"
        yield Finding.of(name, rate, *bounds, _KEYS.get(omega, ""))
        scene = struck((1.0, omega), 160, contact_sensors=sites, duration=140.0, samples=5601)
        run = simulate(scene, rtol=1e-6, window=False)
        peaks = [measure(run.time, force).peak for force in run.contact_force]
        yield Curve.of(f"ω = {omega:g}", sites, peaks)
    for omega in RESONANT:
        yield _least_tail(omega)
        width = float(theory.width(1.5, omega))
        yield Finding(f"ω = {omega:g}: sites of the wave that the theory has", width)


def _least_tail(omega: float) -> Statement:
    """The wave with the smaller tail, of two half periods at which Newton's method finds some."""
    waves, name = [], f"ω = {omega:g}: Newton's method"
    for half_period in (10.4, 11.2):
        with suppress(NoWave):
            waves.append(solve((1.0, omega), 1.5, half_period))
    if not waves:
        return Statement(name, "no wave found", False)
    wave = min(waves, key=lambda wave: wave.tail)
    kind = "a solitary wave" if wave.solitary else "a nanopteron, not solitary"
    says = f"tail {wave.tail:.2f} of the peak strain, residual {wave.residual:.0e}: {kind}"
    return Statement(name, says, wave.tail > 0.1)


@case(
    "The closure has none, and says which number forbids it; the lattice has a solitary wave, and "
    "the canonical field's theory has it too.",
    Panel("ξ / D", "force of a heavy bead, mean of its contacts"),
)
def no_compact_wave() -> Parts:
    """G+H+I ≤ 0 (k > 2, ω ≫ 1) or V² ≤ 0 (k = 8/5, ω ≫ 1) in the paper's closure: is there no
    wave?

    Special ratios m2/m1 < 1 are those of solitary waves; the same chain, its beads named the other
    way round, has 1/ω, which the paper's closure treats as another one.
    """
    k3 = homogenize(Dimer("m1", "m2", spacing=1), k=3).pde.traveling_wave()
    m1, m2 = k3.cell.masses
    (border,) = (x for x in sp.solve(sp.numer(k3.dispersion.subs(m1, 1)), m2) if x.is_positive)
    says = f"G+H+I > 0 for ω < {border} only; at ω = {border}: {_refusal(3, border)}"
    yield Statement("k = 3, paper's closure", says, border == 3)
    xi = np.linspace(-8, 8, 801)
    for k, exponents, sign, keys in (
        (sp.Integer(3), (1.6, 2.0, 2.5, 3.0), "G+H+I", ("tail_k3", "lattice_speed_error")),
        (sp.Rational(8, 5), (1.6,), "V²", ("tail_k8_5", "")),
    ):
        # the second special ratio's wave, 0.1548 at k = 3/2, followed to the last exponent
        wave = solve((1.0, 0.1548), 1.5, free=True)
        for exponent in exponents:
            wave = solve(wave.masses, exponent, start=wave, free=True)
        omega = sp.Rational(f"{1 / wave.omega:.4f}")
        name, refusal = f"k = {k}, ω = {float(omega):g}", _refusal(k, omega)
        yield Statement(f"{name}: paper's closure", refusal, refusal.startswith((f"({sign}", sign)))
        yield from _wave(wave, k, name, *keys)
        yield Curve.of(name, xi, (wave.force(xi - 0.5) + wave.force(xi + 0.5, 1)) / 2)


def _wave(wave: ExactWave, k: sp.Expr, name: str, tail: str, speed: str) -> Iterator[Finding]:
    """That a wave is solitary, on the lattice too, and that the canonical theory has it."""
    passed = passage(launched(wave, 24, 64, samples=8001), 1e-7)
    theory = Compacton(theory_at(k, sp.Rational(wave.omega), "canonical"), 1.0)
    yield from (
        Finding(f"{name}: Newton's wave: tail over peak strain", wave.tail, 0.0, 1e-9, key=tail),
        Finding(f"{name}: residual of the equations of motion", wave.residual, 0.0, 1e-9),
        Finding.of(f"{name}: lattice from Newton's wave: speed/Newton - 1",
                   ratio(passed.speed, wave.c), -1e-5, 1e-5, speed),
        Finding.of(f"{name}: lattice from Newton's wave: peak force - 1",
                   ratio(passed.force, 1.0), -1e-4, 1e-4),
        Finding(f"{name}: canonical theory's speed/Newton - 1", theory.speed / wave.c - 1,
                -0.05, 0.05),
    )  # fmt: skip


def _refusal(k: sp.Expr | int, omega: sp.Expr) -> str:
    """What the paper's closure says to these parameters."""
    try:
        wave = theory_at(k, omega)
    except NoSolitaryWave as reason:
        return str(reason)
    return f"has a wave, of {float(wave.sites):g} sites"
