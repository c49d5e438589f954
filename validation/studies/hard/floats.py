"""The closed forms in float64 against 50 digits, in ulps, over an extreme grid of (k, ω).

Every function of `lwa.NumericWave` (β, width, FWHM of strain, force and velocity, speed, ln B) is
compared with the exact expression of `lwa.TravelingWave`, evaluated by mpmath at `DIGITS` working
digits; k and ω are the float64 numbers themselves, so that no error is their own. An ulp is the
distance of neighbouring float64 numbers at the exact value: 1/2 is perfect rounding.

Beside them stand the same numbers as the paper prints them (Porter et al. 2008), in float64, by the
root p of (G+H+I) p² - (H+3I) p + 2I = 0, and, at k = 3/2, β as the expression in ω that fills a
page. FWHM and speed, not printed there, follow from the paper's β and B.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from lwa import Dimer, TravelingWave, homogenize
from lwa.base.arrays import Array
from lwa.wave.numeric import NumericWave
from validation.report.panel import Curve, Panel
from validation.report.table import Column, Finding, Table
from validation.studies.hard.case import Parts, case

DIGITS = 80  # what cancels on the grid leaves more than 50 of them
ALLOWED = 2.0  # ulps that a closed form may lose
PRINTED = "as printed"  # the source of what follows the paper's text

EXPONENTS = np.array(
    [1 + 1e-6, 1 + 1e-5, 1.0001, 1.001, 1.01, 1.05, 1.1, 1.25, 1.4, 1.5, 1.6, 1.75, 1.9,
     2 - 2.0**-30, 2.0, 2 + 2.0**-30, 2.1, 2.5, 3 - 2.0**-30, 3.0, 3.5, 5.0, 8.0, 12.0, 20.0]
)  # fmt: skip
# ω = m2/m1; 0.2733 is that of the paper.
RATIOS = np.unique(
    [*10.0 ** np.arange(-6, 6.1, 0.5), 0.2733, 0.3428, 0.99, 1 - 2.0**-40, 1 + 2.0**-40, 1.01,
     2.0, 3.0, 4.0, 5.0]
)  # fmt: skip

CLOSURES: Mapping[str, Mapping[str, Any]] = {
    "paper's closure": {},
    "full closure": {"closure": "full"},
    "canonical field": {"closure": "full", "field": "center"},
}
"""The waves compared, as options of `lwa.homogenize`."""

Form = tuple[Callable[[NumericWave, Array, Array], Array], Callable[[TravelingWave], sp.Expr]]
"""A closed form: in float64 from k and ω, and exact."""


def log_amplitude(wave: TravelingWave, V: sp.Expr) -> sp.Expr:
    """ln B of the wave of speed V."""
    return (2 * sp.log(V) - sp.log(wave.speed_factor)) / (wave.k - 1)


FORMS: Mapping[str, Form] = {
    "β": (lambda f, k, w: f.beta(k, w), lambda wave: wave.beta),
    "width π/β": (lambda f, k, w: f.width(k, w), lambda wave: wave.width),
    "FWHM of strain": (lambda f, k, w: f.fwhm(k, w, "strain"), lambda wave: wave.fwhm("strain")),
    "FWHM of force": (lambda f, k, w: f.fwhm(k, w, "force"), lambda wave: wave.fwhm("force")),
    "FWHM of velocity": (lambda f, k, w: f.fwhm(k, w, "velocity"),
                         lambda wave: wave.fwhm("velocity")),
    "speed at B = 2": (lambda f, k, w: f.speed(k, w, 2.0), lambda wave: wave.speed(2)),
    "ln B at V = 2": (lambda f, k, w: f.log_amplitude(k, w, 2.0),
                      lambda wave: log_amplitude(wave, sp.Integer(2))),
    "ln B at V = 2^1000": (lambda f, k, w: f.log_amplitude(k, w, 2.0**1000),
                           lambda wave: log_amplitude(wave, sp.Integer(2) ** 1000)),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Loss:
    """What one way to evaluate a form loses on a grid (n, m).

    ulps : NaN where there is no wave, ∞ where there is one but no number.
    points, missing : how many have a wave, and how many of these no number.
    worst, where : the largest loss of those with a number, and its k and ω.
    median : of all with a wave.
    """

    ulps: Array
    points: int
    missing: int
    worst: float
    where: tuple[float, float]
    median: float

    @classmethod
    def of(cls, ulps: Array, k: Array, omega: Array) -> Loss:
        """Of the ulps at these k and ω."""
        known = np.where(np.isfinite(ulps), ulps, 0.0)
        at = np.argmax(known)
        points, missing = (int(np.count_nonzero(x)) for x in (~np.isnan(ulps), np.isinf(ulps)))
        where = float(k.flat[at]), float(omega.flat[at])
        return cls(ulps, points, missing, float(known.max()), where, float(np.nanmedian(ulps)))


def closed_wave(closure: str) -> TravelingWave:
    """The wave of one of `CLOSURES`, D = 1, with k, m1, m2 as symbols."""
    return homogenize(Dimer("m1", "m2", spacing=1), **CLOSURES[closure]).pde.traveling_wave()


def exact(wave: TravelingWave, form: sp.Expr, k: Array, omega: Array) -> Any:
    """A form of a `closed_wave` at the grid's own numbers, by mpmath; None where is no wave."""
    m1, m2 = wave.cell.masses
    value, *positive = (
        sp.lambdify((wave.k, m2), expression.subs(m1, 1), "mpmath")
        for expression in (form, wave.dispersion, wave.speed_factor)
    )

    def at(*point: float) -> Any:
        numbers = tuple(map(mp.mpf, point))
        return value(*numbers) if all(each(*numbers) > 0 for each in positive) else None

    with mp.workdps(DIGITS):
        return np.frompyfunc(at, 2, 1)(k, omega)


