"""Exact waves in lattices of unlike links or farther neighbours, beside `lwa.loaded_wave`.

Beads of mass 1 stand at the distance 1; each link between beads has a law F(δ) of its own. A wave
u(x - Vt) of the lattice is computed by Newton's method. The compression of each link, less its
value at rest, is an even function of x - Vt, given at equidistant points of a ring that is long
beside the wave. With q for the wavenumber and S = sin²(q/2)/(q/2)² the equations of motion are, in
Fourier space,

- for equal beads with the links a and b in turn: V² (δ_a + δ_b) = S (F_a + F_b) and
  V² q² (δ_a - δ_b) = 2 (1 + cos q) (F_a - F_b);
- for one bead in a cell, linked to its neighbours r: V² δ_1 = S Σ_r s_r F_r and δ_r = s_r δ_1,
  s_r = sin(rq/2)/sin(q/2).

The cases:

- ``unlike``: δ^{3/2} and δ³ in turn, under a load.
- ``neighbours``: δ^{3/2} between neighbours, and a quarter of it between second neighbours.
- ``dispersion``: the compliances δ_a = F + βF² and δ_b = F - (β + ε)F², β = 1/4. The mean strain is
  nearly linear in F, so that waves are long, and yet the dispersion I doubles along the wave. The
  theory with I at rest has a wrong width, however small ε is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
import sympy as sp

from lwa import Lattice, Law, Link, Power, loaded_wave
from lwa.base.arrays import Array
from lwa.base.progress import Progress
from lwa.base.words import QuantityName
from lwa.law import DELTA
from validation.lattice.laws import Contact
from validation.pictures import Curve, Panel
from validation.report.study import Report, option, study
from validation.report.table import Column, Finding, Table, percent
from validation.scenes.checks import Failure, one_of

HERTZ = Power("3/2")
Bounds = tuple[float, float]
"""Largest errors of V² - c0² and of the FWHM that the study promises."""

NONE = math.inf, math.inf
UNLIKE = {
    0.02: (0.002, 0.0025),
    0.1: (0.008, 0.011),
    0.5: (0.042, 0.07),
    1.0: NONE,
    2.0: NONE,
}
NEIGHBOURS = {
    0.02: (2e-4, 0.002),
    0.1: (1e-3, 0.01),
    0.5: (3e-3, 0.03),
    1.0: (5e-3, 0.05),
}
"""Dynamic over static force, or strain, and the bounds."""
EPSILONS = {"1/20": 0.025, "1/40": 0.012, "1/80": 0.006}
"""ε and the bound of both errors."""
BETA = sp.Rational(1, 4)
# Of half a ring. 240 points change no speed by 1e-14 and no width by 1e-11, at twice the CPU.
POINTS = 160
# Length of half a ring in FWHM, and its least length in sites
WIDTHS, SHORTEST = 5.0, 25.0
LONGER = np.arange(0, 2, 0.4)  # over a wavelength of the optical tail, about 2 sites


@study(option("--case", "unlike, neighbours, dispersion or all.", default="all"))
def links(case: str = "all", progress: Progress[Any] = iter) -> Report:
    """Exact waves in lattices of unlike links or farther neighbours (ten seconds).

    ``rows``: ``case``, ``chain``, ``ratio_value`` (dynamic over static force; null without load),
    ``square_value`` (V²), ``square_theory_value``, ``square_error_value`` (theory over lattice,
    less 1, as all errors), ``excess_error_value`` (of V² - c0²), ``of`` (of which quantity the FWHM
    is), ``fwhm_value``, ``fwhm_theory_value``, ``fwhm_error_value``, ``constant_error_value`` (of
    the FWHM with I at rest in the place of I(p)), ``tail_value`` (far from the wave, over its peak;
    lattices with an optical branch have a tail).

    Raises `lwa.InputError` for another case.
    """
    chosen = CASES if one_of(case, ("all", *CASES), "case") == "all" else (case,)
    chains = [(name, chain) for name in chosen for chain in CASES[name]()]
    return _report([(chain, chain.cells(name)) for name, chain in progress(chains)])


@dataclass(frozen=True)
class Chain:
    """A lattice and its wave: peak force, static force, and the promised bounds of the errors.

    constant : FWHM of the force by the theory with the dispersion I at rest, if it is asked for.
    """

    name: str
    lattice: Lattice
    force: float
    load: float = 0.0
    bounds: Bounds = NONE
    constant: float | None = None

    def cells(self, case: str) -> dict[str, Any]:
        """Table row: the lattice's wave beside the theory."""
        theory = loaded_wave(self.lattice, force=self.force, precompression=self.load)
        wave = exact(self.lattice, self.force, self.load)
        sound, square = float(theory.sound_speed) ** 2, float(theory.speed) ** 2
        fwhm = float(theory.fwhm(wave.of))
        return {
            "case": case,
            "chain": self.name,
            "ratio": self.force / self.load - 1 if self.load else None,
            "square": wave.square,
            "square theory": square,
            "square error": square / wave.square - 1,
            "excess error": (square - sound) / (wave.square - sound) - 1,
            "of": wave.of,
            "fwhm": wave.fwhm,
            "fwhm theory": fwhm,
            "fwhm error": fwhm / wave.fwhm - 1,
            "constant error": None
            if self.constant is None
            else self.constant / wave.fwhm - 1,
            "tail": wave.tail,
        }


