"""A theory and its wave as JSON: the command line's contract with other programs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.quantities import QUANTITIES
from lwa.equation.terms import Terms
from lwa.expansion.expand import Expansion
from lwa.expansion.physical import ExpandedWave
from lwa.expansion.series import EpsilonSeries
from lwa.law import Power
from lwa.linear.dispersion import Dispersion
from lwa.theory import Theory
from lwa.wave.traveling import TravelingWave


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


SI = {
    "masses": "kg",
    "stiffnesses": "N/m^(3/2)",
    "beta": "1/m",
    **dict.fromkeys(("spacing", "width", "fwhm", "compression", "compressions"), "m"),
    "fwhm_time": "s",
    "force": "N",
    **dict.fromkeys(("speed", "bead_velocity", "time_scale"), "m/s"),
}
"""Units of a wave in a chain of spheres; what is not named is a number (τ is a length)."""


def theory_json(theory: Theory) -> dict[str, Any]:
    """The object that `lwa derive --format json` prints.

    ``terms`` are the right-hand side of u_ττ after its leading term. ``slaved`` (full closure) are
    the terms W_n of w_i = u + u_x Σ D^n W_n by particle, 1 being the first, in the same form.
    """
    found = theory.pde.third_order
    return {
        **chain_json(theory),
        "lambda": str(theory.amplitude_ratio),
        "ansatz": series_json(theory.ansatz),
        **{name: str(found[name]) if found else None for name in "GHI"},
        "terms": _terms_json(theory.pde.coefficients),
        "vanishing": list(theory.pde.vanishing),
        "slaved": [
            {"particle": i + 1, **term}
            for i, series in theory.slaved.items()
            for term in _terms_json(series)
        ],
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
        **chain_json(theory),
        **{name: str(value) for name, value in values.items()},
        "fwhm": {quantity: str(value) for quantity, value in fwhm.items()},
        "roots": [
            {name: str(getattr(r, name)) for name in ("p", "a", "mu", "eta", "sigma", "s")}
            for r in roots
        ],
        "speed_factor": str(wave.speed_factor),
        "time_scale": str(wave.speed_scale),
    }
    for name, value in (values | {"fwhm": fwhm}).items():
        put(result, f"{name}_value", each(lambda x: as_float(in_units(wave, x)), value))
    put(result, "log_B_value", as_float(-sp.log(wave.speed_factor) / (wave.k - 1)))
    return result


def force_json(
    theory: Theory, wave: TravelingWave, F: sp.Expr, units: Mapping[str, str]
) -> dict[str, Any]:
    """The object that `lwa wave --force F --format json` prints.

    B and V_s = dx/dτ are those of the wave of peak contact force F, ``speed`` is dx/dt.
    ``compressions`` are those of the cell's contacts, ``compression`` their mean, ``fwhm`` lengths
    and ``fwhm_time`` times. ``units``, for spheres, are those of the values.
    """
    answer = wave.at_force(F)
    named = ("force", "strain", "compression", "compressions", "speed", "bead_velocity")
    values = {
        "beta": wave.beta,
        "width": wave.width,
        "fwhm": {quantity: answer.fwhm(quantity) for quantity in QUANTITIES},
        "fwhm_time": {quantity: answer.fwhm(quantity, "time") for quantity in QUANTITIES},
        "speed_factor": wave.speed_factor,
        "time_scale": wave.speed_scale,
        "B": answer.strain,
        "V_s": wave.speed(answer.strain),
        **{name: getattr(answer, name) for name in named},
    }
    return answers_json(theory, values, units, lambda x: in_units(wave, x))


def answers_json(
    theory: Theory,
    values: Mapping[str, Any],
    units: Mapping[str, str],
    number: Callable[[sp.Expr], sp.Expr],
) -> dict[str, Any]:
    """A chain and values in its own units: each as a text, and where ``number`` of it is one as a
    float. For spheres, with ``units``, what they make of the chain as well."""
    if units:
        chain = {n: getattr(theory.cell, n) for n in ("masses", "stiffnesses", "spacing")}
        values = {**values, **chain}
    result = chain_json(theory) | {name: each(str, value) for name, value in values.items()}
    for name, value in values.items():
        put(result, f"{name}_value", each(lambda x: as_float(number(x)), value))
    return result | ({"units": dict(units)} if units else {})


def each(read: Callable[[sp.Expr], Any], value: Any) -> Any:
    """``read`` of an expression, or of those in a table or a row; None where it gives one None."""
    if isinstance(value, sp.Expr):
        return read(value)
    found = [read(x) for x in (value.values() if isinstance(value, Mapping) else value)]
    if None in found:
        return None
    return dict(zip(value, found, strict=True)) if isinstance(value, Mapping) else found


def dispersion_json(chain: Dispersion, order: int) -> dict[str, Any]:
    """The object that `lwa dispersion --format json` prints: Ω² by power of κ.

    ``optical`` is null unless the cell has two particles.
    """
    acoustic = chain.acoustic(order)
    optical = chain.optical(order) if chain.cell.size == 2 else None
    return {"acoustic": series_json(acoustic), "optical": optical and series_json(optical)}


def expansion_json(expansion: Expansion, wave: ExpandedWave | None = None) -> dict[str, Any]:
    """The object that `lwa expansion --format json` prints.

    c² is the sum of ``c2[n]`` ε^n, ε = k - 1, at peak force 1 on the first contact; widths, energy
    and momentum are ``prefactor`` ε^``power`` times the sum of ``coefficients[n]`` ε^n. With
    numbers for k and the cell come the sums, in D, with an estimate of each one's absolute error
    and ``error_estimate``, the largest of them; ``asymptotic`` where no higher order lessens it.
    What has no sum (`lwa.EpsilonSeries.at`) is null, and why is told in ``unsummed``, by name.
    With a wave of some force ``physical`` holds, in the cell's units, ``force_value``,
    ``speed_value``, ``fwhm_value`` and ``fwhm_time_value``, and their errors, as
    ``speed_error_value``.
    """
    widths = {quantity: expansion.fwhm(quantity) for quantity in QUANTITIES}
    result: dict[str, Any] = {
        "k": str(expansion.k),
        "masses": [str(m) for m in expansion.cell.masses],
        "stiffnesses": [str(A) for A in expansion.cell.stiffnesses],
        "order": expansion.order,
        "I": str(expansion.I),
        "c2": [str(expansion.c2.prefactor * a) for a in expansion.c2.coefficients],
        "fwhm": {quantity: _epsilon_json(series) for quantity, series in widths.items()},
        "momentum": _epsilon_json(expansion.momentum),
        "energy": _epsilon_json(expansion.energy),
    }
    if expansion.numeric:
        result |= _sums_json({"c2": expansion.c2, **widths})
    if wave is not None:
        sums = {
            "speed": wave.speed,
            "fwhm": {q: wave.fwhm(q) for q in QUANTITIES},
            "fwhm_time": {q: wave.fwhm(q, "time") for q in QUANTITIES},
        }
        result["physical"] = {"force_value": float(wave.F)}
        for name, found in sums.items():
            for part, suffix in (("value", "value"), ("error", "error_value")):
                result["physical"][f"{name}_{suffix}"] = (
                    {q: getattr(one, part) for q, one in found.items()}
                    if isinstance(found, dict)
                    else getattr(found, part)
                )
    return result


def _sums_json(series: Mapping[str, EpsilonSeries]) -> dict[str, Any]:
    """The sums of c² and the widths, with their errors."""
    values: dict[str, float | None] = dict.fromkeys(series)
    errors, unsummed, found = dict(values), {}, []
    for name, row in series.items():
        try:
            found.append(row.at())
        except InputError as error:
            unsummed[name] = str(error)
        else:
            values[name], errors[name] = found[-1].value, found[-1].error
    return {
        "c2_value": values["c2"],
        "fwhm_value": {quantity: values[quantity] for quantity in QUANTITIES},
        "error_estimate": max((one.error for one in found), default=None),
        "c2_error_value": errors["c2"],
        "fwhm_error_value": {quantity: errors[quantity] for quantity in QUANTITIES},
        "asymptotic": any(one.asymptotic for one in found) or not found,
        "unsummed": unsummed,
    }


def _epsilon_json(series: EpsilonSeries) -> dict[str, Any]:
    return {
        "prefactor": str(series.prefactor),
        "power": str(series.power),
        "coefficients": [str(a) for a in series.coefficients],
    }


def series_json(coefficients: Mapping[int, sp.Expr]) -> dict[str, str]:
    return {str(n): str(c) for n, c in coefficients.items()}


def chain_json(theory: Theory) -> dict[str, Any]:
    return {
        "k": str(theory.k),
        **_law_json(theory),
        "masses": [str(m) for m in theory.cell.masses],
        "stiffnesses": [str(A) for A in theory.cell.stiffnesses],
        "spacing": str(theory.cell.spacing),
        "order": theory.order,
        "closure": theory.closure.name,
        "branch": theory.closure.ring.branch,
        "field": theory.closure.field,
    }


def _law_json(theory: Theory) -> dict[str, Any]:
    """F and the φ_n in δ, of a law that is no power; the φ_n of `lwa.general` are not known."""
    law = theory.law
    if isinstance(law, Power):
        return {}
    orders = range(2, max(theory.order, 3))
    phi = {} if law.formless else {str(n): str(law.phi(n)) for n in orders}
    return {"law": str(law.F), "phi": phi}


def _terms_json(coefficients: Mapping[int, Terms]) -> list[dict[str, Any]]:
    return [
        {
            "order": n,
            "jet": [list(power) for power in jet.x],
            "jet_t": [list(power) for power in jet.t],
            "coefficient": found.written(jet),
        }
        for n, found in coefficients.items()
        for jet in found
    ]


def put(result: dict[str, Any], name: str, value: Any) -> None:
    if value is not None:
        result[name] = value


def in_units(wave: TravelingWave, value: sp.Expr) -> sp.Expr:
    """With V_s = B = 1, and D = 1 where it is a symbol."""
    ones = {s: sp.S.One for s in value.free_symbols if s.name in ("V_s", "B")}
    if wave.D.is_Symbol:
        ones[wave.D] = sp.S.One
    return value.xreplace(ones)


def as_float(value: sp.Expr) -> float | None:
    """The nearest float of an exact number, None for what is symbolic, complex or out of range."""
    if value.free_symbols:
        return None
    number = sp.N(value, 30)
    if not number.is_real or not (number == 0 or 1e-300 < abs(number) < 1e300):
        return None
    return float(number)
