"""The command `lwa expansion`: the lattice's own wave as a series in k - 1."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import click
import sympy as sp

from lwa.base.exact import InputError
from lwa.base.quantities import QUANTITIES
from lwa.cell import k
from lwa.command.chain import ChainInput, take_chain
from lwa.command.options import FORCE, SPHERES, series_options
from lwa.command.rows import Answer, Row, Values, attempt
from lwa.command.waves import WIDTHS
from lwa.expansion.approximants import Resummed
from lwa.expansion.expand import Expansion, expand
from lwa.expansion.physical import ExpandedWave
from lwa.expansion.series import EpsilonSeries


@click.command()
@series_options(k.name, "Highest power of ε = k - 1; by default 8, or 4 with symbols.", None)
@FORCE
@SPHERES
def expansion(order: int | None, style: str, force: sp.Expr | None, **options: Any) -> None:
    """Expand the lattice's own wave in ε = k - 1, and sum the series.

    Each sum comes with an estimate of its absolute error, at the peak force 1 on the first contact
    and with lengths in D; k and the cell must be numbers. With --spheres also the wave of the peak
    force --force (1 N by default) in an endless chain without load, in m, s and N.

    In JSON c² is the sum of `c2`[n] ε^n, and other quantities are `prefactor` ε^`power` times the
    sum of `coefficients`[n] ε^n. `error_estimate` is the largest error of c² and the widths,
    `asymptotic` is true if higher orders do not reduce one of them, and `unsummed` has the reasons
    why quantities have no sum. `physical` has the wave of the force.
    """
    spheres = options["spheres"] is not None
    if force is not None and not spheres:
        raise InputError("--force goes with --spheres: other chains have no units")
    chain = take_chain(options)
    expanded = expand(chain.cell, order or 4, law=chain.law)
    if order is None and expanded.numeric:
        expanded = expand(chain.cell, 8, law=chain.law)
    answer = _answer(chain, expanded)
    if spheres and chain.cell.spacing.is_number:
        wave = ExpandedWave(expanded, sp.S.One if force is None else force)
        answer = replace(answer, parts={"physical": _at_force(wave, chain.si)})
    answer.print(style)


_LABELS = {
    "c2": "c²",
    **{f"fwhm.{q}": f"FWHM of the {q}" for q in QUANTITIES},
    "momentum": "momentum",
    "energy": "energy",
    "effective_mass": "effective mass P²/2E",
}


def _answer(chain: ChainInput, expanded: Expansion) -> Answer:
    """Rows of the coefficients, and of the sums where k and the cell are numbers."""
    cell, notes = expanded.cell, chain.without_load()
    widths = {q: expanded.fwhm(q) for q in QUANTITIES}
    series = {"c2": expanded.c2} | {f"fwhm.{q}": width for q, width in widths.items()}
    series |= {"momentum": expanded.momentum, "energy": expanded.energy}
    head: Values = {
        "k": str(expanded.k),
        "masses": [str(m) for m in cell.masses],
        "stiffnesses": [str(A) for A in cell.stiffnesses],
        "order": expanded.order,
        "I": str(expanded.I),
        "c2": [expanded.c2.prefactor * a for a in expanded.c2.coefficients],
        "fwhm": {q: _series_json(width) for q, width in widths.items()},
        "momentum": _series_json(expanded.momentum),
        "energy": _series_json(expanded.energy),
    }
    rows: list[Row | str] = [
        chain.text,
        "ε = k - 1; peak force 1 on the first contact, lengths in D",
        "",
    ]
    for key, part in series.items():
        rows += _series_text(_LABELS[key], part)
    if expanded.numeric:
        sums = {key: attempt(part.at) for key, part in series.items()}
        sums["effective_mass"] = attempt(expanded.effective_mass.at)
        head |= _validity(sums)
        rows += ["", f"at k = {expanded.k}, with estimates of the error:"]
        rows += [Row(key, _LABELS[key], value) for key, value in sums.items()]
        if cell.size == 2:
            rows.append("  (of the mean of a dimer's two contacts, which differ behind a striker)")
    return Answer(head, rows, shown=[expanded], notes=notes)


def _validity(sums: Mapping[str, Any]) -> Values:
    """JSON of the largest error of c² and the widths, and of the reasons for missing sums."""
    known = [s for key, s in sums.items() if key.startswith(("c2", "fwhm"))]
    summed = [part for part in known if isinstance(part, Resummed)]
    return {
        "error_estimate": max((part.error for part in summed), default=None),
        "asymptotic": any(part.asymptotic for part in summed) or not summed,
        "unsummed": {
            key.removeprefix("fwhm."): str(part)
            for key, part in sums.items()
            if isinstance(part, InputError)
        },
    }


def _at_force(wave: ExpandedWave, si: bool) -> Answer:
    """Rows of the wave of a peak force."""
    force = f"{float(wave.F):g}{' N' * si}"
    rows: list[Row | str] = ["", f"peak contact force {force}:"]
    rows.append(Row("force", "", wave.F, unit="N", expression=False))
    rows.append(Row("speed", "speed dx/dt", attempt(lambda: wave.speed), "m/s"))
    for key, label, extent, unit in WIDTHS:
        for q in QUANTITIES:
            width = attempt(wave.fwhm, q, extent)
            rows.append(Row(f"{key}.{q}", f"FWHM of the {q}{label}", width, unit=unit))
    return Answer({}, rows, si, shown=[wave])


def _series_json(series: EpsilonSeries) -> Values:
    return {
        "prefactor": series.prefactor,
        "power": series.power,
        "coefficients": list(series.coefficients),
    }


def _series_text(name: str, series: EpsilonSeries) -> list[Row | str]:
    factors = [str(series.prefactor)] if series.prefactor != 1 else []
    factors += [f"ε^({series.power})"] if series.power else []
    coefficients = enumerate(series.coefficients)
    return [
        f"{name} = {' '.join([*factors, 'Σ a_n ε^n'])}",
        *(Row("", f"a{n}", value, digits=0) for n, value in coefficients),
    ]
