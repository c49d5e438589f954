"""Hard cases: the last digits at extreme k, ω and loads, contacts that open, and long runs.

Each case is a function whose docstring is a question, answered by numbers with bounds that follow
from a law, a closed form or another method. An ulp is the distance between neighbouring float64
numbers at the exact value: perfect rounding loses at most half an ulp.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

import click
import mpmath as mp
import numpy as np
import sympy as sp

from lwa import Cell, CompactWave, Dimer, homogenize, loaded_wave
from lwa.base.arrays import Array
from lwa.base.exact import number
from lwa.base.progress import Progress
from lwa.law import ContactLaw
from validation.lattice.simulate import simulate
from validation.pictures import Curve, Panel
from validation.report.command import option, study
from validation.report.result import Report
from validation.report.table import (
    FINDING_COLUMNS,
    Column,
    Finding,
    Table,
    findings_table,
    plain,
)
from validation.scenes.checks import one_of
from validation.scenes.scene import Scene

REFERENCE_DIGITS = 80  # of mpmath; cancellation on the grid leaves more than 50 of them
ALLOWED = 8.0  # ulps that V² under load may lose
PROMISED = 1e-11 / 2**-52  # ulps that a closed form in floats may lose
PRINTED, METHOD = "as printed", "symplectic"  # the formulas of the paper; the splitting

EXPONENTS = 1 + np.array(
    [1e-6, 1e-4, 0.01, 0.1, 0.5, 1, 1 + 2**-30, 1.5, 2 - 2**-30, 2, 4, 19]
)
RATIOS = np.unique(
    [*10.0 ** np.arange(-6, 6.1, 0.5), 0.2733, 1 - 2**-40, 1 + 2**-40, 4.0]
)
"""Grid of k and of ω = m2/m1; 0.2733 is the paper's."""
RISE = 0.7  # B of a wave on a background; no power of 2
LOADS = 10.0 ** np.arange(-12, 12.5, 0.5)  # p0/B

CLOSURES: Mapping[str, Mapping[str, Any]] = {
    "paper's closure": {},
    "full closure": {"closure": "full", "field": "first"},
    "canonical field": {"closure": "full", "field": "center"},
}
"""Waves that are compared, as options of `lwa.homogenize`."""

FORMS: Mapping[str, tuple[Any, ...]] = {
    "β": ("beta",),
    "width π/β": ("width",),
    **{
        f"FWHM of {quantity}": ("fwhm", quantity)
        for quantity in ("strain", "force", "velocity")
    },
    "speed at B = 2": ("speed", 2),
    "ln B at V = 2": ("log_amplitude", 2),
    "ln B at V = 2^1000": ("log_amplitude", 2**1000),  # B itself overflows where k < 3
}
"""Closed forms: names of a wave's attribute, and its arguments."""


def closed_wave(closure: str) -> CompactWave:
    """Return the wave of one of `CLOSURES`, D = 1, with k, m1, m2 as symbols."""
    return homogenize(
        Dimer("m1", "m2", spacing=1), **CLOSURES[closure]
    ).pde.traveling_wave()


def form(wave: CompactWave, name: str, *arguments: Any) -> sp.Expr:
    """Return the exact expression of one of `FORMS`: a wave's attribute and its arguments."""
    # V² = V²(B = 1) B^{k-1}, V²(B = 1) being the wave's speed_factor.
    if name == "log_amplitude":
        return (2 * sp.log(*arguments) - sp.log(wave.speed_factor)) / (wave.k - 1)
    value = getattr(wave, name)
    return value(*arguments) if arguments else value


def true_values(wave: CompactWave, expression: sp.Expr, k: Array, omega: Array) -> Any:
    """Evaluate an expression of a `closed_wave` by mpmath, to `REFERENCE_DIGITS` digits.

    k, omega : arrays of one shape. Returns an array of mpmath numbers, None where there is no wave.
    """
    m1, m2 = wave.cell.masses
    value, *positive = (
        sp.lambdify((wave.k, m2), each.subs(m1, 1), "mpmath")
        for each in (expression, wave.coefficient_sum, wave.speed_factor)
    )

    def at(*point: float) -> Any:
        numbers = tuple(map(mp.mpf, point))
        return value(*numbers) if all(each(*numbers) > 0 for each in positive) else None

    with mp.workdps(REFERENCE_DIGITS):
        return np.frompyfunc(at, 2, 1)(k, omega)


