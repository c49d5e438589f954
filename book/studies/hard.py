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
from validation.report.study import Report, option, study
from validation.report.table import (
    FINDING_COLUMNS,
    Column,
    Finding,
    Row,
    Table,
    findings_table,
)
from validation.scenes.checks import one_of
from validation.scenes.scene import Scene

REFERENCE_DIGITS = 80  # of mpmath; cancellation on the grid leaves more than 50 of them
ALLOWED = 8.0  # ulps that V² under load may lose
PROMISED = 1e-11 / 2**-52  # ulps that a closed form in floats may lose
METHOD = "symplectic"  # the splitting, the method without an error estimate

# Grid of k and of ω = m2/m1; 0.2733 is the paper's. Numbers next to 1 and 2 cancel worst.
EXPONENTS = 1 + np.array([1e-6, 1e-4, 0.01, 0.5, 1, 1 + 2**-30, 1.5, 2, 4, 19])
RATIOS = np.array([*10.0 ** np.arange(-6, 7), 0.2733, 1 - 2**-40, 1 + 2**-40, 4.0])
RISE = 0.7  # B of a wave on a background; no power of 2
LOADS = 10.0 ** np.arange(-12, 12.5, 0.5)  # p0/B

# Waves that are compared, as options of `lwa.homogenize`.
CLOSURES: Mapping[str, Mapping[str, Any]] = {
    "paper's closure": {},
    "full closure": {"closure": "full", "field": "first"},
    "canonical field": {"closure": "full", "field": "center"},
}

# Closed forms: names of a wave's attribute, and its arguments. B itself overflows where k < 3.
FORMS: Mapping[str, tuple[Any, ...]] = {
    "β": ("beta",),
    "width π/β": ("width",),
    "FWHM of strain": ("fwhm", "strain"),
    "FWHM of force": ("fwhm", "force"),
    "FWHM of velocity": ("fwhm", "velocity"),
    "speed at B = 2": ("speed", 2),
    "ln B at V = 2": ("log_amplitude", 2),
    "ln B at V = 2^1000": ("log_amplitude", 2**1000),
}


# --- the last digits of closed forms


def closed_wave(closure: str) -> CompactWave:
    """Return the wave of one of `CLOSURES`, D = 1, with k, m1, m2 as symbols."""
    chain = Dimer("m1", "m2", spacing=1)
    return homogenize(chain, **CLOSURES[closure]).pde.traveling_wave()


def form(wave: CompactWave, name: str, *arguments: Any) -> sp.Expr:
    """Return the exact expression of one of `FORMS`: a wave's attribute and its arguments."""
    # V² = V²(B = 1) B^{k-1}, V²(B = 1) being the wave's speed_factor.
    if name == "log_amplitude":
        return (2 * sp.log(*arguments) - sp.log(wave.speed_factor)) / (wave.k - 1)
    value = getattr(wave, name)
    return value(*arguments) if arguments else value


def true_values(wave: CompactWave, expression: sp.Expr, k: Array, omega: Array) -> Any:
    """Evaluate an expression of a `closed_wave` by mpmath, to `REFERENCE_DIGITS` digits.

    Parameters
    ----------
    wave : CompactWave
        A wave in k, m1, m2.
    expression : Expr
        The expression.
    k, omega : ndarray
        Arrays of one shape.

    Returns
    -------
    ndarray
        Numbers of mpmath, None where there is no wave.
    """
    m1, m2 = wave.cell.masses

    def function(each: sp.Expr) -> Callable[..., Any]:
        made: Callable[..., Any] = sp.lambdify((wave.k, m2), each.subs(m1, 1), "mpmath")
        return made

    value = function(expression)
    coefficients, speed = function(wave.coefficient_sum), function(wave.speed_factor)

    def at(*point: float) -> Any:
        numbers = tuple(map(mp.mpf, point))
        exists = coefficients(*numbers) > 0 and speed(*numbers) > 0
        return value(*numbers) if exists else None

    with mp.workdps(REFERENCE_DIGITS):
        return np.frompyfunc(at, 2, 1)(k, omega)


def in_ulps(value: Array, true: Any) -> Array:
    """Return |value - true| in ulps.

    NaN where there is neither a wave nor a value, ∞ where one of the two is missing.
    """

    def loss(x: float, exact: Any) -> float:
        if exact is None and math.isnan(x):
            return math.nan
        if exact is None or not math.isfinite(x):
            return math.inf
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
    total = G + H + I
    with np.errstate(all="ignore"):  # outside the formulas' domain
        # The root with -√ of (G+H+I) p² - (H+3I) p + 2I = 0.
        root = np.sqrt((H + 3 * I) ** 2 - 8 * total * I)
        p = ((H + 3 * I) - root) / (2 * total)
        a = 1 - k * p + 3 * (p - 1) + p * H / I
        return np.asarray(np.abs(np.sqrt(1 / (I * (k * p + a))) * (k * p - p) / 2))


