"""Shocks of chains that a wall drives, on the lattice beside `lwa.shock`.

A = D = 1. A chain of strain p₊, its far end under a constant force, is thrown against a fixed wall:
seen from the chain, the wall moves into it at the velocity v_p for which the plateau has the strain
p₋. The leading pulse runs away from the wall, at s₊ sites per unit of time between two contacts;
behind the trailing edge the strain of a contact near the wall settles to p₋, where that edge leaves
the wall (r = c₋/c₊ < 2). The leading pulse still grows slowly at the last contact.

Theory: El's leading edge on the chain's own dispersion, and the doubling rule for equal beads, on
Toda's soliton, on the canonical wave or, for powers without load, on the series in k - 1. The
findings are for Toda's law and for Hertz contacts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from lwa import Power, Shock
from lwa import shock as front
from lwa.base.arrays import Array
from lwa.base.exact import exact
from lwa.base.progress import Progress
from lwa.command.reading import quantities, quantity
from lwa.law import ContactLaw, named
from validation.lattice.run import Run
from validation.lattice.simulate import simulate
from validation.pictures.panel import Curve, Panel
from validation.report.command import option, study
from validation.report.result import Report
from validation.report.table import Column, Finding, Table
from validation.scenes.chains import numbered
from validation.scenes.checks import integer
from validation.scenes.scene import Scene

JUMPS = "3/2", 2, 3  # strains behind the front over those ahead of it
FIRST, LAST = 0.6, 0.85  # of the chain: distances from the wall between which s₊ is measured
PLACES = 0.1, 0.25, 0.4, 0.5, 0.7  # of the chain: further distances of the picture
NEAR = 5  # contacts from the wall to that of the plateau
END = 0.9  # of the chain: run by the leading pulse
SAMPLES = 20  # per unit of time
BOUNDS = {"Toda": 0.003, "k = 3/2": 0.006}  # by which s₊ may differ from the doubling rule


@study(
    option("--k", callback=quantity, says="Exponent of F = δ^k; by default Toda, 3/2 and 3."),
    option("--masses", callback=quantities, default="1", says="Masses of a cell, such as 1,1/2."),
    option(
        "--jumps",
        callback=quantities,
        default=",".join(map(str, JUMPS)),
        says="Strains behind the front over those ahead of it.",
    ),
    option("--ahead", callback=quantity, default="1", says="Strain ahead; 0: jumps are strains."),
    option("--beads", default=1000, says="Beads of a chain."),
)
def shock(
    k: Any = None,
    masses: Sequence[Any] = (1,),
    jumps: Sequence[Any] = JUMPS,
    ahead: Any = 1,
    beads: int = 1000,
    progress: Progress[Any] = iter,
) -> Report:
    """Shocks of driven chains: plateau, leading speed and peak. Half a minute.

    ``rows``: ``law``, ``behind_value``, ``ahead_value`` (strains), ``ratio_value`` (c₋/c₊),
    ``plateau_value`` (measured strain; none for r ≥ 2), ``plateau_error_value`` (over p₋, less 1),
    ``speed_value`` (measured s₊), ``doubling_value`` and ``dispersion_value`` (s₊ by theory) with
    ``doubling_error_value`` and ``dispersion_error_value`` (theory over lattice, less 1),
    ``peak_value`` (strain of the leading pulse), ``peak_theory_value`` and ``peak_error_value``.

    Raises `SceneError` and `lwa.InputError` for parameters out of range.
    """
    beads, start = integer(beads, "beads", 100), exact(ahead, "ahead")
    laws = [named("exponential", 1), Power("3/2"), Power(3)] if k is None else [Power(k)]
    steps = [exact(jump, "jump") for jump in jumps]
    behind = [step * start if start else step for step in steps]
    cell = numbered(masses)
    fronts = [Driven(front(cell, law, p, start), beads) for law in laws for p in behind]
    return _report([(driven, driven.row()) for driven in progress(fronts)])


@dataclass(frozen=True)
class Driven:
    """A chain thrown against a wall, measured."""

    theory: Shock
    beads: int

    @cached_property
    def run(self) -> Run:
        """The motion; contacts at `FIRST` and `LAST` and near the wall are recorded."""
        chain, n = self.theory, self.beads - self.beads % self.theory.cell.size
        masses = [float(m) for m in chain.cell.masses] * (n // chain.cell.size)
        edge, rule, _ = _theory(chain)
        duration = END * n / (rule or edge or float(chain.sound(chain.behind)))
        load = float(chain.law.at(chain.ahead)) if chain.ahead else 0.0
        law: dict[str, Any] = {"law": chain.law}
        last, first, *others = (round(place * n) for place in (LAST, FIRST, *PLACES))
        distances = last, first, NEAR, *others
        scene = Scene(
            masses=tuple(masses), stiffnesses=(1.0,) * (n - 1), wall=1.0, precompression=load,
            velocities=(float(chain.plateau),) * n, duration=duration,
            contact_sensors=tuple(n - 1 - d for d in distances),
            samples=math.ceil(SAMPLES * duration), **law,
        )  # fmt: skip
        return simulate(scene)

    def row(self) -> tuple[Any, ...]:
        """Cells of the table."""
        chain, run = self.theory, self.run
        first, last = (self._leading(i) for i in (1, 0))
        far, near = (run.scene.contact_sensors[i] for i in (0, 1))
        speed = (near - far) / (last[0] - first[0])
        ratio = float(chain.ratio) if chain.ahead else math.inf
        plateau = float(run.compression[2][-len(run.time) // 10 :].mean()) if ratio < 2 else None
        el, rule, peak = _theory(chain)
        return (
            _name(chain.law), float(chain.behind), float(chain.ahead), ratio,
            plateau, _off(plateau, float(chain.behind)),
            speed, rule, _off(rule, speed), el, _off(el, speed),
            last[1], peak, _off(peak, last[1]),
        )  # fmt: skip

    def _leading(self, i: int) -> tuple[float, float]:
        """Time and strain of the first peak of a record that rises above half its largest rise."""
        values, time = self.run.compression[i], self.run.time
        signal = self.run.signal("contact", self.run.scene.contact_sensors[i], "compression")
        rise = values - values[0]
        start = int(np.argmax(rise > rise.max() / 2))
        top = start + int(np.argmax(np.diff(values[start:]) < 0))
        found = scipy.optimize.minimize_scalar(
            lambda t: -float(signal(t)), bounds=(time[top - 1], time[top + 1]), method="bounded",
            options={"xatol": 1e-8},
        )  # fmt: skip
        return float(found.x), -float(found.fun)

    def path(self) -> tuple[Array, Array]:
        """Times at which the leading pulse passes contacts, and their distances from the wall."""
        at = [i for i in range(len(self.run.scene.contact_sensors)) if i != 2]
        sites = [len(self.run.displacements) - 1 - self.run.scene.contact_sensors[i] for i in at]
        order = np.argsort(sites)
        times = np.array([self._leading(i)[0] for i in at])
        return times[order], np.array(sites, float)[order]

    def profile(self) -> tuple[Array, Array]:
        """Distance from the wall in sites, and the strain at the end of the run."""
        u = np.append(self.run.displacements, 0.0)
        strain = float(self.theory.ahead) - np.diff(u)
        return np.arange(len(strain), 0, -1.0) - 0.5, strain


def _theory(chain: Shock) -> tuple[float | None, float | None, float | None]:
    """s₊ by dispersion (none without load), by doubling, and the peak (none for unequal beads)."""
    edge = float(chain.leading_speed("dispersion")) if chain.sound(chain.ahead) else None
    if chain.cell.size > 1:
        return edge, None, None
    if chain.law.homogeneous and not chain.ahead:
        wave = chain.wave
        return edge, wave.speed.value, float(wave.F) ** float(1 / chain.law.exponent)
    return edge, float(chain.leading_speed("doubling")), float(chain.peak)


def _off(value: float | None, true: float) -> float | None:
    return None if value is None else value / true - 1


def _name(law: ContactLaw) -> str:
    return f"k = {law.exponent}" if law.homogeneous else "Toda"


_PERCENT = "+.2%"
_COLUMNS = (
    Column("law", "law"),
    Column("behind_value", "p₋", format=".4g"),
    Column("ahead_value", "p₊", format=".4g"),
    Column("ratio_value", "c₋/c₊", format=".4g"),
    Column("plateau_value", "plateau", format=".5g"),
    Column("plateau_error_value", "over p₋ - 1", format=_PERCENT),
    Column("speed_value", "s₊", format=".5g"),
    Column("doubling_value", "doubling", format=".5g"),
    Column("doubling_error_value", "over s₊ - 1", format=_PERCENT),
    Column("dispersion_value", "dispersion", format=".5g"),
    Column("dispersion_error_value", "over s₊ - 1", format=_PERCENT),
    Column("peak_value", "peak", format=".5g"),
    Column("peak_theory_value", "doubling", format=".5g"),
    Column("peak_error_value", "over peak - 1", format=_PERCENT),
)


def _report(found: Sequence[tuple[Driven, tuple[Any, ...]]]) -> Report:
    findings = []
    for _, row in found:
        name = f"{row[0]}, p₋ = {row[1]:g}"
        if row[5] is not None:
            findings.append(Finding(f"plateau, {name}: over p₋, less 1", row[5], -0.005, 0.005))
        if row[8] is not None and (bound := BOUNDS.get(row[0])):
            findings.append(Finding(f"doubling, {name}: over s₊, less 1", row[8], -bound, bound))
    driven, row = found[-1]
    x, strain = driven.profile()
    duration = driven.run.scene.duration
    lines = [
        (label, s, style)
        for label, s, style in (("s₊, doubling", row[7], "C1--"), ("s₊, dispersion", row[9], "C2:"))
        if s is not None
    ]
    ends = [strain.min(), strain.max()]
    edges = [Curve.of(label, [s * duration] * 2, ends, style) for label, s, style in lines]
    paths = [Curve.of(label, [0, duration], [0, s * duration], style) for label, s, style in lines]
    return Report(
        "Chains driven by a wall: lattice and theory",
        (Table(_COLUMNS, tuple(row for _, row in found), "rows"),),
        tuple(findings),
        (Panel("sites from the wall", f"strain, {row[0]}",
               (Curve.of("lattice", x, strain, "C0-"), *edges)),
         Panel("time", "sites from the wall",
               (Curve.of("leading pulse", *driven.path(), "C0o"), *paths))),
        ("Speeds in sites per unit of time; peak: the pulse's strain at the last contact.",),
    )  # fmt: skip


if __name__ == "__main__":
    shock.main()