def in_ulps(value: Array, true: Any) -> Array:
    """Return |value - true| in ulps; ∞ if value is not finite, NaN if true is None (no wave)."""

    def loss(x: float, exact: Any) -> float:
        if exact is None or not math.isfinite(x):
            return math.nan if exact is None else math.inf
        return float(abs(mp.mpf(x) - exact) / float(np.spacing(abs(float(exact)))))

    with mp.workdps(REFERENCE_DIGITS):
        return np.asarray(np.frompyfunc(loss, 2, 1)(value, true), float)


def printed_beta(k: Array, omega: Array) -> Array:
    """Return |β| by the printed formulas of Porter et al. (2008), in float64, for m1 = D = 1.

    NaN if the root p is complex or 0/0 arises.
    """
    M = 1 + omega
    G = (2 - 3 * k + k**2) / (6 * M**2)
    H = 2 * (k - 1) * (2 + omega - omega**2) / (6 * M**2)
    I = 2 * (1 - omega + omega**2) / (6 * M**2)
    with np.errstate(
        all="ignore"
    ):  # outside the formulas' domain, which NaN and ∞ show
        # The root with -√ of (G+H+I) p² - (H+3I) p + 2I = 0.
        p = ((H + 3 * I) - np.sqrt((H + 3 * I) ** 2 - 8 * (G + H + I) * I)) / (
            2 * (G + H + I)
        )
        a = 1 - k * p + 3 * (p - 1) + p * H / I
        return np.asarray(np.abs(np.sqrt(1 / (I * (k * p + a))) * (k * p - p) / 2))


def losses(
    exponents: Array = EXPONENTS, ratios: Array = RATIOS
) -> dict[tuple[str, str], Array]:
    """Float64 errors of the closed forms in ulps: {(formula, closure): array over (k, ω)}."""
    k, omega = np.meshgrid(exponents, ratios, indexing="ij")
    result = {}
    for closure in CLOSURES:
        wave = closed_wave(closure)
        numeric = wave.numeric(missing="nan")
        for label, (name, *arguments) in FORMS.items():
            given = [x if isinstance(x, str) else float(x) for x in arguments]
            value = getattr(numeric, name)(k, omega, *given)
            lost = in_ulps(
                value, true_values(wave, form(wave, name, *arguments), k, omega)
            )
            lost[np.isnan(lost) & np.isfinite(value)] = (
                np.inf
            )  # a number without a wave
            result[label, closure] = lost
    wave = closed_wave("paper's closure")
    true = true_values(wave, wave.beta, k, omega)
    result["β", PRINTED] = in_ulps(printed_beta(k, omega), true)
    return result


def ulps() -> Report:
    """k = 1 + 1e-6 … 20, ω = 1e-6 … 1e6: how many ulps do lwa's closed forms lose in float64?"""
    lost = losses()
    largest = {
        key: float(np.max(x, initial=0, where=np.isfinite(x)))
        for key, x in lost.items()
    }
    missing = {key: int(np.count_nonzero(np.isinf(x))) for key, x in lost.items()}
    ours, beta = [key for key in lost if key[1] != PRINTED], ("β", PRINTED)
    worst, none = max(largest[key] for key in ours), sum(missing[key] for key in ours)
    findings = (
        Finding("largest loss of all in ulps", worst, 0, PROMISED, key="loss_ulps"),
        Finding("points at which a form has no number", none, 0, 0, key="missing"),
        Finding(
            "β as printed: loss in ulps",
            largest[beta],
            PROMISED,
            key="printed_loss_ulps",
        ),
        Finding(
            "β as printed: points without", missing[beta], 1, key="printed_missing"
        ),
    )
    sources = (*CLOSURES, PRINTED)
    columns = (
        Column(label="largest loss, ulps"),
        *(Column("", x, format=".2g") for x in sources),
    )
    rows = tuple(
        (form, *(largest.get((form, source)) for source in sources)) for form in FORMS
    )
    curves = []
    for label, key in (("lwa", ("β", "paper's closure")), (PRINTED, beta)):
        worst_at_k = np.max(
            lost[key], axis=1, where=np.isfinite(lost[key]), initial=0.0
        )
        curves.append(Curve(label, EXPONENTS - 1, worst_at_k))
    panel = Panel("k - 1", "largest loss of β, in ulps", tuple(curves), "xy")
    return Report(ulps.__doc__ or "", (Table(columns, rows),), findings, (panel,))


