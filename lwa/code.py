"""A wave as the source of a program: β, widths, speed, amplitude and profile as plain functions.

What is written are not the formulas as they stand but forms of them that keep their digits:

- sums that hold k and other symbols are polynomials in k - 2, which is exact where they cancel;
- arccos(2^{-x}) = arctan √(2^{x+1} sinh(x ln 2)), good as x → 0;
- ln f = 2 artanh((f-1)/(f+1)), f = V²/B^{k-1}, good as f → 1, that is as k → 1;
- cos(βξ) on the support and 0 outside of it is sin((h + |h|)/2), h = π/2 - |βξ|.

So the functions are good to 1e-14, relatively, but for three things that no arrangement mends. The
amplitude's exponent 2/(k-1) makes each rounding |ln B| times larger. Near the edge of the domain of
a wave (G + H + I → 0, V² → 0) a last digit of k or a mass is more than that. And so it is of ξ near
the end of the support: the profile is good to 1e-14 B at a ξ that is off by 1e-14 of itself.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import sympy as sp

from lwa.exact import InputError, shorten
from lwa.languages import LANGUAGES, Function
from lwa.quantities import QUANTITIES, strain_power

if TYPE_CHECKING:
    from lwa.wave import TravelingWave

_XI = sp.Dummy("xi", real=True)
_B, _V = (sp.Dummy(name, positive=True) for name in ("B", "V_s"))
OWN = (_XI, _B, _V)

_TITLE = (
    "The compact traveling wave v = u_x = B cos^m(beta xi), m = 2/(k - 1),",
    "xi = x - V_s tau, |xi| <= pi/(2 beta), written by lwa. There is one where",
    "k > 1, G + H + I > 0 and V_s^2 > 0, which is not checked here.",
)


def wave_code(wave: TravelingWave, language: str) -> str:
    """The source text of `wave_functions` in one of the `LANGUAGES`.

    Python has those of the paper's reduction, `reduction_functions`, besides.

    Raises `lwa.InputError` for another language.
    """
    if language not in LANGUAGES:
        raise InputError(
            f"language is {shorten(language)}: one of {', '.join(LANGUAGES)} is wanted"
        )
    functions = wave_functions(wave)
    if language == "python":
        functions |= reduction_functions(wave, functions["amplitude"])
    return LANGUAGES[language](list(functions.values()), OWN).module(_TITLE)


def wave_functions(wave: TravelingWave) -> dict[str, Function]:
    """β, width, FWHM, speed, amplitude and profile, by name.

    Arguments stand in this order, each where it is used: xi; B or V_s; the symbols of k, of the
    masses, of the stiffnesses and of the spacing.
    """
    k, f = wave.k, wave.speed_factor
    S, S_local = _stable(wave.dispersion, k)
    f_stable, f_local = _stable(f, k)
    y, y_local = _stable(sp.factor(sp.cancel((f - 1) / (f + 1))), k)
    order = _symbols(wave)

    beta = function_of(
        order, "beta", "beta = (k - 1)/(2 sqrt(G + H + I))",
        (k - 1) / (2 * wave.D * sp.sqrt(S)), S_local,
    )  # fmt: skip
    h = sp.Dummy("inside", real=True)
    functions = [
        beta,
        function_of(order, "width", "The length of the support, pi/beta", sp.pi / beta.call),
        *(
            function_of(
                order,
                f"fwhm_{quantity}",
                f"Full width at half maximum of the {quantity}",
                2 * _half_angle((k - 1) / (2 * strain_power(quantity, k))) / beta.call,
            )
            for quantity in QUANTITIES
        ),
        function_of(
            order, "speed", "V_s of the wave whose strain peaks at B",
            sp.sqrt(f_stable) * _B ** ((k - 1) / 2), f_local,
        ),
        function_of(
            order, "amplitude", "B, the peak strain of the wave of speed V_s",
            _V ** (2 / (k - 1)) * sp.exp(-2 * sp.atanh(y) / (k - 1)), y_local,
        ),
        function_of(
            order, "profile", "v(xi), 0 outside of the support",
            _B * sp.sin((h + sp.Abs(h)) / 2) ** (2 / (k - 1)),
            ((h, sp.pi / 2 - sp.Abs(beta.call * _XI)),),
        ),
    ]  # fmt: skip
    return {function.name: function for function in functions}


def reduction_functions(wave: TravelingWave, amplitude: Function) -> dict[str, Function]:
    """p, a, μ, η, σ, s of `Reduction` as the paper writes them, and B, the amplitude again."""
    found, order = wave.reduction(V=_V), _symbols(wave)
    doc = "{} of the reduction v = z^p, z'' = mu z^eta - sigma z"
    p = function_of(order, "p", doc.format("p"), found.p)
    a = function_of(order, "a", doc.format("a"), found.a.subs(found.p, p.call))
    found = replace(found, p=p.call, a=a.call)
    functions = [p, a]
    functions += [
        function_of(order, name, doc.format(name), getattr(found, name))
        for name in ("mu", "eta", "sigma", "s")
    ]
    functions.append(function_of(order, "B", amplitude.doc, amplitude.call))
    return {function.name: function for function in functions}


def _symbols(wave: TravelingWave) -> tuple[sp.Symbol, ...]:
    cell = wave.cell
    parts = (wave.k, *cell.masses, *cell.stiffnesses, cell.spacing, wave.dispersion)
    return in_order(*parts)


def in_order(*parts: sp.Expr) -> tuple[sp.Symbol, ...]:
    """Their symbols, those of the first part first, by name within a part."""
    return tuple(dict.fromkeys(s for part in parts for s in sorted(part.free_symbols, key=str)))


def function_of(
    order: tuple[sp.Symbol, ...],
    name: str,
    doc: str,
    value: sp.Basic,
    local: tuple[tuple[sp.Symbol, sp.Expr], ...] = (),
) -> Function:
    used = set().union(value.free_symbols, *(v.free_symbols for _, v in local))
    return Function(name, doc, tuple(s for s in (*OWN, *order) if s in used), value, local)


def _half_angle(x: sp.Expr) -> sp.Expr:
    """arccos(2^{-x})."""
    return sp.atan(sp.sqrt(2 ** (x + 1) * sp.sinh(x * sp.log(2))))


def _stable(ratio: sp.Expr, k: sp.Expr) -> tuple[sp.Expr, tuple[tuple[sp.Symbol, sp.Expr], ...]]:
    """A rational expression, sums in powers of k - 2 and each A^{1/k} computed once."""
    if not k.is_Symbol:
        return ratio, ()
    shift = sp.Dummy("k_2", real=True)
    roots: dict[sp.Expr, sp.Symbol] = {}

    def root(power: sp.Pow) -> sp.Expr:
        n, _ = (power.exp * k).as_coeff_Mul()
        one = power.base ** (power.exp / n)
        return roots.setdefault(one, sp.Dummy(f"r_{len(roots) + 1}", positive=True)) ** n

    def about_two(total: sp.Expr) -> sp.Expr:
        terms = sp.Poly(total.subs(k, shift + 2), shift).terms()
        return sp.Add(*(sp.factor(c) * shift**n for (n,), c in terms))

    ratio = ratio.replace(lambda e: e.is_Pow and e.exp.has(k), root)
    ratio = ratio.replace(lambda e: e.is_Add and e.has(k) and not (e - k).is_number, about_two)
    local = [(symbol, value) for value, symbol in roots.items()]
    local += [(shift, k - 2)] if ratio.has(shift) else []
    return ratio, tuple(local)
