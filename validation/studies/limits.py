"""The theory's limits on the lattice: equal masses, m1 ≫ m2, and k → 1.

The wave of `lwa` is the leading order in ε = k - 1, so its error against the lattice must vanish
like a known power of ε. Each chain is started from the theory's own wave, which sheds what it is
not and is measured where it has run four, six and eight times its support; the difference between
the last two places is the lattice's own error.

The powers and the coefficients of the error follow from log v as a series in ε at fixed X = √ε x
(D = 1, equal masses). The lattice's exact wave has -3X² + ε (18/5 X² - 3/10 X⁴) + …, the theory's
-3X² + ε (9/2 X² - 3/2 X⁴) + …, and the log of the force is k = 1 + ε times as large. Hence, for
theory over lattice - 1,

    FWHM of force and strain        (3/20 - ln 2 / 15) ε
    support π/β, by the impulse     1/20 ε
    speed at equal strain           -3/40 ε²     (c² = 1 - ε/2 + 2ε²/5 against 2/(k + 1)).

With m1 ≫ m2 the light beads only hand the force on: a chain of spacing 2D, with the same errors.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np
import sympy as sp

from lwa import Dimer, TravelingWave, homogenize
from validation.lattice.run import Run
from validation.lattice.simulate import simulate
from validation.pulses.pulse import Measured, derived, impulse, measure, speed
from validation.report.command import output, progress, show
from validation.report.figure import figure
from validation.report.text import document, percent, table, text
from validation.scenes.scene import Scene
from validation.waves.theory import Compacton

if TYPE_CHECKING:
    from matplotlib.figure import Figure

EXPONENTS = (sp.Rational(3, 2), sp.Rational(5, 4), sp.Rational(11, 10))
"""Hertz, and two on the way to k = 1."""

EQUAL = sp.Integer(1)
LIGHT = sp.Rational(1, 1000)
"""ω = m2/m1 of the two chains; the second is small enough that its square does not show."""

LIMIT = (4 * LIGHT, LIGHT, LIGHT / 4)
"""The ω from which the lattice is extrapolated to ω → 0 at k = 3/2."""

AMPLITUDES = (sp.Rational(1, 100), sp.Integer(1), sp.Integer(100))
"""Peak strains B of the runs that measure the exponent of F_m against V_s."""

QUANTITIES = ("FWHM of force", "FWHM of strain", "support π/β", "speed V_s at B = 1")
"""Lengths in D; force and strain are a contact's; the support is by the impulse ∫F dx / F_m."""


@dataclass(frozen=True)
class Law:
    """How the theory's error vanishes: coefficient · ε^order, and the bounds that hold it to that.

    constant : |error| ≤ constant · ε^order at each k measured.
    order_bound, coefficient_bound : relative, on the fitted order and the extrapolated coefficient.
    """

    order: int
    coefficient: sp.Expr
    constant: float
    order_bound: float
    coefficient_bound: float


_WIDTH = Law(1, sp.Rational(3, 20) - sp.log(2) / 15, 0.113, 0.05, 0.01)
_SUPPORT = Law(1, sp.Rational(1, 20), 0.077, 0.2, 0.02)
_SPEED = Law(2, -sp.Rational(3, 40), 0.075, 0.15, 0.01)
LAWS = dict(zip(QUANTITIES, (_WIDTH, _WIDTH, _SUPPORT, _SPEED), strict=True))


@dataclass(frozen=True)
class Row:
    """One comparison.

    ``omega`` is 0 for the limit ω → 0, ``k`` is None where all of `EXPONENTS` enter. The row is
    ok when the relative error, with the lattice's own added to it, stays within the bound.
    """

    quantity: str
    k: sp.Rational | None
    omega: sp.Rational
    theory: sp.Expr
    lattice: Measured
    bound: float

    @property
    def theory_value(self) -> float:
        """The theory's number."""
        return float(sp.N(self.theory, 17))

    @property
    def error(self) -> float:
        """Theory over lattice, less 1."""
        return self.theory_value / self.lattice.value - 1

    @property
    def ok(self) -> bool:
        """Whether the row holds."""
        return bool(abs(self.error) + self.lattice.relative_error <= self.bound)