def true_wave(
    law: ContactLaw, p0: float, B: float
) -> tuple[Any, Callable[[Any], Any], Any]:
    """Return the speed of a wave that rises by B from p0, its half width at a height, and a height.

    The wave runs in equal beads, D = 1. Its half width at the height v is ξ = ∫ √(I F′/(Q(B) - Q))
    dv/v, by mpmath (`lwa.loaded.background` defines the letters); at the height that is returned
    last, the force has half of its rise. Call the function under `mpmath.workdps`.
    """
    x = sp.Dummy("x", positive=True)
    W, F, slope = (
        sp.lambdify(x, law.of_strain(x, sp.S.One, n), "mpmath") for n in (-1, 0, 1)
    )
    load, B = mp.mpf(p0), mp.mpf(B)

    def Q(v: Any) -> Any:
        return 2 * (W(load + v) - W(load) - F(load) * v) / v**2

    def rate(theta: Any) -> Any:  # v = B/cosh²θ takes the root out of the peak
        v = B / mp.cosh(theta) ** 2
        return 2 * mp.tanh(theta) * mp.sqrt(slope(load + v) / (top - Q(v)) / 12)

    def place(v: Any) -> Any:
        end = mp.acosh(mp.sqrt(B / v))
        pieces = [
            0,
            *(end / 2**n for n in range(6, -1, -1)),
        ]  # steep laws vary fast at the peak
        return mp.quad(rate, pieces, method="gauss-legendre", maxdegree=4)

    top, half = Q(B), (F(load) + F(load + B)) / 2
    height = mp.findroot(
        lambda v: F(load + v) / half - 1, (B / 3, B), solver="anderson"
    )
    return mp.sqrt(top), place, height


def width_error(cell: Cell, p0: float, quantity: str) -> float:
    """Return the relative error of the float64 FWHM of a wave on the background strain p0."""
    wave = loaded_wave(cell, rise=RISE, background=p0, k="3/2")
    with mp.workdps(REFERENCE_DIGITS):
        _, place, height = true_wave(wave.law, p0, RISE)
        ratio = 12 * mp.mpf(
            sp.N(wave.field.I, REFERENCE_DIGITS)
        )  # of I to that of equal beads
        true = (
            2
            * mp.sqrt(ratio)
            * place(height if quantity == "force" else mp.mpf(RISE) / 2)
        )
        return abs(float(mp.mpf(float(wave.fwhm(quantity))) / true - 1))


def under_load() -> Report:
    """p0/B = 1e-12 … 1e12: how accurate are V² and the FWHM of a wave under load in float64?"""
    findings, curves = [], []
    for k in (sp.Rational(11, 10), sp.Rational(3, 2), sp.Integer(2), sp.Integer(3)):
        beads = Cell((1,), spacing=1)
        waves = [
            loaded_wave(beads, rise=RISE, background=p0, k=k) for p0 in LOADS * RISE
        ]
        exact = (wave.speed**2 for wave in waves)
        with mp.workdps(REFERENCE_DIGITS):
            true = np.array(
                [mp.mpf(sp.N(squared, REFERENCE_DIGITS)) for squared in exact], object
            )
        lost = in_ulps(np.array([number(wave.speed**2) for wave in waves]), true)
        name, key = (
            f"V² at k = {k}: largest loss in ulps",
            "loss_ulps" * (k == sp.Rational(3, 2)),
        )
        findings.append(Finding(name, float(lost.max()), 0, ALLOWED, key=key))
        curves.append(Curve(f"k = {k}", LOADS, np.maximum(lost, 0.01)))
    for chain, masses in (("equal beads", (1,)), ("masses 1, 1/4", (1, "1/4"))):
        cell = Cell(masses, spacing=1)
        for quantity in ("strain", "force"):
            worst = max(width_error(cell, p0, quantity) for p0 in LOADS[::12] * RISE)
            key = f"{quantity}_error" if len(masses) == 1 else ""
            name = f"FWHM of the {quantity}, {chain}: largest relative error"
            findings.append(Finding(name, worst, 0, 1e-12, key=key))
    panel = Panel("p0 / B", "loss of V², in ulps", tuple(curves), "xy")
    return Report(under_load.__doc__ or "", (), tuple(findings), (panel,))


