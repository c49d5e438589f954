"""The contact law of a chain from measured peak forces and speeds, as a report."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import Any

import click
import numpy as np

from lwa import Cell
from lwa.base.arrays import Array
from lwa.base.exact import shorten
from lwa.base.files import entries, load
from lwa.command.options import quantities, quantity
from lwa.spheres.beads import spheres as read_spheres
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Measured, derived
from validation.report.command import column_options, option, study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.checks import SceneError
from validation.scenes.columns import MeasuredFile
from validation.waves.contact_law import Medium, fit_power, weights

_POWER = (Column("", "F = A δ^k"), Column("", "value", error=True))
_UNITS = "A bead's mass or the distance is 1 as none is given: see --masses, --spacing, --spheres."
_NOTE = "±: 95 % intervals by the scatter of the data."
_LEAST = 6  # pulses: three more than the coefficients of the curvature's fit


@study(
    click.argument("data", type=click.Path()),
    option("--masses", callback=quantities, says="Mass of a bead; by default 1."),
    option("--spacing", callback=quantity, says="Distance between bead centers; by default 1."),
    option(
        "--spheres",
        metavar="FILE",
        type=click.Path(),
        says="File of equal spheres, in place of --masses.",
    ),
    option("--material", metavar="NAME", says="Material in this file whose modulus E is wanted."),
    column_options,
)
def law(
    data: str,
    masses: Sequence[Any] = (),
    spacing: Any = None,
    spheres: str | None = None,
    material: str | None = None,
    renamed: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
) -> Report:
    """Contact law from pulses. DATA, a CSV file, has the columns force (peak force) and speed.
    Columns force_error and speed_error, if both are there, are standard deviations that weight the
    pulses. Units are stated in the header or by --unit, or no column has one.

    Peak contact forces and speeds are in the units of the masses and the spacing, by default those
    of unit mass and spacing; with spheres they are in N and m/s. ``k_value``, ``A_value`` and, of
    an unknown material, ``E_value``, with their errors; ``correlation_value`` of k and ln A;
    ``residual_value`` of ln V; ``one_power``.
    """
    force, speed, weight = _pulses(data, renamed, units)
    content: dict[str, Any] = {}
    if spheres is None:
        cell = Cell(masses or (1,), spacing=1 if spacing is None else spacing)
    else:
        content = load(spheres, "a list of spheres", lambda x: entries(x, "the file"))
        cell = Cell.of_spheres(read_spheres(content))
    medium = Medium.of(cell)
    fit = fit_power(medium, force, speed, weight)
    numbers = {"k": fit.k, "A": fit.A}
    if material is not None:
        if spheres is None:
            raise SceneError("material is given: its E needs --spheres")
        numbers["E"] = _modulus(content, material, fit.hertz)
    # Speeds beside one power, for which ln V is linear in ln F.
    line = np.exp(np.polyval(np.polyfit(np.log(force), np.log(speed), 1), np.log(force)))
    curves = (Curve("measured", force, speed, "C0o"), Curve("one power", force, line, "C1-"))
    bend = f"curvature of ln V against ln F {fit.curvature.value:.2g} ± {fit.curvature.error:.1g}"
    return Report(
        f"{len(force)} pulses, forces {force[0]:.4g} … {force[-1]:.4g}",
        (Table(_POWER, tuple(numbers.items())),),
        panels=(Panel("peak contact force", "speed", curves, "xy"),),
        notes=(
            f"One power is {'enough' if fit.one_power else 'not enough'}: {bend}.",
            *([] if spheres or (masses and spacing) else [_UNITS]),
            _NOTE,
        ),
        data={f"{name}_value": number.value for name, number in numbers.items()}
        | {f"{name}_error_value": number.error for name, number in numbers.items()}
        | {
            "correlation_value": fit.correlation,
            "residual_value": fit.residual,
            "one_power": fit.one_power,
        },
    )


def _pulses(
    data: str, renamed: Mapping[str, str] | None, units: Mapping[str, str] | None
) -> tuple[Array, Array, Array | None]:
    """Read `_LEAST` or more pulses; return rising forces, speeds and weights (None if none)."""
    file = MeasuredFile.read(data, "force", "speed", renamed=renamed, units=units)
    errors = (name for name in ("force_error", "speed_error") if name in file.names)
    read = [file.column(name) for name in ("force", "speed", *errors)]
    if len({*map(len, read)}) > 1:
        raise SceneError(f"{data}: columns of one length are wanted, not of {[*map(len, read)]}")
    order = np.argsort(read[0])
    force, speed, *deviations = (values[order] for values in read)
    if len(force) < _LEAST or not (force[0] > 0 and speed.min() > 0):
        raise SceneError(f"{data}: at least {_LEAST} pulses of positive force and speed are wanted")
    if (different := len(np.unique(force))) < _LEAST - 2:
        raise SceneError(f"{data}: {different} different forces: {_LEAST - 2} or more are wanted")
    if not deviations:
        return force, speed, None
    if len(deviations) != 2 or not min(map(np.min, deviations)) > 0:
        raise SceneError(f"{data}: force_error and speed_error are wanted together, and positive")
    return force, speed, weights(force, speed, *deviations)


def _modulus(content: dict[str, Any], material: str, stiffness: Measured) -> Measured:
    """Return E of a material in a file of equal spheres, from the stiffness A of their contacts."""

    def contact(E: float) -> float:
        """Return A at a given E."""
        changed = copy.deepcopy(content)
        given = changed.setdefault("materials", {}).setdefault(material, {"like": material})
        given["E"] = E
        return float(Cell.of_spheres(read_spheres(changed)).stiffnesses[0])

    if not contact(2.0) > contact(1.0):
        raise SceneError(f"material is {shorten(material)}: the spheres are not made of it")
    # Hertz: A = E √(2R)/(3 (1 - ν²)), proportional to E.
    return derived(lambda A: A / contact(1.0), stiffness)
