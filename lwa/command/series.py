"""The linear chain and the series in k - 1 as rows: `lwa dispersion` and `lwa expansion`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from string import ascii_lowercase
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError
from lwa.base.quantities import QUANTITIES
from lwa.command.derivation import listed
from lwa.command.rows import PRINTED_DIGITS, Answer, Row, Values, attempt
from lwa.command.waves import WIDTHS, radiation_note
from lwa.expansion.approximants import Resummed
from lwa.expansion.expand import DAMPINGS, Expansion
from lwa.expansion.physical import ExpandedWave
from lwa.expansion.series import EpsilonSeries
from lwa.expansion.strike import Strike
from lwa.linear.dispersion import Dispersion, LoadedChain

PLACES = 8
"""Intervals of the wavenumbers, 0 to π/(PD), at which bands are printed."""


def dispersion(chain: Dispersion, order: int, loaded: LoadedChain | None = None) -> Answer:
    """The series of Ω² by power of κ; ``optical`` is null unless the cell has two particles.

    Under a load ``band_edges_value`` has the frequencies (from, to) of each branch, ``gaps_value``
    those of the gaps between branches, in s⁻¹ where the cell is in SI; ``branches_value`` has
    frequencies and group velocities by wavenumber, lengths in D where D is a symbol.
    """
    cell = chain.cell
    branches = {"acoustic": chain.acoustic(order)}
    if cell.size == 2:
        branches["optical"] = chain.optical(order)
    rows: list[Row | str] = [
        f"masses {listed(cell.masses)}, A = {listed(cell.stiffnesses)}; Ω²(κ), κ = qD and Ω/D the "
        "frequency in τ",
        "",
    ]
    head: Values = {"acoustic": None, "optical": None}
    equations = []
    for name, series in branches.items():
        head[name] = {str(n): str(c) for n, c in series.items()}
        rows += [f"{name}:", *(f"  {f'κ^{n}' if n else '1'}: {c}" for n, c in series.items())]
        powers = ((c, latex.power(sp.Symbol("kappa"), n) if n else "") for n, c in series.items())
        letter = rf"\Omega_{{\mathrm{{{name}}}}}^{{2}}"
        equations.append(rf"{letter} = {latex.total(powers)} + \cdots")
    if loaded is None:
        return Answer(head, rows, equations=equations)
    rows += [
        "",
        f"about the load {loaded.precompression}, law {loaded.law.F}:",
        Row("precompression", "", loaded.precompression, "F_{0}", number=None),
        Row("spring_constants", "spring constants", loaded.spring_constants, "K"),
        Row("sound_speed", "sound speed dx/dt", loaded.sound_speed, "c_{0}"),
    ]
    bands = _bands(loaded)
    rows += _bands_text(bands)
    return Answer(head | bands, rows, spacing=loaded.cell.spacing, equations=equations)


def _bands(loaded: LoadedChain) -> Values:
    """Bands, gaps and branches in floats; {} where something is a symbol."""
    if any(x.free_symbols for x in (*loaded.cell.masses, *loaded.spring_constants)):
        return {}
    D = 1.0 if loaded.cell.spacing.is_Symbol else float(loaded.cell.spacing)
    places = [float(sp.pi) * i / (PLACES * loaded.cell.size * D) for i in range(PLACES + 1)]
    return {
        "band_edges_value": loaded.band_edges().tolist(),
        "gaps_value": loaded.gaps().tolist(),
        "branches_value": [
            {
                "wavenumber": q,
                "frequencies": loaded.branches(q).tolist(),
                "group_velocities": loaded.group_velocity(q).tolist(),
            }
            for q in places
        ],
    }


def _bands_text(bands: Values) -> list[str]:
    if not bands:
        return []
    lines = []
    for name, key in (("band", "band_edges_value"), ("gap", "gaps_value")):
        for i, (low, high) in enumerate(bands[key], start=1):
            edges = f"{low:.{PRINTED_DIGITS}g} … {high:.{PRINTED_DIGITS}g}"
            lines.append(f"  {name} {i}: {edges}, in rad per unit of time")
    lines += ["", "  wavenumber: frequencies; group velocities"]
    for place in bands["branches_value"]:
        columns = (place["frequencies"], place["group_velocities"])
        numbers = (", ".join(f"{x:.6g}" for x in column) for column in columns)
        lines.append(f"  {place['wavenumber']:.6g}: {'; '.join(numbers)}")
    return lines


def expansion(
    found: Expansion, wave: ExpandedWave | None, units: Mapping[str, str], notes: list[str]
) -> Answer:
    """The series in ε = k - 1, and their sums where k and the cell are numbers.

    c² is the sum of ``c2[n]`` ε^n at peak force 1 on the first contact; the others are
    ``prefactor`` ε^``power`` times the sum of ``coefficients[n]`` ε^n. Sums are in D, each with
    an estimate of its absolute error; ``error_estimate`` is the largest for c² and the widths,
    ``asymptotic`` is true if higher orders do not reduce one of these errors. A quantity without
    a sum (`lwa.EpsilonSeries.at`) is null, for the reason in ``unsummed``. ``physical`` has the
    wave of some force in the units of the cell.
    """
    cell = found.cell
    series = {"c2": found.c2} | {f"fwhm.{q}": found.fwhm(q) for q in QUANTITIES}
    series |= {"momentum": found.momentum, "energy": found.energy}
    labels = {"c2": "c²", **{f"fwhm.{q}": f"FWHM of the {q}" for q in QUANTITIES}}
    head: Values = {
        "k": str(found.k),
        "masses": [str(m) for m in cell.masses],
        "stiffnesses": [str(A) for A in cell.stiffnesses],
        "order": found.order,
        "I": str(found.I),
        "c2": [str(found.c2.prefactor * a) for a in found.c2.coefficients],
        "fwhm": {q: _series_json(found.fwhm(q)) for q in QUANTITIES},
        "momentum": _series_json(found.momentum),
        "energy": _series_json(found.energy),
    }
    letter = _letter(found)
    rows: list[Row | str] = [
        f"masses {listed(cell.masses)}; F = A δ^k, A = {listed(cell.stiffnesses)}; ε = k - 1; peak "
        "force 1 on the first contact, lengths in D",
        "",
    ]
    for key, one in series.items():
        rows += _series_text(labels.get(key, key), one, letter)
    if found.numeric:
        sums = _sums(found, series)
        head |= _told(sums)
        rows += ["", f"at k = {found.k}, with estimates of the error:"]
        rows += [Row(key, _LABELS.get(key, labels.get(key, key)), one) for key, one in sums.items()]
        if cell.size == 2:
            rows.append("  (of the mean of a dimer's two contacts, which differ behind a striker)")
        notes = [*notes, *radiation_note(cell, found.k)]
    answer = Answer(head, rows, equations=[one.latex() for one in series.values()], notes=notes)
    return answer if wave is None else _with_wave(answer, wave, units)


_LABELS = {
    "momentum": "momentum",
    "energy": "energy",
    "effective_mass": "effective mass P²/2E",
    "dissipation.linear": "dissipation by γ dδ/dt, over γ",
    "dissipation.kuwabara_kono": "dissipation by γ δ^(k-1) dδ/dt, over γ",
}


def _sums(found: Expansion, series: Mapping[str, EpsilonSeries]) -> dict[str, Any]:
    """Mapping from key to sum, with effective mass and, for equal beads, dissipation."""
    sums = {key: attempt(one.at) for key, one in series.items()}
    sums["effective_mass"] = attempt(found.effective_mass.at)
    if len({*found.cell.masses}) == len({*found.cell.stiffnesses}) == 1:
        for kind in DAMPINGS:
            sums[f"dissipation.{kind}"] = attempt(found.dissipation(kind).at)
    return sums


def _told(sums: Mapping[str, Any]) -> Values:
    """JSON of the largest error of c² and the widths, and of the reasons for missing sums."""
    known = [s for key, s in sums.items() if key.startswith(("c2", "fwhm"))]
    summed = [one for one in known if isinstance(one, Resummed)]
    return {
        "error_estimate": max((one.error for one in summed), default=None),
        "asymptotic": any(one.asymptotic for one in summed) or not summed,
        "unsummed": {
            key.removeprefix("fwhm."): str(one)
            for key, one in sums.items()
            if isinstance(one, InputError)
        },
    }


def _with_wave(answer: Answer, wave: ExpandedWave, units: Mapping[str, str]) -> Answer:
    """Add to the answer the wave of a force, in JSON under ``physical``."""
    unit = units.get("force", "")
    rows: list[Row | str] = ["", f"peak contact force {float(wave.F):g} {unit}".rstrip() + ":"]
    rows.append(Row("speed", "speed dx/dt", attempt(lambda: wave.speed), _SPEED))
    for key, label, extent in WIDTHS:
        rows += [
            Row(f"{key}.{q}", label.format(q), attempt(wave.fwhm, q, extent)) for q in QUANTITIES
        ]
    own_units = {key: units[key] for key in ("force", "speed", "fwhm", "fwhm_time") if units}
    own = Answer({"force_value": float(wave.F)}, rows, own_units)
    return replace(answer, parts={"physical": own})


_SPEED = r"\mathrm{d}x/\mathrm{d}t"


def strike(found: Strike, units: Mapping[str, str], notes: list[str]) -> Answer:
    """The leading pulse of a struck chain; ``fwhm`` is that of a contact's force."""
    cell = found.chain.cell
    kept = {key: unit for key, unit in units.items() if key in ("force", "speed", "velocity")}
    if units:
        kept |= {"fwhm.length": "m", "fwhm.time": "s", "mass": "kg", "velocity": "m/s"}
    rows: list[Row | str] = [
        f"chain of equal beads; F = A δ^k, k = {found.chain.k}",
        Row("", "mass of the beads", cell.masses[0]),
        Row("mass", "mass of the striker", found.mass, "m_{s}", expression=False),
        Row("velocity", "velocity of the striker", found.velocity, "v", expression=False),
        "",
        "leading pulse:",
        Row("force", "peak contact force", found.force, "F"),
        Row("speed", "speed dx/dt", found.speed, _SPEED),
        Row("fwhm.length", "FWHM of the force", found.fwhm("force", "length"), _WIDTH),
        Row("fwhm.time", "FWHM of the force in time", found.fwhm("force", "time"), _WIDTH + "/c"),
    ]
    if found.train:
        notes = [*notes, "a striker heavier than two beads sends further pulses behind this one"]
    return Answer({}, rows, kept, notes=notes, orders=False)


_WIDTH = r"\mathrm{FWHM}_{\mathrm{force}}"


def _series_json(series: EpsilonSeries) -> Values:
    return {
        "prefactor": str(series.prefactor),
        "power": str(series.power),
        "coefficients": [str(a) for a in series.coefficients],
    }


def _letter(expansion: Expansion) -> str:
    """The letter of the coefficients in text: the first that no symbol uses with a number."""
    names = {s.name for s in (*expansion.cell.symbols, *expansion.k.free_symbols)}
    taken = {name[0] for name in names if name[1:] == "_n" or name[1:].isdecimal()}
    return next(letter for letter in ascii_lowercase if letter not in taken)


def _series_text(name: str, series: EpsilonSeries, a: str) -> list[str]:
    factors = [str(series.prefactor)] if series.prefactor != 1 else []
    factors += [f"ε^({series.power})"] if series.power else []
    lines = [f"{name} = {' '.join([*factors, f'Σ {a}_n ε^n'])}"]
    return lines + [f"  {a}{n} = {value}" for n, value in enumerate(series.coefficients)]