def contact_loss() -> Report:
    """Contacts open and close, where F = δ^k is not smooth: which order does the splitting keep?"""
    findings, curves = [], []
    # F = δ^{3/2} has no second derivative where a contact opens: k + 1 of the 4 orders remain. The
    # bounds ± 0.35 are the scatter of the openings' places within a step.
    for how, coarse, fine, order in (
        ("closed", 0.1, 0.05, 4.0),
        ("opening", 0.1, 0.012, 2.5),
    ):
        steps = np.geomspace(coarse, fine, 5)
        errors = splitting_errors(1.5, how == "opening", steps)
        (slope, _), covariance = np.polyfit(np.log(steps), np.log(errors), 1, cov=True)
        name, error = (
            f"{METHOD}, k = 3/2, contacts {how}: order",
            math.sqrt(covariance[0, 0]),
        )
        bounds = order - 0.35, order + 0.35
        findings.append(Finding(name, float(slope), *bounds, error, f"order_{how}"))
        curves.append(Curve(how, steps, errors))
    panel = Panel("step", "error of the displacements at t = 8", tuple(curves), "xy")
    return Report(contact_loss.__doc__ or "", (), tuple(findings), (panel,))


def splitting_errors(k: float, opens: bool, steps: Array) -> Array:
    """Return the splitting's error of the displacements at t = 8 for each of the steps.

    The scene is six unequal beads under a load against a wall, the reference a run at step 5e-4. An
    error is a root mean square over six initial states and nine steps, 0.8 to 1.25 times the given
    step, because it depends on where in a step contacts open.
    """
    masses, factors = (1.0, 0.3, 2.0, 0.7, 1.1, 0.5), np.linspace(0.8, 1.25, 9)
    squares, starts = (
        np.zeros(len(steps)),
        np.random.default_rng(8).uniform(-1, 1, (6, 6)),
    )
    for start in starts:
        scene = pressed(masses, start if opens else start / 10, opens, 8.0, k)
        reference = simulate(scene, method=METHOD, step=5e-4).displacements
        for i, step in enumerate(steps):
            for factor in factors:
                run = simulate(scene, method=METHOD, step=step * factor)
                squares[i] += np.abs(run.displacements - reference).max() ** 2
    return np.asarray(np.sqrt(squares / len(starts) / len(factors)))


def long_run(lasting: float = 1e6, segments: int = 200) -> Report:
    """Three beads against a wall over 10⁶ time units, by the splitting: does the energy drift?"""
    smooth = energy_errors(False, 0.2, lasting, segments)
    walk = energy_errors(True, 0.1, lasting, segments)
    largest, opening, tenth = np.abs(smooth).max(), np.abs(walk).max(), segments // 10
    growth = np.abs(smooth[-tenth:]).max() / np.abs(smooth[:tenth]).max()
    time = lasting / segments * np.arange(segments + 1)
    trend = np.polyfit(time, smooth, 1)[0] * lasting / largest
    drift = simulate(three_beads(False, 2e2), method="DOP853").energy_drift / 2e2
    power, closed = spreading(walk), f"closed contacts, {METHOD} at step 0.2"
    # The energy error of a symplectic method swings in a band, without growth or trend. An opening
    # within a step adds an error of random sign: a walk whose spread grows as √t.
    findings = (
        Finding(
            f"{closed}: largest energy error", largest, 0.0, 5e-5, key="energy_error"
        ),
        Finding(
            f"{closed}: last tenth over first", growth, 0.5, 1.5, key="last_over_first"
        ),
        Finding(f"{closed}: trend over largest error", trend, -0.2, 0.2, key="trend"),
        Finding(
            "closed contacts, DOP853 at 1e-9: drift, extrapolated", drift * lasting
        ),
        Finding(
            "opening, step 0.1: energy error",
            opening,
            0.0,
            0.3,
            key="energy_error_opening",
        ),
        Finding(
            "opening: power of time, 1/2 at random",
            power,
            0.3,
            0.75,
            key="power_of_walk",
        ),
    )
    curves = (
        Curve("contacts closed", time[1:], np.abs(smooth[1:])),
        Curve("contacts opening", time[1:], np.abs(walk[1:])),
        Curve("closed, DOP853 at 1e-9, extrapolated", time[1:], abs(drift) * time[1:]),
    )
    panel = Panel("time", "|energy error|, relative", curves, "xy")
    return Report(long_run.__doc__ or "", (), findings, (panel,))