def in_ulps(value: Array, exact: Any) -> Array:
    """|value - exact| over the spacing of float64 at the exact value; ∞ for what is no number."""

    def loss(found: float, true: Any) -> float:
        if true is None or not math.isfinite(found):
            return math.nan if true is None else math.inf
        return float(abs(mp.mpf(found) - true) / float(np.spacing(abs(float(true)))))

    with mp.workdps(DIGITS):
        return np.asarray(np.frompyfunc(loss, 2, 1)(value, exact), float)


def losses() -> dict[tuple[str, str], Loss]:
    """All forms on the grid, of all closures and as printed, by form and closure or `PRINTED`."""
    k, omega = np.meshgrid(EXPONENTS, RATIOS, indexing="ij")
    found = {}
    for closure in CLOSURES:
        wave = closed_wave(closure)
        numeric = wave.numeric(missing="nan")
        for name, (function, form) in FORMS.items():
            value = function(numeric, k, omega)
            ulps = in_ulps(value, exact(wave, form(wave), k, omega))
            # a number where there is no wave would be as wrong as none where there is one
            ulps[np.isnan(ulps) & np.isfinite(value)] = np.inf
            found[name, closure] = Loss.of(ulps, k, omega)
    wave = closed_wave("paper's closure")
    for name, value in printed(k, omega).items():
        ulps = in_ulps(value, exact(wave, FORMS[name][1](wave), k, omega))
        found[name, PRINTED] = Loss.of(ulps, k, omega)
    k, omega = np.meshgrid(1.5, RATIOS, indexing="ij")
    ulps = in_ulps(printed_hertz_beta(omega), exact(wave, wave.beta, k, omega))
    return found | {("β at k = 3/2", PRINTED): Loss.of(ulps, k, omega)}


def printed(k: Array, omega: Array) -> dict[str, Array]:
    """`FORMS` by the paper's route, in float64; NaN where p is complex or 0/0 comes up, m1 = 1.

    The root p is that with the minus sign. Where it is negative so is β: |β| is returned.
    """
    M = 1 + omega
    G = (2 - 3 * k + k**2) / (6 * M**2)
    H = 2 * (k - 1) * (2 + omega - omega**2) / (6 * M**2)
    I = 2 * (1 - omega + omega**2) / (6 * M**2)
    with np.errstate(all="ignore"):  # outside the route's domain, which NaN and ∞ tell
        p = ((H + 3 * I) - np.sqrt((H + 3 * I) ** 2 - 8 * (G + H + I) * I)) / (2 * (G + H + I))
        a = 1 - k * p + 3 * (p - 1) + p * H / I
        eta = 1 + p - k * p
        sigma = 1 / (I * (k * p + a))
        beta = np.abs(np.sqrt(sigma) * (1 - eta) / 2)
        s = 2 / (1 - eta)
        mu = 2.0**2 / (I * (p + a))  # at V = 2
        powers: dict[str, Any] = {"strain": 1.0, "force": k, "velocity": 1.0}
        return {
            "β": beta,
            "width π/β": np.pi / beta,
            **{f"FWHM of {quantity}": 2 * np.arccos(2 ** (-(k - 1) / (2 * power))) / beta
               for quantity, power in powers.items()},
            "speed at B = 2": np.sqrt(2 ** (k - 1) * I * (p + a) * beta**2 * s * (s - 1)),
            "ln B at V = 2": np.log((mu / (beta**2 * s * (s - 1))) ** (1 / (k - 1))),
        }  # fmt: skip