def unlike() -> Iterator[Chain]:
    """Waves of δ^{3/2} and δ³ in turn, under the load 1."""
    lattice = Lattice((1, 1), (Link(0, 1, HERTZ), Link(1, 2, Power(3))))
    for rise, bounds in UNLIKE.items():
        yield Chain("δ^3/2, δ^3", lattice, 1 + rise, 1.0, bounds)


def neighbours() -> Iterator[Chain]:
    """Waves of neighbours and second neighbours, on the static strain 1 and without load."""
    second = sp.Rational(1, 4)
    lattice = Lattice((1,), (Link(0, 1, HERTZ), Link(0, 2, HERTZ, second)))
    load = 1 + float(second) * 2**2.5  # F = Σ r F_r(rp) at p = 1
    for rise, bounds in NEIGHBOURS.items():
        yield Chain("range 2", lattice, load * (1 + rise) ** 1.5, load, bounds)
    yield Chain("range 2", lattice, load, bounds=(0.01, 0.17))


def dispersion() -> Iterator[Chain]:
    """Waves from the force 0 to 1, of two compliances that vary oppositely."""
    for text, bound in EPSILONS.items():
        epsilon = sp.Rational(text)
        constant = series_width(
            float(epsilon), lambda force: 1 / 12
        )  # I of equal springs
        yield Chain(f"ε = {text}", varying(epsilon), 1.0, 0.0, (bound, bound), constant)


CASES: dict[str, Callable[[], Iterator[Chain]]] = {
    case.__name__: case for case in (unlike, neighbours, dispersion)
}


def varying(epsilon: sp.Rational) -> Lattice:
    """Two beads with links of the compliances F + βF² and F - (β + ε)F²."""
    # The roots of δ = F + bF² without cancellation at small δ
    first, second = (
        2 * DELTA / (1 + sp.sqrt(1 + 4 * b * DELTA)) for b in (BETA, -BETA - epsilon)
    )
    return Lattice((1, 1), (Link(0, 1, Law(first)), Link(1, 2, Law(second))))


def series_width(epsilon: float, I: Callable[[float], float]) -> float:
    """FWHM of the force in `varying` at the peak 1, by quadrature with a dispersion I(F).

    Exactly p = F - εF²/2 and W = F²/2 - εF³/3, so that F′ I (dp/dξ)² = V²p² - 2W.
    """
    square = (1 - 2 * epsilon / 3) / (1 - epsilon / 2) ** 2  # 2W/p² at F = 1

    def rate(y: float) -> float:
        F = 1 - y**2 / 2  # from the peak at y = 0 to half of it at y = 1
        p, W = F - epsilon * F**2 / 2, F**2 / 2 - epsilon * F**3 / 3
        return y * math.sqrt(I(F) * (1 - epsilon * F) / (square * p**2 - 2 * W))

    return 2 * float(scipy.integrate.quad(rate, 0, 1, epsabs=1e-10)[0])


@dataclass(frozen=True)
class Exact:
    """A wave of the lattice.

    square : V². of : "force" (mean over two links) or "strain", whose FWHM is ``fwhm``.
    tail : largest value of that quantity in the last tenth of half a period, over the peak.
    """

    square: float
    of: QuantityName
    fwhm: float
    tail: float


