"""Head-on collision of two pulses: the long-wave equation beside the lattice.

Equal beads, A = D = m = 1. Two solitary waves of strains 1 and B run towards each other: on the
lattice the lattice's own waves (`validation.waves.solver`), and in the equation

    (1 - I ∂_x²) u_ττ = ∂_x F(u_x)

its own waves (integrated by `Continuum`). The waves meet at x = 0. The pulse of strain
1 starts at x = -d. The strain is recorded at x = 0 and at x = d, where this pulse arrives after the
collision. The shift of a pulse is its distance ahead of a pulse that ran alone.

The equation is a long-wave equation: its speed is right to first order in k - 1, and its widths are
its weak side. At k = 3/2 its pulses are too narrow by 19 %.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy
import sympy as sp
from numpy.typing import ArrayLike

from lwa import Cell, Power
from lwa.base.arrays import Array
from lwa.base.exact import read_exact
from lwa.base.frozen import Estimate
from lwa.base.progress import Progress
from lwa.command.options import quantities
from lwa.loaded.background import Background
from validation.lattice.simulate import simulate
from validation.pictures import Curve, Panel
from validation.pulses.pulse import measure
from validation.report.study import Report, option, study
from validation.report.table import Column, Estimates, Finding, Table, percent
from validation.scenes.checks import SceneError, between
from validation.scenes.scene import Scene
from validation.waves.solver import exact_wave

TOLERANCE = 1e-10  # rtol of the integrated equation by default
APART = 5.0  # widths of the first pulse between its start and x = 0, at least
_WIDE = 1.5  # half the interval over the distance of the farther pulse from x = 0, plus a run
_DENSE = 8  # points of the equation per site
_RUNS = (
    (1e-10, 1201),
    (1e-8, 601),
)  # rtol and samples: the runs that count, and for their errors
_ROUNDING = 1e-12  # relative error of the waves before the collision
_CONSERVED = 1e-6  # relative change of the energy, at most
_NAMES = {
    "speed": "speed",
    "fwhm": "FWHM of strain (sites)",
    "meeting": "strain at x = 0, at most",
    "after": "strain after the collision",
    "shift": "shift by the collision (sites)",
}
Records = tuple[
    Array, Array, dict[str, float]
]  # times, strains at x = 0 and x = d, numbers


@study(
    option(
        "--k",
        "Exponents of F = δ^k.",
        to="exponents",
        read=quantities,
        default="11/10,3/2",
    ),
    option(
        "--second", "Peak strain of the second pulse; the first has 1.", default=0.5
    ),
)
def collision(
    exponents: Sequence[Any] = (sp.Rational(11, 10), sp.Rational(3, 2)),
    second: float = 0.5,
    progress: Progress[Any] = iter,
) -> Report:
    """Head-on collision of two pulses, long-wave equation and lattice (ten seconds).

    ``rows``: ``k``, ``quantity``, ``equation_value`` and ``lattice_value`` with their errors,
    ``error_value`` (equation/lattice - 1).

    Raises `SceneError` for parameters out of range.
    """
    if not exponents:
        raise SceneError("k is empty: at least one exponent is wanted")
    ks = [read_exact(k, "k") for k in exponents]
    for k in ks:
        between(k, "k", 1.05, 3)
    between(second, "second", 0.1, 1)
    records = {}
    for k in progress(ks):
        records[k] = tuple(
            [run(k, second, rtol, samples) for rtol, samples in _RUNS]
            for run in (in_equation, on_lattice)
        )
    return _report(second, records)


@dataclass(frozen=True, eq=False)
class Continuum:
    """The long-wave equation (1 - I ∂_x²) u_ττ = ∂_x F(u_x) of a chain on a periodic interval.

    Let φ be the canonical field, F and I those of `lwa.loaded.background`. In the field
    u = φ + (I/2) φ_xx the terms of order D^{k+3} are I ∂_x³ F(u_x), for every cell of a power law
    or of equal contacts, and equal I ∂_x² u_ττ to this order (Rosenau, Phys. Lett. A 118, 222
    (1986), for equal beads). The canonical equation cut at D^{k+3} amplifies short waves without
    bound; this one is well posed. Its wave of the strain B has the canonical wave's speed.

    In the strain p = u_x and the velocity v = u_τ the equation is p_τ = v_x,
    (1 - I ∂_x²) v_τ = ∂_x F(p), of the energy ∫ [½ v² + ½ I v_x² + W(p)] dx. Contacts of a power
    law only push: F(p) = 0 at p < 0. The cell and the law have numbers only.
    """

    equation: Background
    length: float  # the period
    points: int  # equidistant

    @cached_property
    def x(self) -> Array:
        """Grid points, from -length/2 on."""
        return np.asarray(self.length * (np.arange(self.points) / self.points - 0.5))

    @cached_property
    def _wavenumbers(self) -> Array:
        return np.asarray(2 * np.pi / self.length * np.arange(self.points // 2 + 1))

    def _of_strain(self, p: Array, n: int) -> Array:
        """The force F(p) for n = 0, its potential W(p) for n = -1."""
        return np.asarray(self._laws[n](np.maximum(p, 0)))

    @cached_property
    def _laws(self) -> dict[int, Any]:
        p = sp.Symbol("p", positive=True)
        return {n: sp.lambdify(p, self.equation.force(p, n), "numpy") for n in (0, -1)}

    def evolved(
        self, p: ArrayLike, v: ArrayLike, times: ArrayLike, rtol: float = TOLERANCE
    ) -> tuple[Array, Array]:
        """Return strain and velocity at the times τ, each (times, points), from p, v at τ = 0.

        The times rise from 0 on. Raises `SceneError` if the integration fails.
        """
        # The operator 1 - I ∂_x² is diagonal in Fourier coefficients. Frequencies are bounded by
        # c0/√I, so that an explicit method needs no small steps.
        n, inertia = self.points, 1 + float(self.equation.I) * self._wavenumbers**2
        slope = 1j * self._wavenumbers
        if n % 2 == 0:
            slope[-1] = 0  # the shortest wave, ±1 in turn, has no slope at the points

        def rate(tau: float, state: Array) -> Array:
            strain, velocity = state.reshape(2, n)
            acceleration = scipy.fft.rfft(self._of_strain(strain, 0)) * slope / inertia
            stretching = scipy.fft.rfft(velocity) * slope
            return np.ravel(scipy.fft.irfft((stretching, acceleration), n))

        at, start = np.asarray(times, float), np.concatenate((p, v), dtype=float)
        tolerances = {"rtol": rtol, "atol": rtol * np.abs(start).max()}
        path = scipy.integrate.solve_ivp(
            rate, (0.0, at[-1]), start, "DOP853", at, **tolerances
        )
        if not path.success:
            raise SceneError(
                f"the integration ends at τ = {path.t[-1]:.6g}: {path.message}"
            )
        strain, velocity = path.y.T.reshape(len(at), 2, n).swapaxes(0, 1)
        return strain, velocity

    def energy(self, p: Array, v: Array) -> Array:
        """Return the energy, (…), of strains and velocities, (…, points)."""
        slope = scipy.fft.irfft(1j * self._wavenumbers * scipy.fft.rfft(v), self.points)
        density = (v**2 + float(self.equation.I) * slope**2) / 2 + self._of_strain(
            p, -1
        )
        return np.asarray(density.sum(axis=-1) * self.length / self.points)


def on_lattice(k: sp.Expr, second: float, rtol: float, samples: int) -> Records:
    """The collision on the lattice."""
    first = exact_wave([1], float(k))
    other = first.times(second)
    width = first.fwhm("strain")
    d, away, half = _places(width, first.c, other.c)
    x = np.arange(2 * half) - half + 0.5
    contact = x[:-1] + 0.5
    strain = first.strain(contact + d) + other.strain(away - contact)
    scene = Scene(
        masses=(1.0,) * len(x),
        stiffnesses=(1.0,) * len(contact),
        # Beads behind a contact have moved by the compressions of all contacts ahead.
        displacements=np.cumsum(strain[::-1])[::-1],
        velocities=first.velocity(x + d) - other.velocity(away - x),
        k=float(k),
        contact_sensors=(half - 1, half - 1 + d),
        duration=2.5 * d / first.c,
        samples=samples,
    )
    run = simulate(scene, rtol=rtol)
    numbers = _numbers(run.time, run.compression, first.c, d)
    numbers |= {"speed": first.c, "fwhm": width, "drift": run.energy_drift}
    return run.time, run.compression, numbers


def in_equation(k: sp.Expr, second: float, rtol: float, samples: int) -> Records:
    """The collision in the equation."""
    equation = Background(Cell((1,), spacing=1), Power(k), 0)
    V = float(equation.speed(sp.S.One))
    other = float(equation.speed(sp.Rational(str(second))))
    pace = float(equation.time_scale)
    power, rate = float(k - 1) / 2, float(k - 1) / (2 * math.sqrt(equation.I))
    width = 2 * math.acosh(2**power) / rate
    d, away, half = _places(width, V, other)
    interval = Continuum(equation, 2 * half, 2 * half * _DENSE)

    def pulse(x: Array) -> Array:
        return np.cosh(rate * x) ** (-1 / power)

    one, two = pulse(interval.x + d), second * pulse(interval.x - away)
    time = np.linspace(0, 2.5 * d / (V * pace), samples)
    strain, velocity = interval.evolved(
        one + two, other * two - V * one, pace * time, rtol
    )
    energy = interval.energy(strain, velocity)
    strains = strain[:, [half * _DENSE, (half + d) * _DENSE]].T
    numbers = _numbers(time, strains, V * pace, d)
    numbers |= {
        "speed": V * pace,
        "fwhm": width,
        "drift": float(np.ptp(energy) / energy[0]),
    }
    return time, strains, numbers


def _places(width: float, speed: float, other: float) -> tuple[int, float, int]:
    """Distances of the pulses' starts from x = 0, and half the chain's length, in sites."""
    d = math.ceil(APART * width)
    away = d * other / speed
    return d, away, math.ceil(_WIDE * (d + away))


def _numbers(time: Array, strains: Array, speed: float, d: int) -> dict[str, float]:
    """Peak strain at the collision; peak strain and shift (sites) of the first pulse after it."""
    late = time > 1.5 * d / speed
    after = measure(time[late], strains[1][late])
    middle = measure(time, strains[0])
    return {
        "meeting": middle.peak,
        "after": after.peak,
        "shift": 2 * d - speed * after.arrival,
    }


_COLUMNS = (
    Column("k", "k", format=str),
    Column("quantity", "quantity"),
    Estimates("equation", "equation"),
    Estimates("lattice", "lattice"),
    Column("error_value", "equation off by", format=percent),
)


def _report(
    second: float, records: Mapping[sp.Expr, Sequence[Sequence[Records]]]
) -> Report:
    rows, panels = [], []
    for k, (equation, lattice) in records.items():
        for key, name in _NAMES.items():
            one, other = (
                Estimate.against(fine[2][key], rough[2][key] * (1 + _ROUNDING))
                for fine, rough in (equation, lattice)
            )
            rows.append(
                {
                    "k": k,
                    "quantity": name,
                    "equation": one,
                    "lattice": other,
                    "error_value": one.value / other.value - 1,
                }
            )
        curves = [
            Curve(f"{label}, x = {place}", time, strain, style)
            for (time, strains, _), label, line in (
                (lattice[0], "lattice", "-"),
                (equation[0], "equation", "--"),
            )
            for strain, place, style in zip(
                strains, "0d", (f"C0{line}", f"C1{line}"), strict=True
            )
        ]
        panels.append(Panel("time", "strain", tuple(curves), title=f"k = {k}"))
    return Report(
        f"Two pulses of strains 1 and {second:g} meet at x = 0; m = A = D = 1",
        (Table(_COLUMNS, rows, "rows"),),
        tuple(_findings(records)),
        tuple(panels),
        (
            "Shift: distance of the pulse of strain 1 ahead of a pulse that ran alone. ±: change "
            "in a less accurate run; speed and FWHM are those before the collision. The equation "
            "is for long waves: its widths are too small.",
        ),
    )


def _findings(
    records: Mapping[sp.Expr, Sequence[Sequence[Records]]],
) -> Iterator[Finding]:
    for k, sides in records.items():
        for name, runs in zip(("equation", "lattice"), sides, strict=True):
            drift = abs(runs[0][2]["drift"])
            yield Finding(
                f"k = {k}, {name}: change of the energy", drift, high=_CONSERVED
            )


if __name__ == "__main__":
    collision.main()
