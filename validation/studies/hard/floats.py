"""The closed forms in float64 against 50 digits, in ulps, over an extreme grid of (k, ω).

Every function of `lwa.NumericWave` (β, width, FWHM of strain, force and velocity, speed, ln B) is
compared with the exact expression of `lwa.TravelingWave` it stands for, evaluated by mpmath at
`DIGITS` working digits; k and ω are the float64 numbers themselves, so that no error is their own.
An ulp is the distance of neighbouring float64 numbers at the exact value: 1/2 is perfect rounding.

Beside them stand the same numbers as the paper prints them (Porter et al. 2008), evaluated as
written in float64: G, H, I, the root p of (G+H+I) p² - (H+3I) p + 2I = 0, then a, μ, η, σ, s and

    β = √σ (1-η)/2,    B = (μ / (β² s (s-1)))^{1/(k-1)},

and, at k = 3/2, the expression of β in ω that fills a page. FWHM and speed are not printed there;
they are 2 arccos(2^{-1/m})/β, 2 arccos(2^{-1/(km)})/β, and V from the relation of B.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lwa import Dimer, TravelingWave, homogenize
from lwa.numeric import NumericWave

Array = NDArray[np.float64]

DIGITS = 80
"""Working digits: what cancels on the grid leaves more than 50 of them."""

ALLOWED = 8.0
"""Ulps that a closed form may lose; they need NumPy's longdouble to be longer than float64."""

EXPONENTS = np.array(
    [1 + 1e-6, 1 + 1e-5, 1.0001, 1.001, 1.01, 1.05, 1.1, 1.25, 1.4, 1.5, 1.6, 1.75, 1.9,
     2 - 2.0**-30, 2.0, 2 + 2.0**-30, 2.1, 2.5, 3 - 2.0**-30, 3.0, 3.5, 5.0, 8.0, 12.0, 20.0]
)  # fmt: skip
RATIOS = np.unique(
    np.concatenate(
        (
            10.0 ** np.arange(-6, 6.1, 0.5),
            [0.2733, 0.3428, 0.99, 1 - 2.0**-40, 1 + 2.0**-40, 1.01, 2.0, 3.0, 4.0, 5.0],
        )
    )
)
"""ω = m2/m1; 0.2733 is that of the paper."""

CLOSURES: Mapping[str, Mapping[str, str]] = {
    "paper's closure": {},
    "full closure": {"closure": "full"},
    "canonical field": {"closure": "full", "field": "center"},
}
"""The waves compared, as options of `lwa.homogenize`."""

PRINTED = "as printed"
"""The source of what follows the paper's text."""

Numeric = Callable[[NumericWave, Array, Array], Array]

FORMS: Mapping[str, tuple[Numeric, Callable[[TravelingWave], sp.Expr]]] = {
    "β": (lambda f, k, w: f.beta(k, w), lambda wave: wave.beta),
    "width π/β": (lambda f, k, w: f.width(k, w), lambda wave: wave.width),
    "FWHM of strain": (lambda f, k, w: f.fwhm(k, w, "strain"), lambda wave: wave.fwhm("strain")),
    "FWHM of force": (lambda f, k, w: f.fwhm(k, w, "force"), lambda wave: wave.fwhm("force")),
    "FWHM of velocity": (
        lambda f, k, w: f.fwhm(k, w, "velocity"),
        lambda wave: wave.fwhm("velocity"),
    ),
    "speed at B = 2": (lambda f, k, w: f.speed(k, w, 2.0), lambda wave: wave.speed(2)),
    "ln B at V = 2": (
        lambda f, k, w: f.log_amplitude(k, w, 2.0),
        lambda wave: (sp.log(4) - sp.log(wave.speed_factor)) / (wave.k - 1),
    ),
    "ln B at V = 2^1000": (
        lambda f, k, w: f.log_amplitude(k, w, 2.0**1000),
        lambda wave: (2000 * sp.log(2) - sp.log(wave.speed_factor)) / (wave.k - 1),
    ),
}
"""The closed forms: in float64, and exact."""


@dataclass(frozen=True, eq=False)
class Loss:
    """What one way to evaluate a form loses on a grid.

    name : of the form.
    source : one of `CLOSURES`, or `PRINTED`.
    k, omega : the grid, (n, m).
    ulps : (n, m); NaN where there is no wave, ∞ where there is one but the form gives no number.
    """

    name: str
    source: str
    k: Array
    omega: Array
    ulps: Array

    @property
    def points(self) -> int:
        """Points at which there is a wave."""
        return int(np.count_nonzero(~np.isnan(self.ulps)))

    @property
    def missing(self) -> int:
        """Those of them at which the form gives NaN, ∞ or a complex number."""
        return int(np.count_nonzero(np.isinf(self.ulps)))

    @property
    def worst(self) -> float:
        """The largest loss of those that give a number."""
        return float(np.max(self.ulps, where=np.isfinite(self.ulps), initial=0.0))

    @property
    def median(self) -> float:
        """The loss in the middle, no number counting as infinite."""
        return float(np.nanmedian(self.ulps))

    @property
    def where(self) -> tuple[float, float]:
        """k and ω of the largest loss."""
        at = np.argmax(np.where(np.isfinite(self.ulps), self.ulps, -1.0))
        return float(self.k.flat[at]), float(self.omega.flat[at])