def ulps() -> Report:
    """k = 1 + 1e-6 … 20, ω = 1e-6 … 1e6: how many ulps do lwa's closed forms lose in float64?"""
    k, omega = np.meshgrid(EXPONENTS, RATIOS, indexing="ij")
    records = []
    for label, (name, *arguments) in FORMS.items():
        record: dict[str, Any] = {"form": label}
        for closure in CLOSURES:
            wave = closed_wave(closure)
            # the quantity of a width is a word
            given = [x if isinstance(x, str) else float(x) for x in arguments]
            value = getattr(wave.numeric(missing="nan"), name)(k, omega, *given)
            true = true_values(wave, form(wave, name, *arguments), k, omega)
            record[closure] = float(np.nanmax(in_ulps(value, true)))
        records.append(record)
    wave = closed_wave("paper's closure")
    printed = in_ulps(printed_beta(k, omega), true_values(wave, wave.beta, k, omega))
    known = printed[np.isfinite(printed)]
    worst = max(record[closure] for record in records for closure in CLOSURES)
    missing = int(np.count_nonzero(np.isinf(printed)))
    findings = (
        Finding("largest loss of all in ulps", worst, 0, PROMISED, key="loss_ulps"),
        Finding("β as printed: loss in ulps", known.max(), PROMISED),
        Finding("β as printed: points without", missing, 1),
    )
    columns = (
        Column("form", "largest loss, ulps"),
        *(Column(closure, closure, format=".2g") for closure in CLOSURES),
    )
    at_k = [row[np.isfinite(row)].max() for row in printed]
    curve = Curve("β as printed", EXPONENTS - 1, at_k)
    panel = Panel("k - 1", "largest loss of β, in ulps", (curve,), "xy")
    table = Table(columns, records)
    return Report(ulps.__doc__ or "", (table,), findings, (panel,))


# --- waves under load