def exact(lattice: Lattice, force: float, load: float) -> Exact:
    """The lattice's own wave: of several half periods, the wave of the smallest tail.

    force : mean peak force of two links a and b; for farther neighbours the static force of the
        peak strain. load : static force.

    Raises `Failure` if Newton's method does not converge.
    """
    width = float(loaded_wave(lattice, force=force, precompression=load).fwhm("strain"))
    halves = max(SHORTEST, WIDTHS * width) + LONGER
    waves = []
    for half in halves if len(lattice.masses) > 1 else halves[:1]:
        with suppress(
            Failure
        ):  # no wave is on a ring of a length that resonates with the tail
            waves.append(periodic(lattice, force, load, half))
    if not waves:
        raise Failure(
            f"force {force:g}, load {load:g}: Newton's method does not converge"
        )
    return min(waves, key=lambda wave: wave.tail)


def periodic(lattice: Lattice, force: float, load: float, half: float) -> Exact:
    """The wave on a ring of length 2 · half, by Newton's method from the theory's wave.

    Raises `Failure` if Newton's method does not converge.
    """
    theory = loaded_wave(lattice, force=force, precompression=load)
    guess = float(theory.fwhm("strain"))
    x = np.linspace(0, half, POINTS + 1)
    inertia, tension, spread = _operators(lattice, half)
    rest, top = _compressions(lattice, load), _compressions(lattice, force)
    own = len(inertia) // len(x)  # unknown functions: a and b, or δ_1
    shape = 1 / np.cosh(2 * math.acosh(math.sqrt(2)) * x / guess) ** 2
    d = np.concatenate([rise * shape for rise in (top - rest)[:own]])
    square = float(theory.speed) ** 2
    goal = _forces(lattice, top - rest, rest)[:own].sum()
    for _ in range(30):
        at = (spread @ d).reshape(len(rest), -1)
        F, slope = (
            _forces(lattice, at, rest[:, None]),
            _slopes(lattice, at + rest[:, None]),
        )
        matrix = np.zeros((len(d) + 1,) * 2)
        matrix[:-1, :-1] = square * inertia - tension @ (
            slope.ravel()[:, None] * spread
        )
        matrix[:-1, -1] = inertia @ d
        for i in range(own):
            matrix[-1, :-1] += slope[i, 0] * spread[i * len(x)]
        residual = [
            *(square * inertia @ d - tension @ F.ravel()),
            F[:own, 0].sum() - goal,
        ]
        step = np.linalg.solve(matrix, residual)
        d, square = d - step[:-1], square - step[-1]
        if np.abs(step).max() < 1e-11 * np.abs(d).max():
            break
    else:
        raise Failure("Newton's method does not converge")
    of: QuantityName = "force" if own > 1 else "strain"
    curves = F[:own] if own > 1 else d[None]
    width = np.mean([_width(x, curve) for curve in curves])
    tail = np.abs(curves[:, x > 0.9 * x[-1]]).max() / curves[:, 0].max()
    return Exact(float(square), of, float(width), float(tail))


def _operators(lattice: Lattice, half: float) -> tuple[Array, Array, Array]:
    """Matrices A, B, E of the equations V² A d = B F(E d), on the points of half a period."""
    q = np.arange(POINTS + 1) * np.pi / half
    transform = scipy.fft.dct(np.eye(len(q)), type=1, axis=0)

    def operator(symbol: Array) -> Array:
        return np.asarray(scipy.fft.idct(symbol[:, None] * transform, type=1, axis=0))

    one, S = np.eye(len(q)), operator(np.sinc(q / (2 * np.pi)) ** 2)
    if len(lattice.masses) == 1:
        # sin(rq/2)/sin(q/2) is Chebyshev's U_{r-1}(cos(q/2)), which is regular everywhere.
        ranges = [link.j - link.i for link in lattice.links]
        spread = [
            operator(scipy.special.eval_chebyu(r - 1, np.cos(q / 2))) for r in ranges
        ]
        return one, np.hstack([S @ s for s in spread]), np.vstack(spread)
    # The second equation is divided by 1 + q², so that short waves do not dominate the residual.
    inner, outer = (
        operator(q**2 / (1 + q**2)),
        operator(2 * (1 + np.cos(q)) / (1 + q**2)),
    )
    A, B = [[one, one], [inner, -inner]], [[S, S], [outer, -outer]]
    return np.block(A), np.block(B), np.eye(2 * len(q))


def contact(link: Link) -> Contact:
    """Force of a link in numbers, but for its factor; a power only pushes."""
    law = link.law
    return Contact(float(law.exponent)) if law.homogeneous else Contact(1.0, law)


