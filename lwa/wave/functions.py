"""Source text of programs: a wave's β, widths, speed, amplitude and profile as plain functions.

The formulas are written in forms that keep their digits in floating point:

- sums that hold k are polynomials in k - 2, an exact number, in which less cancels than in k;
- arccos(2^{-x}) = arctan √(2^{x+1} sinh(x ln 2)), good as x → 0;
- ln f = 2 arsinh((f-1)/(2√f)), f = V²/B^{k-1}, good as f → 1, that is as k → 1;
- cos(βξ) on the support and 0 outside of it is sin((h + |h|)/2), h = π/2 - |βξ|.

The functions have relative errors of 1e-14, with three exceptions, which are ill-conditioned. The
amplitude's exponent 2/(k-1) makes each rounding |ln B| times larger. Near the edge of the domain of
waves (G + H + I → 0, V² → 0) the last digit of k or of a mass changes the result by more. Near the
end of the support the last digit of ξ does: the profile is right to 1e-14 B at a ξ off by 1e-14 ξ.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

import sympy as sp

from lwa.base.exact import one_of
from lwa.base.quantities import QUANTITIES, strain_power
from lwa.cell import Cell
from lwa.code import LANGUAGES, Function, Local
from lwa.law import ContactLaw, Power
from lwa.wave.closed import CompactWave

_XI = sp.Dummy("xi", real=True)
_B, _V, _F = (sp.Dummy(name, positive=True) for name in ("B", "V_s", "F"))
OWN = (_XI, _B, _V, _F)
_SHIFT, _INSIDE = (sp.Dummy(name, real=True) for name in ("k_2", "h"))
_LONGEST_SUM = 64

_TITLE = (
    "The compact traveling wave v = u_x = B cos^m(beta xi), m = 2/(k - 1),",
    "xi = x - V_s tau, |xi| <= pi/(2 beta), written by lwa. There is one where",
    "k > 1, G + H + I > 0 and V_s^2 > 0, which is not checked here.",
)
_LOADED_TITLE = (
    "Waves u_x = p0 + v(xi), xi = x - V_s tau, whose strain rises from p0 by B,",
    "written by lwa. They exist where V_s^2 > 0 grows with B, which is not checked.",
)
_STRAIN_DOC = "B of the wave whose contact force peaks at F"
_FORCE_DOC = "dx/dt, in m/s for a chain in SI, of the wave whose force peaks at F"
_SCALE_DOC = "tau/t: dx/dt = V_s tau/t"
_LOADED_DOCS = {
    "speed": "V_s = dx/dtau; loses digits as B/p0 falls: kdv_speed is for small B",
    "time_scale": _SCALE_DOC,
    "sound_speed": "V_s of long small waves",
    "kdv_speed": "V_s of a small wave",
    "kdv_width": "L of a small wave v = B sech^2(xi/L)",
}


def wave_code(wave: CompactWave, language: str) -> str:
    """The source text of `wave_functions` in one of the `LANGUAGES`.

    In Python the functions of the paper's reduction, `reduction_functions`, are added.

    Raises `lwa.InputError` for another language.
    """
    one_of(language, LANGUAGES, "language")
    functions = wave_functions(wave)
    if language == "python":
        functions |= reduction_functions(wave, functions["amplitude"])
    return LANGUAGES[language](list(functions.values()), OWN).module(_TITLE)


def loaded_code(
    cell: Cell, law: ContactLaw, p0: sp.Expr, forms: Mapping[str, sp.Expr], language: str
) -> str:
    """The source text of `loaded_functions` in one of the `LANGUAGES`.

    Raises `lwa.InputError` for another language.
    """
    one_of(language, LANGUAGES, "language")
    functions = loaded_functions(cell, law, p0, forms)
    return LANGUAGES[language](list(functions.values()), OWN).module(_LOADED_TITLE)


def wave_functions(wave: CompactWave) -> dict[str, Function]:
    """Functions for β, width, FWHM, speed, amplitude and profile, by name.

    Arguments stand in this order, each where it is used: xi; B or V_s; the symbols of k, of the
    masses, of the stiffnesses and of the spacing.
    """
    k, f, define = wave.k, wave.speed_factor, _functions_of(wave)
    parts = {k - 2: _SHIFT}
    S, excess = _stable(wave.dispersion, k, parts), _stable(sp.factor(sp.cancel(f - 1)), k, parts)
    f = _stable(f, k, parts)
    local = tuple((symbol, value) for value, symbol in parts.items())
    beta_value = (k - 1) / (2 * wave.D * sp.sqrt(S))
    beta = define("beta", "beta = (k - 1)/(2 sqrt(G + H + I))", beta_value, local)
    functions = [beta, define("width", "Length of the support, pi/beta", sp.pi / beta.call)]
    for quantity in QUANTITIES:
        doc = f"Full width at half maximum of the {quantity}"
        angle = _half_angle((k - 1) / (2 * strain_power(quantity, k)))
        functions.append(define(f"fwhm_{quantity}", doc, 2 * angle / beta.call))
    speed = sp.sqrt(f) * _B ** ((k - 1) / 2)
    amplitude = _V ** (2 / (k - 1)) * sp.exp(-2 * sp.asinh(excess / (2 * sp.sqrt(f))) / (k - 1))
    profile = _B * sp.sin((_INSIDE + sp.Abs(_INSIDE)) / 2) ** (2 / (k - 1))
    inside = sp.pi / 2 - sp.Abs(beta.call * _XI)
    functions += [
        define("speed", "V_s = dx/dtau of the wave whose strain peaks at B", speed, local),
        define("amplitude", "B, the peak strain of the wave of speed V_s", amplitude, local),
        define("profile", "v at xi, 0 outside of the support", profile, ((_INSIDE, inside),)),
    ]
    strain = define("strain", _STRAIN_DOC, _strain(wave.cell, k))
    scale = define("time_scale", _SCALE_DOC, wave.cell.time_scale(k))
    in_time = functions[5].call.subs(_B, strain.call) * scale.call
    functions += [scale, strain, define("speed_at_force", _FORCE_DOC, in_time)]
    return {function.name: function for function in functions}


def loaded_functions(
    cell: Cell, law: ContactLaw, p0: sp.Expr, forms: Mapping[str, sp.Expr]
) -> dict[str, Function]:
    """The closed forms of a wave under load, and under a power law its speed at a force, by name.

    forms : expressions by their names in `_LOADED_DOCS`; B is the rise of the strain.

    Arguments stand in this order, each where it is used: B; F; p0; the symbols of the law, of the
    masses, of the stiffnesses and of the spacing.
    """
    parts = (p0, *law.symbols, *cell.masses, *cell.stiffnesses, cell.spacing)
    define = partial(function_of, in_order(*parts))
    functions = {
        name: define(
            name,
            _LOADED_DOCS[name],
            value.xreplace({s: _B for s in value.free_symbols if s.name == "B"}),
        )
        for name, value in forms.items()
    }
    if law.homogeneous:
        strain = define("strain", _STRAIN_DOC, _strain(cell, law.exponent) - p0)
        in_time = functions["speed"].call.subs(_B, strain.call) * functions["time_scale"].call
        functions |= {
            "strain": strain,
            "speed_at_force": define("speed_at_force", _FORCE_DOC, in_time),
        }
    return functions


def _strain(cell: Cell, k: sp.Expr) -> sp.Expr:
    """The strain at which the contacts of a cell push with F."""
    return Power(k).compression(cell, _F) / cell.spacing


def reduction_functions(wave: CompactWave, amplitude: Function) -> dict[str, Function]:
    """The p, a, μ, η, σ, s of the paper's `Reduction` and its amplitude B, by name."""
    found, define = wave.reduction(V=_V), _functions_of(wave)
    doc = "{} of the reduction v = z^p, z'' = mu z^eta - sigma z"
    p = define("p", doc.format("p"), found.p)
    a = define("a", doc.format("a"), found.a.subs(found.p, p.call))
    found = replace(found, p=p.call, a=a.call)
    rest = [define(n, doc.format(n), getattr(found, n)) for n in ("mu", "eta", "sigma", "s")]
    functions = (p, a, *rest, define("B", amplitude.doc, amplitude.call))
    return {function.name: function for function in functions}