def printed_hertz_beta(omega: Array) -> Array:
    """β D at k = 3/2 as the paper writes it out, in float64."""
    w = omega
    root = np.sqrt(4 - 4 * w + 13 * w**2 - 18 * w**3 + 9 * w**4)
    quotient = ((1 + w) ** 2 * (15 - 4 * w + 4 * w**2)) / (
        34 - 42 * w + 59 * w**2 - 34 * w**3 + 17 * w**4 + (-8 + 5 * w - 5 * w**2) * root
    )
    arch = np.sqrt(3) * (8 - 5 * w + 5 * w**2 - root) * np.sqrt(quotient)
    return np.asarray(arch / (30 - 8 * w + 8 * w**2))


_COLUMNS = (  # a form's losses in each closure, and what the printed form loses
    Column(label="largest loss, ulps"),
    *(Column(label=closure, format=lambda loss: f"{loss.worst:.2f}") for closure in CLOSURES),
    Column(label=PRINTED, format=lambda loss: f"{loss.worst:.2g}"),
    Column(label="at", format=lambda loss: "k = {:.7g}, ω = {:.3g}".format(*loss.where)),
    Column(label="median", format=lambda loss: f"{loss.median:.2g}"),
    Column(label="no number", format=lambda loss: f"{loss.missing} of {loss.points}"),
)


@case(
    f"Less than {ALLOWED:g}, in every closed form and closure, and there is always a number. The "
    "paper's route through the root p loses all digits where G+H+I nearly vanishes and gives no "
    "number where p is complex; its expression of β at k = 3/2 is sound.",
    Panel("k - 1", "largest loss of β, in ulps", scale="xy"),
)
def closed_forms() -> Parts:
    """k = 1 + 1e-6 … 20, ω = 1e-6 … 1e6: how many ulps does float64 lose against 50 digits?"""
    found = losses()
    ours = [loss for (_, source), loss in found.items() if source != PRINTED]
    theirs = found["β", PRINTED]
    yield from (
        Finding("largest loss of all in ulps", max(loss.worst for loss in ours), 0, ALLOWED,
                key="loss_ulps"),
        Finding("points at which one of them has no number", sum(loss.missing for loss in ours),
                0, 0, key="missing"),
        Finding("β as printed: largest loss in ulps", theirs.worst, ALLOWED,
                key="printed_loss_ulps"),
        Finding("β as printed: points without a number", theirs.missing, 1, key="printed_missing"),
    )  # fmt: skip
    for (form, source), loss in found.items():
        name = f"{form}, {source}"
        # The route through p is only told; the expression for k = 3/2 is nearly as good as ours.
        most, none = ALLOWED, 0.0
        if source == PRINTED:
            most, none = (math.inf, math.inf) if form in FORMS else (2 * ALLOWED, 0.0)
        yield Finding(f"{name}: largest loss in ulps", loss.worst, high=most)
        yield Finding(f"{name}: median loss in ulps", loss.median)
        name = f"{name}: points of {loss.points} without a number"
        yield Finding(name, loss.missing, high=none)
    rows = ((form, *(found.get((form, source)) for source in (*CLOSURES, *[PRINTED] * 4)))
            for form in dict.fromkeys(form for form, _ in found))  # fmt: skip
    yield Table(_COLUMNS, tuple(rows))
    for label, loss in (("lwa", found["β", "paper's closure"]), (PRINTED, theirs)):
        largest = np.max(loss.ulps, axis=1, where=np.isfinite(loss.ulps), initial=0.0)
        yield Curve.of(label, EXPONENTS - 1, largest)
