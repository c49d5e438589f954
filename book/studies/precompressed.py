"""Waves in a chain under load, weak to strong, compared with the theory.

A = D = 1, and all contacts carry the static force F0 = F(1), held by a wall at the far end. F is
δ^k or any contact law; speeds are in units of c0, the speed of sound, c0² = F′(1)/(mean mass). Each
chain starts with a wave, as a weak wave would need very many sites to form from a blow: equal beads
with the lattice's own wave (`validation.waves.solver`), others with the theory's, which sheds its
difference from the lattice's wave. Contacts of a cell record the wave at three places; numbers are
means over the contacts of a cell, and the theory is evaluated at the dynamic force measured there.
Errors are the larger of two changes: of theory/lattice between the two stretches, and of the
lattice's number in a less accurate run.

The theory's V/c0 and width over √(12 I) do not depend on the masses: all chains lie on one curve
(`lwa.loaded_wave`). A wave is faster than all long waves; but where ω = V q meets an optical
branch, short waves carry energy away, and the wave decays, the slower the longer it is.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import cycle, groupby
from typing import Any

import numpy as np
import sympy as sp

from lwa import Cell, LoadedWave, Power, loaded_wave
from lwa.base.arrays import Array
from lwa.base.frozen import Estimate
from lwa.base.progress import Progress
from lwa.command import options
from lwa.law import ContactLaw, read_law
from lwa.loaded.background import Background
from validation.lattice.result import Run
from validation.lattice.simulate import repeated
from validation.pictures import Curve, Panel
from validation.pulses.pulse import (
    MeasureError,
    Piecewise,
    first_pulse,
    highest_pulse,
)
from validation.pulses.sensors import tracks
from validation.report.study import EXPONENT, Report, option, study
from validation.report.table import Column, Estimates, Finding, Table, percent
from validation.scenes.checks import SceneError, between, numeric
from validation.scenes.scene import Scene
from validation.waves.profile import ExactWave
from validation.waves.solver import exact_wave

CHAINS = ((1,), (1, "1/2"), (1, "1/4"))  # masses of the cells
RATIOS = 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100  # dynamic over static force
_SITES = 400  # run by a wave; places are half way, at three quarters and at the end
_ENDED = 10.0  # widths from the middle of the initial wave to the end of the chain
_SAMPLES = 40.0  # per site run by sound, and per width of the wave
_LAUNCHED = (
    1e-6  # relative difference of the lattice's speed from the exact wave's, at most
)
_WEAKEST, _STRONGEST = 1e-3, 1e4


@study(
    EXPONENT,
    options.value(
        "--law",
        "Contact law in place of δ^k, such as hertz2:1,2.",
        "hertz2:1,2",
        read_law,
        metavar="NAME[:PARAM,…]",
    ),
    option(
        "--masses",
        "Masses of a cell, such as 1,1/2; by default three chains.",
        read=options.quantities,
    ),
    option(
        "--ratios",
        "Dynamic forces divided by the static force.",
        read=options.quantities,
        default=",".join(map(str, RATIOS)),
    ),
)
def precompressed(
    k: float = 1.5,
    masses: Sequence[Any] = (),
    ratios: Sequence[Any] = RATIOS,
    law: ContactLaw | None = None,
    progress: Progress[Any] = iter,
) -> Report:
    """Waves in chains under load: speed, width and bead velocity (five seconds).

    law: contact law of `lwa.law`, in place of k; Newton's waves are those of powers only.

    ``rows``: ``masses``, ``ratio_value`` (measured dynamic over static force), ``speed_value``
    (V/c0, c0 the speed of sound) with its error, ``theory_value``, ``error_value`` (theory/lattice
    - 1), ``exact_value`` (for equal beads, by Newton's method), ``fwhm_value`` of the dynamic
    contact force in sites with its error, ``fwhm_theory_value``, ``fwhm_off_value``,
    ``peak_value`` (bead velocity, the mean over a cell by mass) with its error,
    ``peak_theory_value``, ``peak_off_value`` and ``decay_value`` (of the dynamic force, per site).

    Raises `SceneError` for parameters out of range and `MeasureError` if a pulse does not arrive
    whole, as strong waves in cells of three and four.
    """
    cells = [Cell(row, spacing=1) for row in ([masses] if masses else CHAINS)]
    for cell in cells:
        for mass in cell.masses:
            numeric(mass, "mass")
    between(k, "k", 1.01, 8)
    wanted = [between(ratio, "ratio", _WEAKEST, _STRONGEST) for ratio in ratios]
    if not wanted:
        raise SceneError("ratios is empty: at least one is wanted")
    law = Power(k) if law is None else law
    waves = [Wave(cell, law, ratio) for cell in cells for ratio in sorted(wanted)]
    return _report(law, [(wave, wave.row()) for wave in progress(waves)])


@dataclass(frozen=True)
class Wave:
    """A wave of dynamic force ``ratio`` F0 in a chain under the load F0; speeds over c0, in sites.

    tolerances: of the run that is read and of the less accurate run.
    """

    cell: Cell
    law: ContactLaw
    ratio: float
    tolerances: tuple[float, float] = (1e-7, 1e-5)

    @cached_property
    def load(self) -> float:
        """Static force F0 = F(1)."""
        return float(self.law.at(sp.S.One))

    @cached_property
    def stiffness(self) -> float:
        """Stiffness F′(1) of a contact under the load."""
        return float(self.law.at(sp.S.One, 1))

    @cached_property
    def masses(self) -> Array:
        """Masses as floats."""
        return np.array(self.cell.masses, float)

    @cached_property
    def sound(self) -> float:
        """Speed of sound c0, in sites per unit of time."""
        return math.sqrt(self.stiffness / self.masses.mean())

    def unit(self, name: str) -> float:
        """Unit in which all chains fall on one curve: √(12 I) for a width."""
        return (
            math.sqrt(12 * Background(self.cell, self.law, 1).I)
            if name == "fwhm"
            else 1.0
        )

    @cached_property
    def exact(self) -> ExactWave | None:
        """The lattice's own wave, for equal beads and a power."""
        if len(self.masses) > 1 or not self.law.homogeneous:
            return None
        k = float(self.law.exponent)
        wave = exact_wave(
            self.masses.tolist(), k, background=math.pow(1 + self.ratio, -1 / k)
        )
        return wave.times(math.pow(1 + self.ratio, 1 / k))

    def wave(self, force: float) -> LoadedWave:
        """The theory's wave on the strain 1, of a dynamic force over F0."""
        return loaded_wave(
            self.cell, rise=self.strain(force), background=1, law=self.law
        )

    def theory(self, force: float) -> dict[str, float]:
        """Speed, FWHM of the contact force and bead velocity at a dynamic force over F0."""
        wave = self.wave(force)
        speed, width = float(wave.speed / wave.sound_speed), float(wave.fwhm("force"))
        return {
            "speed": speed,
            "fwhm": width,
            "peak": self.strain(force) * speed * self.sound,
        }

    def strain(self, force: float) -> float:
        """Strain added by a dynamic force over F0."""
        if self.law.homogeneous:
            return math.expm1(math.log1p(force) / float(self.law.exponent))
        return (
            float(self.law.compression(self.cell, sp.Float(self.load * (1 + force))))
            - 1
        )

    @cached_property
    def places(self) -> tuple[int, ...]:
        """Bead at the middle of the initial wave, and first contact of each place."""
        size, ended = (
            len(self.masses),
            max(20.0, _ENDED * self.theory(self.ratio)["fwhm"]),
        )
        start = math.ceil(ended / size) * size
        return tuple(
            start + round(_SITES * part / size) * size for part in (0, 0.5, 0.75, 1)
        )

    @cached_property
    def scene(self) -> Scene:
        """The chain with its wave, too long for an echo from the wall."""
        start, *places = self.places
        size, predicted = len(self.masses), self.theory(self.ratio)
        sites = _SITES + start / 2  # run by sound
        beads = (
            math.ceil(
                (places[-1] + start + predicted["speed"] * (sites + start)) / 2 / size
            )
            * size
        )
        bead = np.arange(beads, dtype=float) - start
        if self.exact is None:
            strain, motion = (
                self.wave(self.ratio).along(x, "strain")
                for x in (bead[:-1] + 0.5, bead)
            )
            velocity = motion * predicted["speed"] * self.sound
        else:
            strain, velocity = (
                self.exact.strain(bead[:-1] + 0.5),
                self.exact.velocity(bead),
            )
        sensors = tuple(place + i for place in places for i in range(size))
        # Beads behind a contact have moved by the compressions of all contacts ahead.
        displacements = np.cumsum(strain[::-1])[::-1]
        return Scene(
            masses=np.resize(self.masses, beads),
            stiffnesses=(1.0,) * (beads - 1),
            displacements=displacements,
            velocities=velocity,
            law=self.law,
            wall=1.0,
            precompression=self.load,
            contact_sensors=sensors,
            bead_sensors=sensors,
            duration=sites / self.sound,
            samples=math.ceil(
                _SAMPLES * sites * max(1.0, predicted["speed"] / predicted["fwhm"])
            ),
        )

    def read(self, run: Run, stretch: int) -> dict[str, float]:
        """Measure force, decay, speed, FWHM and velocity on stretch 0 or 1, means over a cell."""
        rows = []
        records = tracks(run)
        beads, contacts = records[: len(records) // 2], records[len(records) // 2 :]
        for bead, contact in zip(beads, contacts, strict=True):
            # up to where the strain falls to a quarter
            pulse = first_pulse(contact.force, 0.25 ** (self.stiffness / self.load))
            velocity = run.signal("bead", bead.number - 1, "velocity")
            end = velocity.times.searchsorted(pulse.fall + pulse.fwhm, side="right")
            fastest = highest_pulse(Piecewise(velocity.times[:end], velocity)).peak
            rows.append((pulse.arrival, pulse.peak / self.load, pulse.fwhm, fastest))
        table = np.array(rows).reshape(3, len(self.masses), 4)[stretch : stretch + 2]
        arrival, force, width, velocity = np.moveaxis(table, 2, 0)
        sites = self.places[stretch + 2] - self.places[stretch + 1]
        speed = float(np.mean(sites / np.diff(arrival, axis=0)))
        return {
            "force": float(force.mean()),
            "decay": -float(np.diff(np.log(force), axis=0).mean()) / sites,
            "speed": speed / self.sound,
            "fwhm": float(width.mean()) * speed,
            "peak": float(np.average(velocity.mean(axis=0), weights=self.masses)),
        }

    def row(self) -> dict[str, Any]:
        """Table row: measured numbers, and the theory's at the measured force."""
        fine, rough = repeated(self.scene, self.tolerances)
        try:
            measured, coarse, before = (
                self.read(fine, 1),
                self.read(rough, 1),
                self.read(fine, 0),
            )
        except MeasureError as error:
            masses = ", ".join(map(str, self.cell.masses))
            raise MeasureError(
                f"masses {masses}, ratio {self.ratio:g}: {error}"
            ) from None
        theory, earlier = (self.theory(read["force"]) for read in (measured, before))
        exact = None if self.exact is None else self.exact.c / self.sound
        cells: dict[str, Any] = {
            "masses": [str(m) for m in self.cell.masses],
            "exact": exact,
        }
        cells |= {name: measured[name] for name in ("force", "decay")}
        for name, value in theory.items():
            settled = abs(measured[name] / value - before[name] / earlier[name]) * value
            change = max(abs(measured[name] - coarse[name]), settled)
            cells |= {
                name: Estimate(measured[name], change),
                f"{name} theory": value,
                f"{name} off": value / measured[name] - 1,
            }
        return cells


_COLUMNS = {
    "masses": Column("masses", "masses", format=", ".join),
    "force": Column("ratio_value", "F/F0", format=".4g"),
    "speed": Estimates("speed", "V/c0"),
    "speed theory": Column("theory_value", "theory", format=".5f"),
    "speed off": Column("error_value", "off", format=percent),
    "exact": Column("exact_value"),
    "fwhm": Estimates("fwhm", "FWHM (sites)"),
    "fwhm theory": Column("fwhm_theory_value", "theory", format=".3f"),
    "fwhm off": Column("fwhm_off_value", "off", format=percent),
    "peak": Estimates("peak", "bead velocity"),
    "peak theory": Column("peak_theory_value"),
    "peak off": Column("peak_off_value", "off", format=percent),
    "decay": Column("decay_value", "decay per site", format=".0e"),
}


def _report(law: ContactLaw, waves: Sequence[tuple[Wave, dict[str, Any]]]) -> Report:
    rows = [cells for _, cells in waves]
    table = [{c.name: row.get(name) for name, c in _COLUMNS.items()} for row in rows]
    return Report(
        f"Waves on a static force F0 = {waves[0][0].load:g}: F = {law.F}, A = D = 1",
        (Table([*_COLUMNS.values()], table, "rows"),),
        tuple(_findings(law, rows)),
        tuple(_panels(waves)),
        (
            "F: dynamic contact force, V: speed, c0: speed of sound. off: theory/lattice - 1. "
            "FWHM: of the contact force; bead velocity: peak, mean over a cell by mass.",
            "For unlike masses the theory is worse: its waves are long beside a cell, and strong "
            "waves decay as they feed short waves of an optical branch.",
        ),
    )


def _findings(law: ContactLaw, rows: Sequence[dict[str, Any]]) -> Iterator[Finding]:
    """Findings: errors of the theory for equal beads, and for weak waves in all chains."""
    equal = [row for row in rows if len(row["masses"]) == 1]
    if equal and law.homogeneous:
        off = max(abs(row["speed"].value / row["exact"] - 1) for row in equal)
        yield Finding(
            "equal beads, V: lattice over exact wave - 1, at most",
            off,
            high=_LAUNCHED,
            key="lattice_over_exact",
        )
    for name, those, ratio, bound in (
        ("equal beads", equal, math.inf, 0.025),
        ("equal beads up to F/F0 = 1", equal, 1.0, 1e-3),
        ("all chains up to F/F0 = 0.1", rows, 0.1, 1e-3),
    ):
        offs = [
            (abs(row["speed off"]), row["speed"].relative_error)
            for row in those
            if row["force"] <= ratio * (1 + 1e-6)
        ]
        if offs and (law == Power("3/2") or ratio < 1):
            worst, error = max(offs)
            yield Finding(
                f"{name}, V: |theory/lattice - 1|, at most",
                worst,
                high=bound,
                error=error,
            )


def _panels(waves: Sequence[tuple[Wave, dict[str, Any]]]) -> Iterator[Panel]:
    """Panels of V/c0 and FWHM/√(12 I), in which the theory is one curve for all chains."""
    ratios = [wave.ratio for wave, _ in waves]
    # The curves are nearly straight on their logarithmic scales: few points, as each one is exact.
    first, forces = waves[0][0], np.geomspace(min(ratios), max(ratios), 25)
    theory = [first.theory(force) for force in forces]
    for name, label, scale in (
        ("speed", "V/c0", "x"),
        ("fwhm", "FWHM of force / √(12 I)", "xy"),
    ):
        values = [each[name] / first.unit(name) for each in theory]
        curves = [Curve("theory, all chains", forces, values, "k-")]
        chains = groupby(waves, lambda part: part[0].cell)
        for (cell, those), mark in zip(chains, cycle("osv^Dx"), strict=False):
            points = [
                (
                    row["force"],
                    row[name].value / wave.unit(name),
                    row[name].error / wave.unit(name),
                )
                for wave, row in those
            ]
            x, y, error = zip(*points, strict=True)
            curves.append(
                Curve(f"masses {', '.join(map(str, cell.masses))}", x, y, mark, error)
            )
        yield Panel("F/F0", label, tuple(curves), scale)


if __name__ == "__main__":
    precompressed.main()
