"""A theory and its wave as text, JSON, LaTeX or Python source; all four from the same objects."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import sympy as sp

from lwa.exact import InputError
from lwa.pde import Jet, Terms, base_order
from lwa.theory import Theory
from lwa.wave import QUANTITIES, TravelingWave

FORMATS = ("text", "json", "latex", "python")
DIGITS = 15
"""Significant digits of a printed number; all of them are correct."""


def third_order(theory: Theory) -> dict[str, sp.Expr]:
    """G, H and I, or {} where the theory does not reach them (order < 4, or optical)."""
    try:
        return {"G": theory.pde.G, "H": theory.pde.H, "I": theory.pde.I}
    except InputError:
        return {}


def wave_values(wave: TravelingWave) -> dict[str, sp.Expr]:
    """The wave's closed forms by the names of the paper, for its root p and the symbols V_s, B."""
    reduction = wave.reduction()
    return {
        "beta": wave.beta,
        "p": reduction.p,
        "a": reduction.a,
        "mu": reduction.mu,
        "eta": reduction.eta,
        "sigma": reduction.sigma,
        "s": reduction.s,
        "B": wave.amplitude(),
        "width": wave.width,
        "speed": wave.speed(),
    }


# --- JSON ------------------------------------------------------------------------------------


def theory_json(theory: Theory) -> dict[str, Any]:
    """The object that `lwa derive --format json` prints."""
    found = third_order(theory)
    return {
        **_chain_json(theory),
        "lambda": str(theory.amplitude_ratio),
        "ansatz": {str(n): str(b) for n, b in theory.ansatz.items()},
        **{name: str(found[name]) if found else None for name in "GHI"},
        "terms": _terms_json(theory.pde.coefficients),
        "vanishing": list(theory.pde.vanishing),
        "defect": _terms_json(theory.defect),
        "conservative": theory.pde.conservative,
    }


def wave_json(theory: Theory, wave: TravelingWave) -> dict[str, Any]:
    """The object that `lwa wave --format json` prints.

    Names ending in ``_value`` are floats, there when k and the masses are numbers: with the
    spacing as the unit of length where it is a symbol, at V_s = 1 (B, mu) and B = 1 (speed).
    What is complex or beyond a float has no such value.
    """
    values = wave_values(wave)
    fwhm = {quantity: wave.fwhm(quantity) for quantity in QUANTITIES}
    roots = [wave.reduction(root) for root in (0, 1)]
    result: dict[str, Any] = {
        **_chain_json(theory),
        **{name: str(value) for name, value in values.items()},
        "fwhm": {quantity: str(value) for quantity, value in fwhm.items()},
        "roots": [
            {name: str(getattr(r, name)) for name in ("p", "a", "mu", "eta", "sigma", "s")}
            for r in roots
        ],
        "speed_factor": str(wave.speed_factor),
        "time_scale": str(wave.speed_scale),
    }
    for name, value in values.items():
        _put(result, f"{name}_value", _float(_in_units(wave, value)))
    widths = {quantity: _float(_in_units(wave, value)) for quantity, value in fwhm.items()}
    if None not in widths.values():
        result["fwhm_value"] = widths
    _put(result, "log_B_value", _float(-sp.log(wave.speed_factor) / (wave.k - 1)))
    return result


def _chain_json(theory: Theory) -> dict[str, Any]:
    return {
        "k": str(theory.k),
        "masses": [str(m) for m in theory.cell.masses],
        "stiffnesses": [str(A) for A in theory.cell.stiffnesses],
        "spacing": str(theory.cell.spacing),
        "order": theory.order,
        "closure": theory.closure.name,
        "branch": theory.closure.ring.branch,
    }


def _terms_json(coefficients: Mapping[int, Terms]) -> list[dict[str, Any]]:
    return [
        {
            "order": n,
            "jet": [list(power) for power in jet.x],
            "jet_t": [list(power) for power in jet.t],
            "coefficient": str(found[jet]),
        }
        for n, found in coefficients.items()
        for jet in found
    ]


def _put(result: dict[str, Any], name: str, value: float | None) -> None:
    if value is not None:
        result[name] = value


def _in_units(wave: TravelingWave, value: sp.Expr) -> sp.Expr:
    """With V_s = B = 1, and D = 1 where it is a symbol."""
    ones = {s: 1 for s in value.free_symbols if s.name in ("V_s", "B")}
    if wave.D.is_Symbol:
        ones[wave.D] = 1
    return value.xreplace(ones)


def _float(value: sp.Expr) -> float | None:
    """The nearest float of an exact number, None for what is symbolic, complex or out of range."""
    if value.free_symbols:
        return None
    number = sp.N(value, 30)
    if not number.is_real or not (number == 0 or 1e-300 < abs(number) < 1e300):
        return None
    return float(number)