@dataclass(frozen=True)
class Limits:
    """All rows of the comparison."""

    rows: tuple[Row, ...]

    @property
    def ok(self) -> bool:
        """Whether every row holds."""
        return all(row.ok for row in self.rows)


@dataclass(frozen=True)
class LatticeWave:
    """What the lattice makes of a wave: `QUANTITIES`, speed dx/dt and peak contact force."""

    quantities: dict[str, Measured]
    speed: Measured
    force: Measured


def theory_at(k: sp.Expr, omega: sp.Expr) -> TravelingWave:
    """The paper's wave for masses 1 and ω, equal contacts A = 1 and D = 1."""
    return homogenize(Dimer(1, omega, spacing=1), k=k).pde.traveling_wave()


def theory_values(wave: TravelingWave) -> dict[str, sp.Expr]:
    """`QUANTITIES` of the theory, exact."""
    values = wave.fwhm("force"), wave.fwhm("strain"), wave.width, wave.speed(1)
    return dict(zip(QUANTITIES, values, strict=True))


def lattice_wave(wave: TravelingWave, B: float = 1.0) -> LatticeWave:
    """Start the lattice from the theory's wave and measure what becomes of it.

    Means over the two contacts of a cell, which the exact wave passes as mirror images.
    """
    compacton = Compacton(wave, B)
    start = int(compacton.support / 2) + 1
    places = tuple(2 * round((start + s * compacton.support) / 2) for s in (4, 6, 8))
    run = _run(compacton, start, places)
    scale = float(sp.N(wave.speed_scale)) * B ** ((compacton.k - 1) / 2)
    per_contact = [_between(run, compacton, places, side) for side in (0, 1)]
    early, late = np.mean(per_contact, axis=0)
    numbers = [Measured(float(a), float(b)) for a, b in zip(late, early, strict=True)]
    *lengths, strain, velocity, force = numbers
    at_unit_strain = derived(
        lambda V, u: V / scale / (u / B) ** ((compacton.k - 1) / 2), velocity, strain
    )
    values = dict(zip(QUANTITIES, (*lengths, at_unit_strain), strict=True))
    return LatticeWave(values, velocity, force)


def _run(compacton: Compacton, start: int, places: Sequence[int]) -> Run:
    wave = compacton.wave
    cells = (places[-1] + int(compacton.support)) // 2 + 2
    beads = np.arange(2 * cells) - start
    compression = compacton.compression(beads[:-1] + 0.5)
    scene = Scene.of_cell(
        wave.cell,
        cells,
        wave.k,
        # The beads behind have moved by all compressions before them.
        displacements=np.append(np.cumsum(compression[::-1])[::-1], 0.0),
        velocities=compacton.velocity(beads),
        contact_sensors=[place + side for place in places for side in (0, 1)],
        duration=(2 * cells - start - compacton.support / 4) / compacton.speed,
        samples=80 * cells,
    )
    if wave.cell.masses[1] == wave.cell.masses[0]:
        return simulate(scene, rtol=1e-9, atol=1e-9)
    # The light beads set the step here, far below what the pulse needs at the same tolerance.
    return simulate(scene, rtol=1e-7, atol=1e-6)


def _between(
    run: Run, compacton: Compacton, places: Sequence[int], side: int
) -> list[tuple[float, ...]]:
    """(widths of force and strain, support, strain, speed, force) at the last two places."""
    forces, strains = run.contact_force[side::2], run.compression[side::2]
    pulses = [measure(run.time, force) for force in forces]
    unit_support = compacton.support / compacton.arch_integral(compacton.k * compacton.m)
    result: list[tuple[float, ...]] = []
    for i in (1, 2):
        pulse, strain = pulses[i], measure(run.time, strains[i])
        V = speed(pulses[i - 1], pulse, places[i] - places[i - 1])
        reach = 0.6 * compacton.support / V
        push = impulse(run.time, forces[i], pulse.arrival - reach, pulse.arrival + reach)
        support = unit_support * push * V / pulse.peak
        result.append((pulse.fwhm * V, strain.fwhm * V, support, strain.peak, V, pulse.peak))
    return result


Case = tuple[sp.Rational, sp.Rational, sp.Rational]
"""k, ω and B of one run."""