def _functions_of(wave: CompactWave) -> Callable[..., Function]:
    cell = wave.cell
    parts = (wave.k, *cell.masses, *cell.stiffnesses, cell.spacing, wave.dispersion)
    return partial(function_of, in_order(*parts))


def in_order(*parts: sp.Expr) -> tuple[sp.Symbol, ...]:
    """Symbols of the parts, in the order of the parts and by name within a part."""
    return tuple(dict.fromkeys(s for part in parts for s in sorted(part.free_symbols, key=str)))


def function_of(
    order: tuple[sp.Symbol, ...], name: str, doc: str, value: sp.Basic, local: Local = ()
) -> Function:
    """A function with the arguments and local variables that its value depends on."""
    used = value.free_symbols
    for symbol, part in reversed(local):
        used |= part.free_symbols if symbol in used else set()
    arguments = tuple(s for s in (*OWN, *order) if s in used)
    return Function(name, doc, arguments, value, tuple(row for row in local if row[0] in used))


def _half_angle(x: sp.Expr) -> sp.Expr:
    """The angle arccos(2^{-x}), in a form that keeps its digits as x → 0."""
    return sp.atan(sp.sqrt(2 ** (x + 1) * sp.sinh(x * sp.log(2))))


def _stable(ratio: sp.Expr, k: sp.Expr, parts: dict[sp.Expr, sp.Symbol]) -> sp.Expr:
    """Rewrite the sums of a rational expression in powers of k - 2.

    New local variables are added to ``parts``: A^{1/k}, and pieces of a sum too long for one
    statement (Fortran takes 256 lines).
    """

    def part(value: sp.Expr, name: str) -> sp.Symbol:
        symbol = sp.Dummy(f"{name}_{len(parts)}", positive=name == "r" or None)
        return parts.setdefault(value, symbol)

    def root(power: sp.Pow) -> sp.Expr:
        n, _ = (power.exp * k).as_coeff_Mul()
        return part(power.base ** (power.exp / n), "r") ** n

    def about_two(total: sp.Expr) -> sp.Expr:
        terms = sp.Poly(total.subs(k, _SHIFT + 2), _SHIFT).terms()
        return sp.Add(*(sp.factor(c) * _SHIFT**n for (n,), c in terms))

    def pieces(total: sp.Expr) -> sp.Expr:
        n = range(0, len(total.args), _LONGEST_SUM)
        return sp.Add(*(part(sp.Add(*total.args[i : i + _LONGEST_SUM]), "sum") for i in n))

    if k.is_Symbol:
        ratio = ratio.replace(lambda e: e.is_Pow and e.exp.has(k), root)
        ratio = ratio.replace(lambda e: e.is_Add and e.has(k) and not (e - k).is_number, about_two)
    return ratio.replace(lambda e: e.is_Add and len(e.args) > _LONGEST_SUM, pieces)
