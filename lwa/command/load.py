"""Chains under load on the command line: waves on a background, in forces, and bands in s⁻¹."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.quantities import QUANTITIES, NoSolitaryWave
from lwa.command.document import answers_json, as_float, chain_json, dispersion_json, each, put
from lwa.command.text import DIGITS, chain_text, dispersion_text
from lwa.linear.dispersion import Dispersion, LoadedChain
from lwa.theory import Theory
from lwa.wave.background import BackgroundWave
from lwa.wave.kdv import KdV
from lwa.wave.precompressed import PrecompressedWave

Values = dict[str, Any]

LOAD_SI = {"precompression": "N", "sound_speed": "m/s", "static_compression": "m"}
"""Units besides those of `lwa.command.document.SI`."""

PLACES = 8
"""Intervals of the wavenumbers, 0 to π/(PD), at which bands are printed."""


def background_json(theory: Theory, wave: BackgroundWave) -> Values:
    """The object that `lwa wave --background P0 --format json` prints.

    ``speed`` is V_s in p0 = P0 and B, ``kdv`` the limit of small B with the sech² wave's speed and
    its ``width`` L, v = B sech²(ξ/L); null where no sound runs. The values, where numbers are
    given, are those at B = 1, lengths in D, and are left out where that wave does not exist.
    """
    speed, kdv = wave.speed(), _kdv(wave)
    result = chain_json(theory) | {
        "background": str(wave.p0),
        "I": str(wave.I),
        "speed": str(speed),
        "kdv": kdv and each(str, kdv),
        "time_scale": str(wave.time_scale),
    }
    for name, value in _at_one(wave).items():
        put(result, f"{name}_value", value)
    if kdv:
        put(result, "kdv_value", each(lambda x: as_float(_plain(wave, x)), kdv))
    return result


def _at_one(wave: BackgroundWave) -> Values:
    """Speed and widths at B = 1, as floats."""
    try:
        speed = as_float(_plain(wave, wave.speed(1)))
        found: Values = {} if speed is None else {"speed": speed}
        widths = {q: as_float(_plain(wave, wave.fwhm(1, q))) for q in QUANTITIES}
    except NoSolitaryWave:
        return {}
    except InputError:  # something is a symbol
        return found
    return found if None in widths.values() else found | {"fwhm": widths}


def _kdv(wave: BackgroundWave) -> dict[str, sp.Expr] | None:
    try:
        kdv: KdV = wave.kdv
    except NoSolitaryWave:
        return None
    return {
        "sound_speed": kdv.sound_speed,
        "nonlinearity": kdv.nonlinearity,
        "dispersion": kdv.dispersion,
        "speed": kdv.speed(),
        "width": kdv.width(),
    }


def _plain(wave: BackgroundWave | PrecompressedWave | LoadedChain, value: sp.Expr) -> sp.Expr:
    """With B = 1, and D = 1 where it is a symbol."""
    ones = {s: sp.S.One for s in value.free_symbols if s.name == "B"}
    if wave.cell.spacing.is_Symbol:
        ones[wave.cell.spacing] = sp.S.One
    return value.subs(ones)


def precompressed_json(theory: Theory, wave: PrecompressedWave, units: Mapping[str, str]) -> Values:
    """The object that `lwa wave --precompression F0 --force F --format json` prints.

    ``speed`` and ``sound_speed`` are dx/dt, ``V_s`` dx/dτ; ``background`` is the strain under the
    load, B what the wave adds, ``compressions`` those that it adds to the cell's contacts. Widths
    are numbers, lengths and (``fwhm_time_value``) times.
    """
    units = {**units, **LOAD_SI} if units else {}
    result = answers_json(theory, _precompressed(wave), units, lambda x: _plain(wave, x))
    for name, extent in (("fwhm", "length"), ("fwhm_time", "time")):
        widths = _widths(wave, extent)
        put(result, f"{name}_value", widths and each(as_float, widths))
    return result


def _precompressed(wave: PrecompressedWave) -> Values:
    names = ("force", "precompression", "static_compression", "compression", "compressions")
    return {
        **{name: getattr(wave, name) for name in names},
        "background": wave.background.p0,
        "B": wave.strain,
        "V_s": wave.background.speed(wave.strain),
        "time_scale": wave.background.time_scale,
        "speed": wave.speed,
        "sound_speed": wave.sound_speed,
        "bead_velocity": wave.bead_velocity,
    }


def _widths(wave: PrecompressedWave, extent: str) -> dict[str, sp.Expr] | None:
    """Widths by quantity; None where something is a symbol."""
    try:
        found = {q: _plain(wave, wave.fwhm(q, extent)) for q in QUANTITIES}
    except InputError:
        return None
    return None if any(x.free_symbols for x in found.values()) else found


def loaded_json(chain: Dispersion, loaded: LoadedChain, order: int) -> Values:
    """The object that `lwa dispersion --precompression F0 --format json` prints.

    ``band_edges_value`` are (from, to) of each branch's frequency and ``gaps_value`` those between
    them, in s⁻¹ where the cell is in SI; ``branches_value`` has frequencies and group velocities by
    wavenumber, lengths in D where D is a symbol.
    """
    result = dispersion_json(chain, order) | {
        "precompression": str(loaded.precompression),
        "spring_constants": [str(K) for K in loaded.spring_constants],
        "sound_speed": str(loaded.sound_speed),
    }
    if _symbols(loaded):
        return result
    return result | {
        "spring_constants_value": [float(K) for K in loaded.spring_constants],
        "band_edges_value": loaded.band_edges().tolist(),
        "gaps_value": loaded.gaps().tolist(),
        "sound_speed_value": as_float(_plain(loaded, loaded.sound_speed)),
        "branches_value": [
            {
                "wavenumber": q,
                "frequencies": loaded.branches(q).tolist(),
                "group_velocities": loaded.group_velocity(q).tolist(),
            }
            for q in _wavenumbers(loaded)
        ],
    }


def _symbols(loaded: LoadedChain) -> bool:
    values = (*loaded.cell.masses, *loaded.spring_constants)
    return any(x.free_symbols for x in values)


def _wavenumbers(loaded: LoadedChain) -> list[float]:
    D = float(_plain(loaded, loaded.cell.spacing))
    return [float(sp.pi) * i / (PLACES * loaded.cell.size * D) for i in range(PLACES + 1)]


# --- for people -------------------------------------------------------------------------------


def background_text(theory: Theory, wave: BackgroundWave) -> str:
    """What `lwa wave --background P0` prints."""
    kdv = _kdv(wave)
    lines = [
        *chain_text(theory),
        f"u_x = p0 + v(ξ), ξ = x - V_s τ, p0 = {wave.p0}; v rises by B",
        "",
        f"  V_s = {wave.speed()}",
        f"  dx/dt = V_s · {wave.time_scale}",
    ]
    for name, value in _at_one(wave).items():
        rows = value.items() if isinstance(value, dict) else [("", value)]
        label = {"speed": "V_s", "fwhm": "FWHM of the"}[name]
        lines += [f"  {f'{label} {q}'.strip()} = {_shown(x)} at B = 1" for q, x in rows]
    if kdv is None:
        return "\n".join([*lines, "", "no sound runs on this background: no wave is small"])
    letters = dict(zip(kdv, ("c0", "α", "γ", "V_s", "L"), strict=True))
    lines += ["", "small waves: v_τ + c0 v_x + α v v_x + γ v_xxx = 0, v = B sech²(ξ/L)"]
    return "\n".join([*lines, *(f"  {letters[name]} = {value}" for name, value in kdv.items())])


def precompressed_text(theory: Theory, wave: PrecompressedWave, units: Mapping[str, str]) -> str:
    """What `lwa wave --precompression F0 --force F` prints; ``units`` are those of spheres."""
    units = {**units, **LOAD_SI} if units else {}
    lines = [*chain_text(theory), ""]
    for name, value in _precompressed(wave).items():
        rows = value if isinstance(value, tuple) else (value,)
        row = ", ".join(map(_shown, dict.fromkeys(rows)))
        lines.append(f"  {name.replace('_', ' ')} = {row} {units.get(name, '')}")
    for extent, unit in (("length", "m"), ("time", "s")):
        for q, value in (_widths(wave, extent) or {}).items():
            lines.append(f"  FWHM of the {q}, {extent} = {_shown(value)} {unit if units else ''}")
    return "\n".join(line.rstrip() for line in lines)


def loaded_text(chain: Dispersion, loaded: LoadedChain, order: int) -> str:
    """What `lwa dispersion --precompression F0` prints."""
    lines = [
        dispersion_text(chain, order),
        "",
        f"about the load {loaded.precompression}, law {loaded.law.F}:",
        f"  spring constants {', '.join(_shown(K) for K in loaded.spring_constants)}",
        f"  sound speed dx/dt = {_shown(loaded.sound_speed)}",
    ]
    if _symbols(loaded):
        return "\n".join(lines)
    for name, rows in (("band", loaded.band_edges()), ("gap", loaded.gaps())):
        lines += [f"  {name} {i + 1}: {low:.{DIGITS}g} … {high:.{DIGITS}g}, in rad per unit of time"
                  for i, (low, high) in enumerate(rows.tolist())]  # fmt: skip
    lines += ["", "  wavenumber: frequencies; group velocities"]
    for q in _wavenumbers(loaded):
        both = (loaded.branches(q), loaded.group_velocity(q))
        columns = (", ".join(f"{x:.6g}" for x in row.tolist()) for row in both)
        lines.append(f"  {q:.6g}: {'; '.join(columns)}")
    return "\n".join(lines)


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.{DIGITS}g}"
    if value is None or value.free_symbols or value.is_Rational:
        return str(value)
    return str(sp.sstr(sp.N(value, DIGITS), full_prec=False))