def limits(progress: Callable[[list[Case]], Iterable[Case]] = iter) -> Limits:
    """Run all chains and compare: some ten seconds, shown by ``progress`` (such as `tqdm.tqdm`)."""
    cases: dict[Case, None] = dict.fromkeys(
        [(k, omega, AMPLITUDES[1]) for omega in (EQUAL, LIGHT) for k in EXPONENTS]
        + [(k, EQUAL, B) for k in EXPONENTS for B in AMPLITUDES]
        + [(EXPONENTS[0], omega, AMPLITUDES[1]) for omega in LIMIT]
    )
    waves = {(k, omega): theory_at(k, omega) for k, omega, _ in cases}
    lattice = {
        (k, omega, B): lattice_wave(waves[k, omega], float(B))
        for k, omega, B in progress(list(cases))
    }
    rows: list[Row] = []
    for omega in (EQUAL, LIGHT):
        theory = [theory_values(waves[k, omega]) for k in EXPONENTS]
        found = [lattice[k, omega, AMPLITUDES[1]].quantities for k in EXPONENTS]
        for quantity in QUANTITIES:
            columns = [t[quantity] for t in theory], [f[quantity] for f in found]
            rows += _quantity_rows(quantity, omega, *columns)
    first = EXPONENTS[0]
    rows += _limit_rows([lattice[first, omega, AMPLITUDES[1]] for omega in LIMIT])
    for k in EXPONENTS:
        rows.append(_exponent_row(k, waves[k, EQUAL], [lattice[k, EQUAL, B] for B in AMPLITUDES]))
    return Limits(tuple(rows))


def _quantity_rows(
    quantity: str, omega: sp.Rational, theory: list[sp.Expr], lattice: list[Measured]
) -> list[Row]:
    """One quantity at each k, and how its error vanishes with ε."""
    law = LAWS[quantity]
    epsilon = np.array([float(k - 1) for k in EXPONENTS])
    rows = [
        Row(quantity, k, omega, t, f, law.constant * float(k - 1) ** law.order)
        for k, t, f in zip(EXPONENTS, theory, lattice, strict=True)
    ]
    # The coefficient is that of ω = 1 and of ω → 0; between, it depends on ω.
    slack = 0.0 if omega == 1 else 20 * float(omega)
    numbers = np.array([row.theory_value for row in rows])

    def order(*found: float) -> float:
        return float(np.polyfit(np.log(epsilon), np.log(np.abs(numbers / found - 1)), 1)[0])

    def coefficient(*found: float) -> float:
        return float(np.polyfit(epsilon, (numbers / found - 1) / epsilon**law.order, 2)[-1])

    return [
        *rows,
        Row(f"{quantity}: order of its error", None, omega, sp.Integer(law.order),
            derived(order, *lattice), law.order_bound),
        Row(f"{quantity}: error/(k-1)^{law.order} at k → 1", None, omega, law.coefficient,
            derived(coefficient, *lattice), law.coefficient_bound + slack),
    ]  # fmt: skip


def _limit_rows(waves: list[LatticeWave]) -> list[Row]:
    """ω → 0 at the first k: the lattice extrapolated, linearly in ω."""
    k = EXPONENTS[0]
    symbols = homogenize(Dimer("m1", "m2", spacing=1), k=k).pde.traveling_wave()
    m1, m2 = symbols.cell.masses
    rows = []
    for quantity, theory in theory_values(symbols).items():
        coarse, middle, fine = (wave.quantities[quantity].value for wave in waves)
        law = LAWS[quantity]
        rows.append(
            Row(
                quantity,
                k,
                sp.Integer(0),
                sp.simplify(theory.subs({m1: 1, m2: 0})),
                Measured((4 * fine - middle) / 3, (4 * middle - coarse) / 3),
                law.constant * float(k - 1) ** law.order,
            )
        )
    return rows


def _exponent_row(k: sp.Rational, wave: TravelingWave, waves: list[LatticeWave]) -> Row:
    """The power of V_s to which F_m is proportional, fitted to runs of different amplitude."""

    def fit(*numbers: float) -> float:
        V, F = np.log(numbers[::2]), np.log(numbers[1::2])
        return float(np.polyfit(V, F, 1)[0])

    pairs = [number for wave in waves for number in (wave.speed, wave.force)]
    # The lattice scales exactly, so only the integration's error is allowed for.
    return Row("exponent of F_m in V_s", k, EQUAL, wave.force_exponent, derived(fit, *pairs), 1e-5)


