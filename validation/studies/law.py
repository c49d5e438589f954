"""The contact law of a chain of equal beads from peak contact forces F and speeds V of its pulses.

**One power.** For ``F = A δ^k``, mass m and spacing D the lattice's wave has ::

    V²/D² = R(k) 2/((k+1) m) A^{1/k} F^{(k-1)/k},

where R is the squared speed of the lattice's wave divided by that of the long-wave theory. So ln V
is linear in ln F; least squares give k and A, and with the exponent 3/2 of Hertz the unknown
Young's modulus E of one material.

Errors are 95 % intervals. The size of the noise is estimated from the residuals. Standard
deviations of the data, if known, weight the data, and the noise is at least theirs: the residuals
of few pulses may be small by chance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Unpack

import click
import numpy as np
import scipy

from lwa import Cell
from lwa.base import files
from lwa.base.arrays import Array
from lwa.base.exact import read_exact, shorten
from lwa.base.files import entries, load
from lwa.base.frozen import Estimate
from lwa.command.options import quantities
from lwa.spheres.beads import FILE, read_materials, spheres as read_spheres
from validation.pictures import Curve, Panel
from validation.report.study import Report, option, study
from validation.report.table import Column, Estimates, Table
from validation.scenes.checks import SceneError, numeric
from validation.scenes.columns import Stated
from validation.scenes.measured import MeasuredFile
from validation.studies.records import COLUMN_OPTIONS
from validation.studies.run import print_option
from validation.waves.solver import exact_wave

# Chosen: 25 draws are beyond either end of a 95 % interval.
_DRAWS = 1000  # times that the coefficients of ln V are drawn, for the errors
_HERTZ = 1.5
# Exponents that are read: below `LEAST` speeds hardly depend on force; beyond `MOST` the
# interpolant of R ends.
LEAST = 1.01
MOST = 4.0
LARGEST = 700.0  # largest |ln A|: floats end at e^709
RATIO_ERROR = 1e-10
"""Relative error of R(k), measured between the nodes of its interpolant."""
_POWER = (Column("", "F = A δ^k"), Estimates("", "value"))
_UNITS = "A bead's mass or the distance is 1 as none is given: see --masses, --spacing, --spheres."
_NOTE = "±: 95 % intervals by the scatter of the data."
_FEWEST = 6  # pulses: three more than the coefficients of the curvature's fit


_EXAMPLE = """force (N),force_error (N),speed (m/s),speed_error (m/s)
12,0.1,327,2
25,0.2,371,2
50,0.4,416,3
101,0.8,468,3
199,1.6,524,4
402,3.2,588,5
"""


@study(
    click.argument("data", type=click.Path()),
    option("--masses", "Mass of a bead; by default 1.", read=quantities),
    option(
        "--spacing", "Distance between bead centers; by default 1.", read=read_exact
    ),
    option(
        "--spheres",
        "File of equal spheres, in place of --masses.",
        metavar="FILE",
        type=click.Path(),
    ),
    option(
        "--material", "Material in this file whose modulus E is wanted.", metavar="NAME"
    ),
    print_option(
        "--example",
        lambda _: _EXAMPLE,
        "Print an example of DATA: blows on steel balls of 19.05 mm and 29 g.",
        is_flag=True,
    ),
    *COLUMN_OPTIONS,
    page="experiment",
    examples=(
        "lwa-validate law --example > pulses.csv",
        "lwa-validate law pulses.csv --masses 29e-3 --spacing 19.05e-3",
    ),
)
def law(
    data: str,
    masses: Sequence[Any] = (),
    spacing: Any = None,
    spheres: str | None = None,
    material: str | None = None,
    **stated: Unpack[Stated],
) -> Report:
    """Contact law from six or more pulses, of four or more forces. DATA, a file (- is standard
    input), has the columns force (peak force) and speed. Columns force_error and speed_error, if
    both are there, are standard deviations that weight the pulses. Units are stated in the file or
    by --unit, or no column has one.

    Peak contact forces and speeds are in the units of the masses and the spacing, by default those
    of unit mass and spacing; with spheres they are in N and m/s. ``k_value``, ``A_value`` and, of
    an unknown material, ``E_value``, with their errors; ``correlation_value`` of k and ln A;
    ``one_power``.
    """
    file = MeasuredFile.read(data, **stated)
    force, speed, weight = _pulses(file)
    content: dict[str, Any] = {}
    if spheres is None:
        cell = Cell(masses or (1,), spacing=1 if spacing is None else spacing)
    else:
        content = load(spheres, "a list of spheres", lambda x: entries(x, "the file"))
        cell = Cell.of_spheres(read_spheres(content))
    if cell.size > 1:
        raise SceneError(f"the cell has {cell.size} beads: equal beads are wanted")
    mass = numeric(cell.masses[0], "mass")
    # V²/D² · m does not depend on the units of mass and length.
    unit_speed = numeric(cell.spacing, "spacing") / math.sqrt(mass)
    fit = fit_power(force, speed / unit_speed, weight)
    numbers = {"k": fit.k, "A": fit.A}
    if material is not None:
        if spheres is None:
            raise SceneError("material is given: its E needs --spheres")
        numbers["E"] = _modulus(content, material, fit.hertz)
    units = {"k": ""}
    axes = ("peak contact force", "speed")
    # Without units in the file the law is in the units of the masses and the spacing.
    if file.si:
        units |= {"A": f" (N/m^{fit.k.value:.3g})", "E": " (Pa)"}
        axes = ("peak contact force (N)", "speed (m/s)")
    # Speeds beside one power, for which ln V is linear in ln F.
    x = np.log(force)
    fitted = np.polyfit(x, np.log(speed), 1)
    line = np.exp(np.polyval(fitted, x))
    bars = None if weight is None else speed / weight
    curves = (
        Curve("measured", force, speed, "C0o", bars),
        Curve("one power", force, line, "C1-"),
    )
    bend = f"curvature of ln V against ln F {fit.curvature.text(2)}"
    notes = [f"One power is {'enough' if fit.one_power else 'not enough'}: {bend}."]
    if not spheres and not (masses and spacing):
        notes.append(_UNITS)
    rows = []
    for name, number in numbers.items():
        rows.append({"F = A δ^k": name + units.get(name, ""), "value": number})
    return Report(
        f"{len(force)} pulses, forces {force[0]:.4g} … {force[-1]:.4g}{' N' * file.si}",
        (Table(_POWER, rows),),
        panels=(Panel(*axes, curves, scale="xy"),),
        notes=(*file.notes, *notes, _NOTE),
        data={
            "correlation_value": fit.correlation,
            "one_power": fit.one_power,
            **numbers,
        },
    )


def _pulses(file: MeasuredFile) -> tuple[Array, Array, Array | None]:
    """Return rising forces of `_FEWEST` or more pulses, their speeds and weights (None if none).

    Refused are fewer pulses or forces, numbers that are not positive, which have no logarithm, and
    standard deviations of the forces or of the speeds alone.
    """
    errors = [n for n in ("force_error", "speed_error") if n in file.names]
    # Files of other programs call the speed of a pulse its velocity.
    name = "speed"
    if name not in file.names and "velocity" in file.names:
        name = "velocity"
    read = file.rows("force", name, *errors).T
    rising = np.argsort(read[0])
    force, speed, *deviations = read[:, rising]
    positive = force[0] > 0 and speed.min() > 0
    if len(force) < _FEWEST or not positive:
        wanted = f"at least {_FEWEST} pulses of positive force and speed are wanted"
        raise SceneError(f"{file.path}: {wanted}")
    # Blows of one height tell one point of the law, however many they are.
    different = len(np.unique(force))
    if different < _FEWEST - 2:
        wanted = f"{_FEWEST - 2} or more are wanted"
        raise SceneError(f"{file.path}: {different} different forces: {wanted}")
    if not deviations:
        return force, speed, None
    if len(deviations) != 2 or not np.min(deviations) > 0:
        wanted = "force_error and speed_error are wanted together, and positive"
        raise SceneError(f"{file.path}: {wanted}")
    return force, speed, weights(force, speed, *deviations)


def _modulus(content: dict[str, Any], material: str, stiffness: Estimate) -> Estimate:
    """Return E of a material in a file of equal spheres, from the stiffness A of their contacts."""
    materials = read_materials(files.Table(content, "", FILE))
    balls = read_spheres(content)
    if any(ball.material != materials.get(material) for ball in balls):
        raise SceneError(
            f"material is {shorten(material)}: the spheres are not made of it"
        )
    A = Cell.of_spheres(balls).stiffnesses[0]
    # Hertz: A = E √(2R)/(3 (1 - ν²)), proportional to E.
    return stiffness * float(materials[material].E / A)


@cache
def _series() -> np.polynomial.Chebyshev:
    """Return R(k), 1.008 ≤ k ≤ 4, as an interpolant of degree 20."""
    exact = np.vectorize(lambda k: exact_wave([1], k).c2 * (k + 1) / 2)
    # The lowest node is at k = 1.012: there are no exact waves below 1.01.
    return np.polynomial.Chebyshev.interpolate(exact, 20, (1.008, 4))


def speed_ratio(k: Any) -> Array:
    """Return R(k), squared speed of the lattice's pulse over the theory's, for k from 1 to 4."""
    return np.asarray(_series()(np.clip(k, 1, 4)))


def log_stiffness(slope: Any, constant: Any) -> Array:
    """Return ln A of the contact law whose pulses have ``ln V = slope · ln F + constant``.

    V is the speed and F the peak contact force of a pulse, in a chain of mass and spacing 1. The
    speed law of the module's docstring, ``V² = R(k) 2/(k+1) A^{1/k} F^{(k-1)/k}``, has the
    logarithm::

        ln V = ln(R(k) 2/(k+1))/2 + ln A/(2k) + (k-1)/(2k) ln F,

    where all but the last term is the constant. This is solved for ln A.
    """
    k = _exponent(slope)
    # ln V at A = F = 1
    log_speed = np.log(2 * speed_ratio(k) / (k + 1)) / 2
    return np.asarray(2 * k * (constant - log_speed))


def _exponent(slope: Any) -> Any:
    """Return the exponent k of the law from the slope d ln V/d ln F of speeds; at most 50.

    A power law has ``V ∝ F^{(k-1)/(2k)}``, so that the slope is ``(k - 1)/(2k)`` and
    ``k = 1/(1 - 2 slope)``.
    """
    # The slope is below 1/2 at any k. In draws of noisy data it may reach 1/2, where k is infinite:
    # at 0.49 k = 50, far above any k that is read.
    return 1 / (1 - 2 * np.minimum(slope, 0.49))


@dataclass(frozen=True, eq=False)
class PowerFit:
    """Fit of ``F = A δ^k``, with 95 % errors."""

    k: Estimate
    A: Estimate
    correlation: float  # of k and ln A
    hertz: Estimate  # A at k = 3/2
    # Coefficient of (ln F)² in a parabola for ln V; 0 for one power
    curvature: Estimate

    @property
    def one_power(self) -> bool:
        """True if one power fits: the curvature of ln V(ln F) is 0 within its error."""
        return abs(self.curvature.value) <= self.curvature.error


def weights(
    force: Array, speed: Array, force_error: Array, speed_error: Array
) -> Array:
    """Return the weights (N,) of pulses, from the standard deviations of their forces and speeds.

    A residual of ``ln V = slope · ln F + constant`` has the variance
    ``(σ_V/V)² + (slope σ_F/F)²``, with the slope of a first fit without weights. The weights are
    the inverse standard deviations.
    """
    slope = np.polyfit(np.log(force), np.log(speed), 1)[0]
    deviation = np.hypot(speed_error / speed, slope * force_error / force)
    return np.asarray(1 / deviation)


def fit_power(force: Array, speed: Array, weight: Array | None = None) -> PowerFit:
    """Fit one power ``F = A δ^k`` to pulses by least squares of ln V.

    Parameters
    ----------
    force, speed : array
        Peak contact forces F and speeds ``V √m/D`` (N,) of four or more pulses.
    weight : array, optional
        Weights (N,), see `weights`; by default all pulses weigh the same.

    Returns
    -------
    PowerFit

    Raises
    ------
    SceneError
        For a k out of the range from `LEAST` to `MOST`, and for an A beyond the range of a float.
    """
    # A power law is a line: ln V = slope · ln F + constant.
    x, y = np.log(force), np.log(speed)
    (slope, constant), middle = _fit(x, y, 1, weight)
    k = _exponent(slope)
    at_zero = constant - slope * middle
    log_A = log_stiffness(slope, at_zero)
    if not LEAST <= k[0] <= MOST:
        wanted = f"laws with k from {LEAST:g} to {MOST:g} are read"
        raise SceneError(f"k is {k[0]:.3g} by the best fit: {wanted}")
    # Hertz's law: the slope (k - 1)/(2k) of ln V is given, and the constant alone is fitted.
    sixth = (_HERTZ - 1) / (2 * _HERTZ)
    (hertz,), _ = _fit(x, y - sixth * x, 0, weight)
    # A parabola, for the curvature
    (curvature, *_), _ = _fit(x, y, 2, weight)

    def stiffness(log_A: Array, k: float) -> Estimate:
        """Return A from ln A by the best fit and the draws; refuse a number beyond the floats."""
        log = _interval(log_A)
        # A goes as R(k)^{-k}: the relative error of R(k) counts k times.
        error = log.error + k * RATIO_ERROR
        if not abs(log.value) + error < LARGEST:
            raise SceneError(
                f"A is e^({log}) by the best fit: this is no number of a computer"
            )
        # The larger one of the two distances, which are unequal, from A to the ends of the interval
        A = math.exp(log.value)
        return Estimate(A, A * math.expm1(error))

    return PowerFit(
        _interval(k),
        stiffness(log_A, float(k[0])),
        float(np.corrcoef(k, log_A)[0, 1]),
        stiffness(log_stiffness(sixth, hertz), _HERTZ),
        _interval(curvature),
    )


def _fit(x: Array, y: Array, degree: int, weight: Array | None) -> tuple[Array, float]:
    """Fit a polynomial in x - middle; return coefficients (degree + 1, 1 + draws) and middle.

    weight : inverse standard deviations of y, None if they are unknown.
    """
    # On data without scatter the rounding of ln F, of ln V and of the fit is left.
    rounding = 2 * np.finfo(float).eps * (1 + np.abs(x) + np.abs(y))
    w = np.ones_like(x)
    # Least scatter of the residuals: that of rounding; of residuals over known deviations, 1
    least = float(np.sum(rounding**2))
    if weight is not None:
        w = weight
        least = 1.0
    # Slope and constant are uncorrelated about it.
    middle = np.average(x, weights=w**2)
    best, covariance = np.polyfit(x - middle, y, degree, w=w, cov="unscaled")
    freedom = len(x) - degree - 1
    residuals = y - np.polyval(best, x - middle)
    scatter = np.sum((w * residuals) ** 2) / freedom
    # Coefficients, highest first, of the best fit, then draws from their distribution: Student's t
    # with the scatter of the residuals.
    shape = covariance * max(scatter, least)
    noise = scipy.stats.multivariate_t(None, shape, freedom, allow_singular=True)
    drawn = noise.rvs(_DRAWS, random_state=0)
    draws = drawn.reshape(_DRAWS, degree + 1)
    return np.vstack((best, best + draws)).T, middle


def _interval(values: Array) -> Estimate:
    """Return the best fit's value, the first, with half the 95 % interval of the draws' values."""
    ends = np.quantile(values[1:], (0.025, 0.975))
    error = np.ptp(ends) / 2
    return Estimate(float(values[0]), float(error))