def pressed(
    masses: Sequence[float],
    velocities: Sequence[float],
    opens: bool,
    duration: float,
    k: float,
) -> Scene:
    """Return a scene of beads under a load against a wall; contacts open if ``opens``."""
    return Scene(
        masses=tuple(masses),
        stiffnesses=(1.0, 2.0, 0.5, 1.5, 3.0)[: len(masses) - 1],
        wall=1.0,
        k=k,
        precompression=0.2 if opens else 1.0,
        velocities=tuple(velocities),
        duration=duration,
        samples=2,
    )


def three_beads(opens: bool, duration: float) -> Scene:
    """Three unequal beads under a load against a wall, the scene of `long_run`."""
    velocities = (0.0, 0.8, -0.6) if opens else (0.0, 0.1, -0.05)
    return pressed((1.0, 0.3, 2.0), velocities, opens, duration, 1.5)


def energy_errors(opens: bool, step: float, lasting: float, segments: int) -> Array:
    """Return the relative energy errors of `three_beads` at the ends of segments, and 0 before."""
    scene, energy = three_beads(opens, lasting / segments), [1.0]
    for _ in range(segments):
        run = simulate(scene, method=METHOD, step=step)
        energy.append(energy[-1] * (1 + run.energy_drift))
        displacements, velocities = tuple(run.displacements), tuple(run.velocities)
        scene = replace(scene, displacements=displacements, velocities=velocities)
    return np.array(energy) - 1


def spreading(walk: Array) -> float:
    """Return the exponent p of √⟨(x(t + lag) - x(t))²⟩ ~ lag^p of a walk x: 1/2 if random."""
    lags = 2 ** np.arange(6)
    spread = [math.sqrt(np.mean((walk[lag:] - walk[:-lag]) ** 2)) for lag in lags]
    return float(np.polyfit(np.log(lags), np.log(spread), 1)[0])


CASES: Mapping[str, Callable[[], Report]] = {
    "contact-loss": contact_loss,
    "long-run": long_run,
    "ulps": ulps,
    "under-load": under_load,
}
"""The cases by their names."""


def _curves(panel: Panel) -> dict[str, Any]:
    """Return the curves of a panel for JSON."""
    curves = [{"label": c.label, "x_value": c.x, "y_value": c.y} for c in panel.curves]
    return {"x": panel.x, "y": panel.y, "scale": panel.scale, "curves": plain(curves)}


_NAMES = click.Choice([*CASES])


@study(
    option(
        "--case",
        "names",
        multiple=True,
        type=_NAMES,
        says="Only this case; repeatable.",
    )
)
def hard(names: Collection[str] = (), progress: Progress[str] = iter) -> Report:
    """Last digits at extreme k, ω and loads, contacts that open, and long runs (half a minute).

    names: cases to run, by default all; raises `lwa.InputError` for a name beside `CASES`. JSON:
    ``cases``, each with ``case``, ``question``, numbers, ``findings`` and the curves of ``panel``.
    """
    wanted = {one_of(name, CASES, "case") for name in names} or set(CASES)
    cases = {
        name: CASES[name]()
        for name in progress([name for name in CASES if name in wanted])
    }
    rows = [
        (name, *row)
        for name, report in cases.items()
        for row in findings_table(report.findings).rows
    ]
    case = Column("case", format=lambda name: f"{name}\n{cases[name].title}")
    findings = Table((case, *FINDING_COLUMNS), tuple(rows), by="case")
    return Report(
        "Hard cases",
        (findings, *(table for report in cases.values() for table in report.tables)),
        # without keys: the cases' numbers of one name would replace each other
        tuple(replace(f, key="") for report in cases.values() for f in report.findings),
        tuple(
            replace(panel, title=name) for name in cases for panel in cases[name].panels
        ),
        data={
            "cases": [
                {"case": name, "question": report.title}
                | report.document()
                | {"panel": _curves(*report.panels)}
                for name, report in cases.items()
            ]
        },
    )


if __name__ == "__main__":
    hard.main()