# --- as text, document and picture ------------------------------------------------------------


def _chain(row: Row) -> str:
    if not row.omega:
        return "ω = m2/m1 → 0, extrapolated from runs at small ω"
    name = "m1 = m2" if row.omega == 1 else "m1 ≫ m2"
    return f"{name}, ω = {row.omega}"


@text.register
def _(result: Limits) -> str:
    header = ("quantity", "k", "theory", "lattice", "error", "bound", "")
    blocks = []
    for chain, rows in groupby(result.rows, _chain):
        lines = [
            (
                row.quantity,
                "→ 1" if row.k is None else str(row.k),
                f"{row.theory_value:.8g}",
                str(row.lattice),
                percent(row.error),
                percent(row.bound).lstrip("+"),
                "ok" if row.ok else "FAILS",
            )
            for row in rows
        ]
        blocks.append(f"{chain}\n{table(header, lines)}")
    failed = sum(not row.ok for row in result.rows)
    verdict = f"{failed} of {len(result.rows)} fail" if failed else "all hold"
    notes = (
        "Lengths in D, m1 = A = D = 1; force and strain of a contact; error: theory/lattice - 1.\n"
        "±: the lattice's own error, by how much a number still changed over the last stretch."
    )
    return "\n\n".join((*blocks, notes, f"{len(result.rows)} checks: {verdict}"))


@document.register
def _(result: Limits) -> dict[str, Any]:
    """``ok``, ``rows``: ``quantity``, ``k`` and ``omega`` (exact; ``k`` null where all enter,
    ``omega`` 0 for the limit), ``theory`` (exact), ``theory_value``, ``lattice_value``,
    ``lattice_error_value`` (absolute), ``error_value`` (theory over lattice - 1),
    ``bound_value``, ``ok``.
    """
    return {
        "ok": result.ok,
        "rows": [
            {
                "quantity": row.quantity,
                "k": None if row.k is None else str(row.k),
                "omega": str(row.omega),
                "theory": str(row.theory),
                "theory_value": row.theory_value,
                "lattice_value": row.lattice.value,
                "lattice_error_value": row.lattice.error,
                "error_value": row.error,
                "bound_value": row.bound,
                "ok": row.ok,
            }
            for row in result.rows
        ],
    }


@figure.register(Limits)
def _(result: Limits) -> Figure:
    """|error| against k - 1, with the leading powers that it must approach."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(10, 4.5), layout="constrained")
    epsilon = np.geomspace(float(EXPONENTS[-1] - 1) / 2, float(EXPONENTS[0] - 1), 2)
    for axes, omega in zip(picture.subplots(1, 2, sharey=True), (EQUAL, LIGHT), strict=True):
        for i, (quantity, law) in enumerate(LAWS.items()):
            rows = [
                row
                for row in result.rows
                if (row.quantity, row.omega) == (quantity, omega) and row.k is not None
            ]
            color = f"C{i}"
            axes.plot(epsilon, abs(float(law.coefficient)) * epsilon**law.order, color=color)
            axes.errorbar(
                [float(row.k - 1) for row in rows if row.k is not None],
                [abs(row.error) for row in rows],
                [row.lattice.relative_error for row in rows],
                fmt="osD^"[i],
                color=color,
                label=quantity,
            )
        axes.set(xscale="log", yscale="log", xlabel="k - 1", title=f"m2/m1 = {omega}")
        axes.set_xticks([float(k - 1) for k in EXPONENTS], [str(k - 1) for k in EXPONENTS])
        axes.set_xticks([], minor=True)
    picture.axes[0].set_ylabel("|theory/lattice - 1|")
    picture.axes[0].legend(title="lines: leading order in k - 1")
    return picture


@click.command("limits")
@output
def limits_command(style: str, picture: Path | None) -> int:
    """Equal masses, m1 ≫ m2 and k → 1: widths, speed and amplitude, held to bounds."""
    result = limits(progress)
    show(result, style, picture)
    return 0 if result.ok else 1