# --- text ------------------------------------------------------------------------------------


def theory_text(theory: Theory) -> str:
    """What `lwa derive` prints for people."""
    acoustic = theory.closure.ring.branch == "acoustic"
    lines = [
        f"masses {', '.join(map(str, theory.cell.masses))}; contact force F = A δ^k, "
        f"k = {theory.k}; spacing D = {theory.cell.spacing}",
        f"closure {theory.closure.name}, {theory.closure.ring.branch} branch, "
        f"to D^{theory.order} in the ansatz; τ = t·{theory.pde.time_scale}",
        "",
    ]
    if theory.ansatz:
        lines += ["w = λ (u + Σ b_n D^n ∂_x^n u)", f"  λ = {theory.amplitude_ratio}"]
        lines += [f"  b{n} = {b}" for n, b in theory.ansatz.items()]
        lines.append("")
    found = third_order(theory)
    if found:
        lines.append(
            "u_ττ = u_x^(k-1) u_xx + G u_x^(k-3) u_xx^3 + H u_x^(k-2) u_xx u_xxx + I u_x^(k-1) u_4x"
            + (" + …" if theory.order > 4 else "")
        )
        lines += [f"  {name} = {value}" for name, value in found.items()]
    elif acoustic and theory.order == 1:
        lines.append("the wave equation starts at D^(k+1), that is at order 2 of the ansatz")
    elif acoustic:
        lines.append("u_ττ = u_x^(k-1) u_xx" + (" + …" if theory.order > 2 else ""))
    else:
        lines.append(
            "u_ττ = -u^k + u^k Σ D^n …   (contacts that also pull: the odd law |δ|^(k-1) δ)"
        )
    shown = {n: c for n, c in theory.pde.coefficients.items() if c and not (found and n == 3)}
    lines += _terms_text(theory, shown)
    vanishing = ", ".join(_order_name(theory, n) for n in theory.pde.vanishing)
    if vanishing:
        lines.append(f"  vanishing identically: {vanishing}")
    lines += ["", *_consistency_text(theory)]
    return "\n".join(lines)


def _consistency_text(theory: Theory) -> list[str]:
    if not theory.defect:
        lines = ["both equations of motion are satisfied at every order shown"]
    else:
        lines = ["defect: u_ττ by the first equation of motion minus u_ττ by the second"]
        lines += _terms_text(theory, theory.defect)
    if theory.closure.ring.branch == "acoustic" and not theory.pde.conservative:
        lines.append(
            "the equation is not in conservation form: for unequal particles the linear closure "
            "does not conserve momentum"
        )
    return lines


def _order_name(theory: Theory, n: int) -> str:
    return f"D^(k+{n})" if theory.closure.ring.branch == "acoustic" else f"D^{n}"


def _terms_text(theory: Theory, coefficients: Mapping[int, Terms]) -> list[str]:
    lines = []
    for n, found in coefficients.items():
        lines.append(f"  {_order_name(theory, n)}:")
        lines += [f"    {_jet_text(theory, jet)}: {found[jet]}" for jet in found]
    return lines


def _jet_text(theory: Theory, jet: Jet) -> str:
    """The monomial of a jet as it stands in the equation, such as u_x^(k-3) u_xx^3."""
    base, degree = "u_x" if base_order(theory.closure) else "u", sum(e for _, e in jet.x)
    velocities = sum(e for _, e in jet.t)
    power = f"k-{degree}" + (f"-{velocities // 2}(k+1)" if velocities else "")
    factors = [f"u_{i}x" + (f"^{e}" if e > 1 else "") for i, e in jet.x]
    factors += [f"u_{i}xτ" + (f"^{e}" if e > 1 else "") for i, e in jet.t]
    return " ".join([f"{base}^({power})", *factors])


def wave_text(theory: Theory, wave: TravelingWave) -> str:
    """What `lwa wave` prints for people."""
    values = wave_values(wave)
    other = wave.reduction(1)
    lines = [
        f"masses {', '.join(map(str, theory.cell.masses))}; k = {wave.k}; closure "
        f"{theory.closure.name}; v = u_x = B cos^(2/(k-1))(β ξ), ξ = x - V_s τ, on |ξ| ≤ π/(2β)",
        "",
        *_lines(wave, {"β": values["beta"], "width π/β": values["width"]}),
        *_lines(wave, {f"FWHM of the {q}": wave.fwhm(q) for q in QUANTITIES}),
        f"  B = {values['B']}",
        f"  V_s = {values['speed']}",
        f"  F_m ∝ V_s^({wave.force_exponent});  dx/dt = V_s · {wave.speed_scale}",
        "",
        "v = z^p, integrating factor z^a: z'' = μ z^η - σ z",
        *_lines(wave, {name: values[name] for name in ("p", "a", "mu", "eta", "sigma", "s")}),
        *_lines(wave, {"the other root, p": other.p, "with a": other.a}),
    ]
    return "\n".join(lines)