def closed_wave(closure: str) -> TravelingWave:
    """The wave of one of `CLOSURES`, D = 1, with k, m1, m2 as symbols."""
    options: dict[str, Any] = dict(CLOSURES[closure])
    return homogenize(Dimer("m1", "m2", spacing=1), **options).pde.traveling_wave()


def grid() -> tuple[Array, Array]:
    """k and ω, each of shape (exponents, ratios)."""
    k, omega = np.meshgrid(EXPONENTS, RATIOS, indexing="ij")
    return k, omega


def exact(wave: TravelingWave, form: sp.Expr, k: Array, omega: Array, digits: int = DIGITS) -> Any:
    """A form at the grid's own numbers, an array of mpmath numbers; None where there is no wave.

    ``wave`` has the symbols k, m1, m2 and D = 1.
    """
    m1, m2 = wave.cell.masses
    arguments = wave.k, m2
    conditions = wave.dispersion, wave.speed_factor
    value, *positive = (
        sp.lambdify(arguments, expression.subs(m1, 1), "mpmath")
        for expression in (form, *conditions)
    )
    result = np.full(k.shape, None, object)
    with mp.workdps(digits):
        for at in np.ndindex(k.shape):
            point = mp.mpf(float(k[at])), mp.mpf(float(omega[at]))
            if all(condition(*point) > 0 for condition in positive):
                result[at] = value(*point)
    return result


def in_ulps(value: Array, exact: Any) -> Array:
    """|value - exact| over the spacing of float64 at the exact value; ∞ for what is no number."""
    result = np.full(value.shape, np.nan)
    with mp.workdps(DIGITS):
        for at in np.ndindex(value.shape):
            true, found = exact[at], float(value[at])
            if true is None:
                continue
            if not np.isfinite(found):
                result[at] = np.inf
                continue
            result[at] = abs(mp.mpf(found) - true) / mp.mpf(float(np.spacing(abs(float(true)))))
    return result


def losses() -> tuple[Loss, ...]:
    """All forms of all closures on the grid, then those of the paper as printed."""
    k, omega = grid()
    found: list[Loss] = []
    for closure in CLOSURES:
        wave = closed_wave(closure)
        numeric = wave.numeric(missing="nan")
        for name, (function, form) in FORMS.items():
            value = function(numeric, k, omega)
            ulps = in_ulps(value, exact(wave, form(wave), k, omega))
            # a number where there is no wave would be as wrong as none where there is one
            ulps[np.isnan(ulps) & np.isfinite(value)] = np.inf
            found.append(Loss(name, closure, k, omega, ulps))
    wave = closed_wave("paper's closure")
    for name, value in printed(k, omega).items():
        ulps = in_ulps(value, exact(wave, FORMS[name][1](wave), k, omega))
        found.append(Loss(name, PRINTED, k, omega, ulps))
    omega = RATIOS[None, :]
    k = np.full_like(omega, 1.5)
    ulps = in_ulps(printed_hertz_beta(omega), exact(wave, wave.beta, k, omega))
    found.append(Loss("β at k = 3/2", PRINTED, k, omega, ulps))
    return tuple(found)


def printed(k: Array, omega: Array) -> dict[str, Array]:
    """`FORMS` by the paper's route, in float64; NaN where p is complex or 0/0 comes up, m1 = 1.

    The root p with the minus sign. Where it is negative so is the printed β, whose sign does not
    matter: |β| is returned.
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

        def amplitude(V: float) -> Array:
            mu = V**2 / (I * (p + a))
            return np.asarray((mu / (beta**2 * s * (s - 1))) ** (1 / (k - 1)))

        def fwhm(power: Array) -> Array:
            return np.asarray(2 * np.arccos(2 ** (-(k - 1) / (2 * power))) / beta)

        one = np.ones_like(k)
        return {
            "β": beta,
            "width π/β": np.pi / beta,
            "FWHM of strain": fwhm(one),
            "FWHM of force": fwhm(k),
            "FWHM of velocity": fwhm(one),
            "speed at B = 2": np.sqrt(2 ** (k - 1) * I * (p + a) * beta**2 * s * (s - 1)),
            "ln B at V = 2": np.log(amplitude(2.0)),
        }


def printed_hertz_beta(omega: Array) -> Array:
    """β D at k = 3/2 as the paper writes it out, in float64."""
    w = omega
    root = np.sqrt(4 - 4 * w + 13 * w**2 - 18 * w**3 + 9 * w**4)
    quotient = ((1 + w) ** 2 * (15 - 4 * w + 4 * w**2)) / (
        34 - 42 * w + 59 * w**2 - 34 * w**3 + 17 * w**4 + (-8 + 5 * w - 5 * w**2) * root
    )
    arch = np.sqrt(3) * (8 - 5 * w + 5 * w**2 - root) * np.sqrt(quotient)
    return np.asarray(arch / (30 - 8 * w + 8 * w**2))