def true_wave(
    law: ContactLaw, p0: float, B: float
) -> tuple[Any, Callable[[Any], Any], Any]:
    """Return the speed of a wave that rises by B from p0, its half width at a height, and a height.

    The wave runs in equal beads, D = 1. Its half width at the height v is the integral of
    ``√(I F′/(Q(B) - Q))/v``, by mpmath (`lwa.loaded.background` defines the letters); at the height
    that is returned last, the force has half of its rise. Call the function under
    `mpmath.workdps`.
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
        # steep laws vary fast at the peak
        pieces = [0, *(end / 2**n for n in range(6, -1, -1))]
        return mp.quad(rate, pieces, method="gauss-legendre", maxdegree=4)

    top = Q(B)
    half = (F(load) + F(load + B)) / 2
    start = B / 3, B
    height = mp.findroot(lambda v: F(load + v) / half - 1, start, solver="anderson")
    return mp.sqrt(top), place, height


def under_load() -> Report:
    """p0/B = 1e-12 … 1e12: how accurate are V² and the FWHM of a wave under load in float64?"""
    cell = Cell((1,), spacing=1)
    lost, off = [], []
    for p0 in LOADS * RISE:
        wave = loaded_wave(cell, rise=RISE, background=p0, k="3/2")
        with mp.workdps(REFERENCE_DIGITS):
            speed, place, height = true_wave(wave.law, p0, RISE)
            true = 2 * place(height)
            off.append(abs(float(mp.mpf(float(wave.fwhm("force"))) / true - 1)))
            # dx/dt is V √k at the masses and stiffnesses 1
            squared = np.array([speed**2 * 3 / 2], object)
        lost.append(in_ulps(np.array([number(wave.speed**2)]), squared)[0])
    findings = (
        Finding("V²: largest loss in ulps", max(lost), 0, ALLOWED, key="load_ulps"),
        Finding("FWHM of the force: largest relative error", max(off), 0, 1e-12),
    )
    curve = Curve("k = 3/2", LOADS, np.maximum(lost, 0.01))
    panel = Panel("p0 / B", "loss of V², in ulps", (curve,), "xy")
    return Report(under_load.__doc__ or "", (), findings, (panel,))


# --- contacts that open, and long runs


def contact_loss() -> Report:
    """Contacts open and close, where F = δ^k is not smooth: which order does the splitting keep?"""
    findings, curves = [], []
    # F = δ^{3/2} has no second derivative where a contact opens: k + 1 of the 4 orders remain. The
    # bounds ± 0.35 are the scatter of the openings' places within a step.
    for how, finest, order in (("closed", 0.05, 4.0), ("opening", 0.012, 2.5)):
        steps = np.geomspace(0.1, finest, 5)
        errors = splitting_errors(1.5, how == "opening", steps)
        fit = np.polyfit(np.log(steps), np.log(errors), 1, cov=True)
        slope, error = float(fit[0][0]), math.sqrt(fit[1][0, 0])
        name = f"{METHOD}, k = 3/2, contacts {how}: order"
        bounds = order - 0.35, order + 0.35
        findings.append(Finding(name, slope, *bounds, error, f"order_{how}"))
        curves.append(Curve(how, steps, errors))
    panel = Panel("step", "error of the displacements at t = 8", tuple(curves), "xy")
    return Report(contact_loss.__doc__ or "", (), tuple(findings), (panel,))


def splitting_errors(k: float, opens: bool, steps: Array) -> Array:
    """Return the splitting's error of the displacements at t = 8 for each of the steps.

    The scene is six unequal beads under a load against a wall, the reference a run at step 5e-4. An
    error is a root mean square over six initial states and nine steps, 0.8 to 1.25 times the given
    step, because it depends on where in a step contacts open.
    """
    masses = 1.0, 0.3, 2.0, 0.7, 1.1, 0.5
    factors = np.linspace(0.8, 1.25, 9)
    starts = np.random.default_rng(8).uniform(-1, 1, (6, 6))
    squares = np.zeros(len(steps))
    for start in starts:
        scene = pressed(masses, start if opens else start / 10, opens, 8.0, k)
        reference = simulate(scene, method=METHOD, step=5e-4).displacements
        for i, step in enumerate(steps):
            for factor in factors:
                run = simulate(scene, method=METHOD, step=step * factor)
                squares[i] += np.abs(run.displacements - reference).max() ** 2
    return np.asarray(np.sqrt(squares / len(starts) / len(factors)))


def long_run() -> Report:
    """Three beads against a wall over 10⁶ time units, by the splitting: does the energy drift?"""
    lasting, segments = 1e6, 200
    errors = energy_errors(False, 0.2, lasting, segments)
    largest = np.abs(errors).max()
    tenth = segments // 10
    growth = np.abs(errors[-tenth:]).max() / np.abs(errors[:tenth]).max()
    time = lasting / segments * np.arange(segments + 1)
    trend = np.polyfit(time, errors, 1)[0] * lasting / largest
    drift = simulate(three_beads(False, 2e2), method="DOP853").energy_drift / 2e2
    # The energy error of a symplectic method swings in a band, without growth or trend.
    findings = (
        Finding("largest energy error", largest, 0.0, 5e-5, key="energy_error"),
        Finding("last tenth over first", growth, 0.5, 1.5),
        Finding("trend over largest error", trend, -0.2, 0.2),
        Finding("DOP853 at 1e-9: drift, extrapolated", drift * lasting),
    )
    curves = (
        Curve(f"{METHOD} at step 0.2", time[1:], np.abs(errors[1:])),
        Curve("DOP853 at 1e-9, extrapolated", time[1:], abs(drift) * time[1:]),
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
    scene = three_beads(opens, lasting / segments)
    energy = [1.0]
    for _ in range(segments):
        run = simulate(scene, method=METHOD, step=step)
        energy.append(energy[-1] * (1 + run.energy_drift))
        scene = replace(
            scene,
            displacements=tuple(run.displacements),
            velocities=tuple(run.velocities),
        )
    return np.array(energy) - 1


CASES: Mapping[str, Callable[[], Report]] = {
    "contact-loss": contact_loss,
    "long-run": long_run,
    "ulps": ulps,
    "under-load": under_load,
}
"""The cases by their names."""


@study(
    option(
        "--case",
        "Only this case; repeatable.",
        to="names",
        multiple=True,
        type=click.Choice([*CASES]),
    )
)
def hard(names: Collection[str] = (), progress: Progress[str] = iter) -> Report:
    """Last digits at extreme k, ω and loads, contacts that open, and long runs (half a minute).

    Parameters
    ----------
    names : collection of str
        Cases to run, by default all.

    Notes
    -----
    JSON has ``rows``: ``case`` and the columns of a finding.
    """
    wanted = [one_of(name, CASES, "case") for name in names] or [*CASES]
    tables: list[Table] = []
    findings: list[Finding] = []
    panels: list[Panel] = []
    rows: list[Row] = []
    for name in progress(wanted):
        report = CASES[name]()
        title = f"{name}\n{report.title}"
        for row in findings_table(report.findings).rows:
            rows.append({"case": title, **row})
        tables += report.tables
        findings += report.findings
        panels += [replace(panel, title=name) for panel in report.panels]
    columns = Column("case"), *FINDING_COLUMNS
    measured = Table(columns, rows, "rows", by="case")
    return Report("Hard cases", (measured, *tables), tuple(findings), tuple(panels))


if __name__ == "__main__":
    hard.main()