def _lines(wave: TravelingWave, values: dict[str, sp.Expr]) -> list[str]:
    lines = []
    for name, value in values.items():
        measure = _in_units(wave, value)
        exact = measure.free_symbols or measure.is_Rational or not measure.is_number
        number = "" if exact else f" ≈ {sp.N(measure, DIGITS)}"
        unit = _unit(wave, value) if number else ""
        lines.append(f"  {name} = {value}{number}{unit}")
    return lines


def _unit(wave: TravelingWave, value: sp.Expr) -> str:
    if wave.D not in value.free_symbols:
        return ""
    power = sp.degree(sp.numer(value), wave.D) - sp.degree(sp.denom(value), wave.D)
    return f" {wave.D}" if power == 1 else f" {wave.D}^{power}"


# --- LaTeX -----------------------------------------------------------------------------------


def theory_latex(theory: Theory) -> str:
    """The ansatz and the wave equation as LaTeX, one display line each."""
    rows = [_equation(sp.Symbol("lambda"), theory.amplitude_ratio)]
    rows += [_equation(sp.Symbol(f"b_{n}"), b) for n, b in theory.ansatz.items()]
    rows += [_equation(sp.Symbol(name), value) for name, value in third_order(theory).items()]
    x = sp.Symbol("x")
    right = theory.pde.right_side(sp.Function("u")(x), x)
    rows.append(rf"u_{{\tau\tau}} = {sp.latex(right)}")
    return _align(rows)


def wave_latex(theory: Theory, wave: TravelingWave) -> str:
    """The wave's closed forms as LaTeX."""
    names = {"width": "L", "speed": "V_s"}
    rows = [_equation(sp.Symbol(names.get(n, n)), value) for n, value in wave_values(wave).items()]
    rows += [_equation(sp.Symbol(f"FWHM_{q}"), wave.fwhm(q)) for q in QUANTITIES]
    return _align(rows)


def _equation(name: sp.Symbol, value: sp.Expr) -> str:
    return f"{sp.latex(name)} = {sp.latex(value)}"


def _align(rows: list[str]) -> str:
    body = " \\\\\n".join(row.replace("=", "&=", 1) for row in rows)
    return f"\\begin{{align}}\n{body}\n\\end{{align}}"


# --- Python source ---------------------------------------------------------------------------


def theory_python(theory: Theory) -> str:
    """A module of functions: b1 …, G, H, I, and all coefficients by order and jet."""
    functions = {f"b{n}": b for n, b in theory.ansatz.items()} | third_order(theory)
    table = {n: {jet: found[jet] for jet in found} for n, found in theory.pde.coefficients.items()}
    symbols = _symbols([c for found in table.values() for c in found.values()])
    rows = [f"def coefficients({symbols}):", f'    """{_TABLE}"""', "    return {"]
    for n, found in table.items():
        rows.append(f"        {n}: {{")
        rows += [f"            {tuple(jet)}: {sp.pycode(value)}," for jet, value in found.items()]
        rows.append("        },")
    return _module(functions, [*rows, "    }"])


_TABLE = "{n: {(jet, jet_t): coefficient}} of the orders D^(k+n), without the power of D."


def wave_python(theory: Theory, wave: TravelingWave) -> str:
    """A module of functions: beta, p, a, …, B(V_s), speed(B), fwhm_strain, …"""
    functions = {**wave_values(wave), **{f"fwhm_{q}": wave.fwhm(q) for q in QUANTITIES}}
    return _module(functions, [])


def _symbols(values: list[sp.Expr]) -> str:
    return ", ".join(sorted({s.name for value in values for s in value.free_symbols}))


def _module(functions: dict[str, sp.Expr], more: list[str]) -> str:
    blocks = [
        f"def {name}({_symbols([value])}):\n    return {sp.pycode(value)}"
        for name, value in functions.items()
    ]
    if more:
        blocks.append("\n".join(more))
    return "\n\n\n".join(["import math", *blocks])


THEORY: dict[str, Callable[[Theory], Any]] = {
    "text": theory_text,
    "json": theory_json,
    "latex": theory_latex,
    "python": theory_python,
}
WAVE: dict[str, Callable[[Theory, TravelingWave], Any]] = {
    "text": wave_text,
    "json": wave_json,
    "latex": wave_latex,
    "python": wave_python,
}