def _forces(lattice: Lattice, rise: Array, rest: Array) -> Array:
    """Forces of the links above those at rest, (L, …)."""
    parts = zip(lattice.links, map(contact, lattice.links), rise, rest, strict=True)
    return np.array(
        [float(k.factor) * (c.force(r + d) - c.force(r)) for k, c, d, r in parts]
    )


def _slopes(lattice: Lattice, compression: Array) -> Array:
    """Stiffnesses F′ of the links, (L, …)."""
    parts = zip(lattice.links, map(contact, lattice.links), compression, strict=True)
    return np.array([float(k.factor) * c.stiffness(d) for k, c, d in parts])


def _compressions(lattice: Lattice, force: float) -> Array:
    """Compressions of the links under a static force (L,)."""
    if not force:
        return np.zeros(len(lattice.links))
    if len(lattice.masses) == 2:
        shares = [np.array([force / float(link.factor)]) for link in lattice.links]
        pairs = zip(lattice.links, shares, strict=True)
        return np.concatenate(
            [contact(link).compressed_by(share) for link, share in pairs]
        )
    ranges: Array = np.array([link.j - link.i for link in lattice.links], float)
    at_one = float(ranges @ _forces(lattice, ranges, 0 * ranges))
    strain = (force / at_one) ** (
        1 / contact(lattice.links[0]).k
    )  # all links are of one power
    return np.asarray(strain * ranges)


def _width(x: Array, values: Array) -> float:
    """FWHM of an even function by its cosine series."""
    coefficients = scipy.fft.dct(values, type=1) / (len(x) - 1)
    coefficients[[0, -1]] /= 2
    n, first = np.arange(len(x)) * np.pi / x[-1], int(np.argmax(values < values[0] / 2))

    def over_half(t: float) -> float:
        return float(np.cos(n * t) @ coefficients - values[0] / 2)

    return 2 * float(scipy.optimize.brentq(over_half, x[first - 1], x[first]))


_COLUMNS = {
    "case": Column("case"),
    "chain": Column("chain", "chain"),
    "ratio": Column("ratio_value", "F/F0 - 1", format=".3g"),
    "square": Column("square_value", "V²", format=".6f"),
    "square theory": Column("square_theory_value"),
    "square error": Column("square_error_value", "off", format=percent),
    "excess error": Column("excess_error_value", "V² - c0² off", format=percent),
    "of": Column("of", "FWHM of"),
    "fwhm": Column("fwhm_value", "sites", format=".4f"),
    "fwhm theory": Column("fwhm_theory_value"),
    "fwhm error": Column("fwhm_error_value", "off", format=percent),
    "constant error": Column("constant_error_value", "by I at rest", format=percent),
    "tail": Column("tail_value", "tail", format=".0e"),
}


def _report(rows: Sequence[tuple[Chain, dict[str, Any]]]) -> Report:
    findings = []
    for chain, row in rows:
        names = {"excess error": "V² - c0²", "fwhm error": "FWHM"}
        for (key, name), bound in zip(names.items(), chain.bounds, strict=True):
            if math.isfinite(bound):
                title = f"{chain.name}, force {chain.force:.3g}: error of {name}"
                findings.append(Finding(title, row[key], -bound, bound))
        if (constant := row["constant error"]) is not None:
            findings.append(
                Finding(f"{chain.name}: FWHM by I at rest", constant, high=-0.15)
            )
    table = [{c.name: row[name] for name, c in _COLUMNS.items()} for _, row in rows]
    return Report(
        "Exact waves of lattices, beside the relation that knows the static energy and I",
        (Table([*_COLUMNS.values()], table, "rows", by="case"),),
        tuple(findings),
        tuple(_panels([row for _, row in rows])),
        (
            "off: theory over lattice, less 1. Units: masses, spacing, static force or strain 1.",
        ),
    )


def _panels(rows: Sequence[dict[str, Any]]) -> Iterator[Panel]:
    """Panels of the sizes of both errors over V², by case."""
    for key, name in (("excess error", "V² - c0²"), ("fwhm error", "FWHM")):
        curves = []
        for case in dict.fromkeys(row["case"] for row in rows):
            those = [row for row in rows if row["case"] == case]
            x = [row["square theory"] for row in those]
            curves.append(Curve(case, x, [abs(row[key]) for row in those], "o-"))
        yield Panel("V²", f"|error of {name}|", tuple(curves), "y")


if __name__ == "__main__":
    links.main()
