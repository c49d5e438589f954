"""A theory and its wave as text for people."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from string import ascii_lowercase

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.quantities import QUANTITIES
from lwa.command.document import in_units, wave_values
from lwa.equation.terms import Jet, Terms
from lwa.expansion.approximants import Resummed
from lwa.expansion.expand import Expansion
from lwa.expansion.physical import ExpandedWave
from lwa.expansion.series import EpsilonSeries
from lwa.law import Law, Power
from lwa.linear.dispersion import Dispersion
from lwa.theory import Theory
from lwa.wave.traveling import TravelingWave

DIGITS = 15
"""Significant digits of a printed number; all of them are correct."""


def theory_text(theory: Theory) -> str:
    """What `lwa derive` prints."""
    ring = theory.closure.ring
    lines = [
        _chain_text(theory),
        f"closure {theory.closure.name}, {ring.branch} branch, to D^{theory.order}; "
        f"τ = t·{theory.pde.time_scale}",
        _FIELDS[theory.closure.field],
        *_law_text(theory),
        "",
        *_ansatz_text(theory),
        *_equation_text(theory),
        "",
        *_consistency_text(theory),
    ]
    return "\n".join(lines)


def chain_text(theory: Theory) -> list[str]:
    """What a chain, its law and its field are."""
    return [_chain_text(theory), _FIELDS[theory.closure.field]]


def _chain_text(theory: Theory) -> str:
    law, cell = theory.law, theory.cell
    force = f"A δ^k, k = {law.k}" if isinstance(law, Power) else f"A F({law.delta}), F = {law.F}"
    return (
        f"masses {_list(cell.masses)}; contact force F = {force}, "
        f"A = {_list(cell.stiffnesses)}; spacing D = {cell.spacing}"
    )


def _law_text(theory: Theory) -> list[str]:
    """The φ_n of a law that is no power."""
    law = theory.law
    if isinstance(law, Power):
        return []
    lines = [f"phi_n = {law.delta}^(n-1) F^(n)/F', at {law.delta} = D u_x; F' is taken there"]
    orders = () if law.formless else range(2, max(theory.order, 3))
    return lines + [f"  phi{n} = {law.phi(n)}" for n in orders]


_FIELDS = {
    "first": "u is the displacement of the cell's first particle",
    "center": "u is the canonical field, the mass-weighted mean of the fields at one point",
}


def _ansatz_text(theory: Theory) -> list[str]:
    blocks: list[list[str]] = []
    for i, series in theory.slaved.items():
        w = i == 1  # the second particle's field, whose linear part is the ansatz
        shown = {n: W.without(_is_linear) if w else W for n, W in series.items()}
        rows = _orders(shown, "D^", "")
        if rows:
            name = "nonlinear terms of w" if w else f"field of particle {i + 1}, less u"
            blocks.append([f"{name}:", *rows, ""])
    if theory.ansatz:
        ansatz = ["w = λ (u + Σ b_n D^n ∂_x^n u), the linear part of the second particle's field"]
        ansatz.append(f"  λ = {theory.amplitude_ratio}")
        ansatz += [f"  b{n} = {b}" for n, b in theory.ansatz.items()]
        blocks.insert(0, [*ansatz, ""])
    return [line for block in blocks for line in block]


def _is_linear(jet: Jet) -> bool:
    return not jet.t and sum(e for _, e in jet.x) <= 1


def _equation_text(theory: Theory) -> list[str]:
    acoustic = theory.closure.ring.branch == "acoustic"
    found = theory.pde.third_order
    more = " + …"
    if isinstance(theory.law, Law) and found:
        lines = [
            "u_ττ = F' u_xx + G F' u_x^-2 u_xx^3 + H F' u_x^-1 u_xx u_xxx + I F' u_4x"
            + (more if theory.order > 4 else "")
        ]
        lines += [f"  {name} = {value}" for name, value in found.items()]
    elif isinstance(theory.law, Law):
        lines = ["u_ττ = F' u_xx + …"]
    elif found:
        lines = [
            "u_ττ = u_x^(k-1) u_xx + G u_x^(k-3) u_xx^3 + H u_x^(k-2) u_xx u_xxx + I u_x^(k-1) u_4x"
            + (more if theory.order > 4 else "")
        ]
        lines += [f"  {name} = {value}" for name, value in found.items()]
    elif not acoustic:
        lines = ["u_ττ = -u^k + …   (contacts that also pull: the odd law |δ|^(k-1) δ)"]
    elif theory.order == 1:
        lines = ["the wave equation starts at D^(k+1), that is at order 2 of the ansatz"]
    else:
        lines = ["u_ττ = u_x^(k-1) u_xx" + (more if theory.order > 2 else "")]
    prefix, suffix = _order_name(theory)
    shown = {n: c for n, c in theory.pde.coefficients.items() if not (found and n == 3)}
    lines += _orders(shown, prefix, suffix)
    vanishing = ", ".join(f"{prefix}{n}{suffix}" for n in theory.pde.vanishing)
    return [*lines, f"  vanishing identically: {vanishing}"] if vanishing else lines


def _order_name(theory: Theory) -> tuple[str, str]:
    """What stands before and behind the n of an order: the power of D where there is one."""
    if isinstance(theory.law, Law):
        return "order ", ""
    return ("D^(k+", ")") if theory.closure.ring.branch == "acoustic" else ("D^", "")


def _consistency_text(theory: Theory) -> list[str]:
    if not theory.defect:
        lines = ["all equations of motion are satisfied at every order shown"]
    else:
        lines = ["defect: u_ττ by the first equation of motion minus u_ττ by the second"]
        lines += _orders(theory.defect, *_order_name(theory))
    if theory.closure.ring.branch == "acoustic" and not theory.pde.conservative:
        lines.append(
            "not in conservation form: the linear closure of unequal particles does not conserve "
            "momentum; see --closure full"
            if theory.closure.name == "linear"
            else "not in conservation form in this field; see --field center"
        )
    return lines


def _orders(coefficients: Mapping[int, Terms], prefix: str, suffix: str) -> list[str]:
    lines = []
    for n, found in coefficients.items():
        rows = [f"    {found.text(jet)}: {found.written(jet)}" for jet in found]
        lines += [f"  {prefix}{n}{suffix}:", *rows] if rows else []
    return lines


def _list(values: tuple[sp.Expr, ...]) -> str:
    return ", ".join(map(str, values))


def wave_text(theory: Theory, wave: TravelingWave) -> str:
    """What `lwa wave` prints."""
    values = wave_values(wave)
    other = wave.reduction(1)
    lines = [
        f"masses {_list(theory.cell.masses)}; k = {wave.k}; closure {theory.closure.name}; "
        + _FIELDS[theory.closure.field],
        "v = u_x = B cos^(2/(k-1))(β ξ), ξ = x - V_s τ, on |ξ| ≤ π/(2β)",
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


def force_text(theory: Theory, wave: TravelingWave, F: sp.Expr, units: Mapping[str, str]) -> str:
    """What `lwa wave --force F` prints; ``units``, for spheres, are those of the values."""
    cell, answer = theory.cell, wave.at_force(F)

    def shown(name: str, *values: sp.Expr) -> str:
        numbers = ", ".join(_value(value, bool(units)) for value in values)
        return f"{numbers} {units.get(name, '')}".rstrip()

    return "\n".join(
        [
            f"closure {theory.closure.name}; {_FIELDS[theory.closure.field]}",
            f"contact force F = A δ^k, k = {theory.k}; an endless chain without load",
            f"  masses {shown('masses', *cell.masses)}",
            f"  A = {shown('stiffnesses', *_distinct(cell.stiffnesses))}",
            f"  spacing D = {shown('spacing', cell.spacing)}",
            "",
            f"peak contact force {shown('force', answer.force)}:",
            f"  peak strain B = {shown('strain', answer.strain)}",
            f"  peak compression = {shown('compressions', *_distinct(answer.compressions))}",
            f"  speed dx/dt = {shown('speed', answer.speed)}",
            f"  peak velocity of the beads = {shown('bead_velocity', answer.bead_velocity)}",
            *(
                f"  FWHM of the {q} = {shown('fwhm', answer.fwhm(q))}, in time "
                + shown("fwhm_time", answer.fwhm(q, "time"))
                for q in QUANTITIES
            ),
        ]
    )


def _distinct(values: tuple[sp.Expr, ...]) -> tuple[sp.Expr, ...]:
    """One value where all are the same."""
    return values[:1] if len(set(values)) == 1 else values


def _value(value: sp.Expr, approximate: bool) -> str:
    """A number in digits; an expression in symbols as it is, or with its numbers in digits."""
    factor, rest = value.as_independent(*value.free_symbols, as_Add=False)
    if rest != 1 and not approximate:
        return str(value)
    number = sp.sstr(sp.N(factor, DIGITS), full_prec=False)
    return str(rest) if factor == 1 else number if rest == 1 else f"{number}·{rest}"


def _lines(wave: TravelingWave, values: dict[str, sp.Expr]) -> list[str]:
    lines = []
    for name, value in values.items():
        measure = in_units(wave, value)
        exact = measure.free_symbols or measure.is_Rational
        number = "" if exact else f" ≈ {sp.N(measure, DIGITS)}{_unit(wave, value)}"
        lines.append(f"  {name} = {value}{number}")
    return lines


def _unit(wave: TravelingWave, value: sp.Expr) -> str:
    if not wave.D.is_Symbol or wave.D not in value.free_symbols:
        return ""
    power = value.as_powers_dict()[wave.D]
    return f" {wave.D}" if power == 1 else f" {wave.D}^{power}"


def dispersion_text(chain: Dispersion, order: int) -> str:
    """What `lwa dispersion` prints."""
    lines = [
        f"masses {_list(chain.cell.masses)}, A = {_list(chain.cell.stiffnesses)}; Ω²(κ), κ = qD "
        "and Ω/D the frequency in τ",
        "",
        *_series("acoustic", chain.acoustic(order)),
    ]
    if chain.cell.size == 2:
        lines += _series("optical", chain.optical(order))
    return "\n".join(lines)


def _series(name: str, coefficients: Mapping[int, sp.Expr]) -> list[str]:
    return [f"{name}:", *(f"  {f'κ^{n}' if n else '1'}: {c}" for n, c in coefficients.items())]


def expansion_text(expansion: Expansion, wave: ExpandedWave | None = None) -> str:
    """What `lwa expansion` prints."""
    cell = expansion.cell
    series = {"c²": expansion.c2}
    series |= {f"FWHM of the {q}": expansion.fwhm(q) for q in QUANTITIES}
    lines = [
        f"masses {_list(cell.masses)}; F = A δ^k, A = {_list(cell.stiffnesses)}; ε = k - 1; peak "
        "force 1 on the first contact, lengths in D",
        "",
        *_in_epsilon(
            {**series, "momentum": expansion.momentum, "energy": expansion.energy},
            _letter(expansion),
        ),
    ]
    if expansion.numeric:
        lines += ["", f"at k = {expansion.k}, with estimates of the error:"]
        lines += [f"  {name}{_summed(row.at)}" for name, row in series.items()]
    if wave is not None:
        lines += ["", f"peak contact force {float(wave.F):g}, in the units of the cell:"]
        lines += [f"  speed dx/dt{_summed(lambda: wave.speed)}"]
        for q in QUANTITIES:
            for per, said in (("length", ""), ("time", ", in time")):
                lines += [f"  FWHM of the {q}{said}{_summed(partial(wave.fwhm, q, per))}"]
    return "\n".join(lines)


def _letter(expansion: Expansion) -> str:
    """The first letter a for which no symbol is called a_n, a0, a1, …"""
    names = {s.name for s in (*expansion.cell.symbols, *expansion.k.free_symbols)}
    taken = {name[0] for name in names if name[1:] == "_n" or name[1:].isdecimal()}
    return next(letter for letter in ascii_lowercase if letter not in taken)


def _in_epsilon(series: Mapping[str, EpsilonSeries], a: str) -> list[str]:
    lines = []
    for name, row in series.items():
        factors = [str(row.prefactor)] if row.prefactor != 1 else []
        factors += [f"ε^({row.power})"] if row.power else []
        lines.append(f"{name} = {' '.join([*factors, f'Σ {a}_n ε^n'])}")
        lines += [f"  {a}{n} = {value}" for n, value in enumerate(row.coefficients)]
    return lines


def _summed(sum_up: Callable[[], Resummed]) -> str:
    """A sum to as many digits as the error lets stand, and one more; or why there is none."""
    try:
        found = sum_up()
    except InputError as error:
        return f": {error}"
    digits = min(16, 2 - math.floor(math.log10(found.error / found.value)))
    note = "; higher orders do not help" if found.asymptotic else ""
    return f" = {found.value:.{digits}g} ± {found.error:.1e} (to ε^{found.order}{note})"
