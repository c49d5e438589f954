"""Answers of `lwa wave` under load: the wave of a peak force, and the waves on a strain."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

import sympy as sp

from lwa.base.exact import InputError
from lwa.base.frozen import NoSolitaryWave, Shown
from lwa.base.words import QUANTITIES
from lwa.cell import Cell
from lwa.command.answer import Answer
from lwa.command.chain import ChainInput
from lwa.command.derivation import closure_lines, settings_json
from lwa.command.rows import Row, attempt, estimated
from lwa.loaded.background import Background, KdV
from lwa.loaded.wave import LoadedWave, loaded_wave
from lwa.theory import Theory

_WIDTH_DIGITS = 12  # of widths under a load that are right (`lwa.loaded.quadrature`)

_ERRORS = "bound of the difference to waves of the lattice, by those that were measured"


def of_force(
    chain: ChainInput, theory: Theory, force: sp.Expr, static: sp.Expr
) -> Answer:
    """The wave of a peak contact force in a chain under a static force."""
    wave = loaded_wave(chain.cell, force=force, precompression=static, law=chain.law)
    rows: list[Row | str | Answer] = [
        f"endless chain {'without load' if static.is_zero else 'under a load'}",
        *closure_lines(theory),
        chain.text,
        "",
        Row("force", "peak contact force F", wave.force, "N"),
        Row("B", "rise of the strain B", wave.strain),
        Row("compression", "rise of the compression", wave.compression, "m"),
        Row(
            "speed",
            "speed dx/dt",
            wave.speed,
            "m/s",
            estimate=estimated(wave, "speed"),
        ),
        Row("bead_velocity", "peak velocity of the beads", wave.bead_velocity, "m/s"),
        *_width_rows(wave),
        Row("precompression", "static force F0", wave.precompression, "N"),
        Row("background", "static strain p0", wave.background),
        Row("static_compression", "static compression", wave.static_compression, "m"),
        Row("sound_speed", "speed of sound dx/dt", wave.sound_speed, "m/s"),
    ]
    notes = chain.hertz_notes(wave.force)
    return Answer(settings_json(theory), rows, chain.scale, [wave], _ERRORS, notes)


def _width_rows(wave: LoadedWave) -> Iterator[Row]:
    """Rows of the widths in space and time; none with symbols."""
    for key, label, extent, unit in (
        ("fwhm", "", "length", "m"),
        ("fwhm_time", " in time", "time", "s"),
    ):
        for q in QUANTITIES:
            width = attempt(wave.fwhm, q, extent)
            if isinstance(width, InputError):
                return
            symbol = rf"\mathrm{{FWHM}}_{{\mathrm{{{q}}}}}"
            if extent == "time":
                symbol += "^{(t)}"
            yield Row(
                f"{key}.{q}",
                f"FWHM of the {q}{label}",
                width,
                unit,
                symbol,
                form="number",
                digits=_WIDTH_DIGITS,
                estimate=estimated(wave, "fwhm", q, extent),
            )


def on_background(chain: ChainInput, theory: Theory, p0: sp.Expr) -> Answer:
    """The waves on the strain p0: V_s by the rise B of the strain, and the limit of small waves."""
    field = Background(chain.cell, chain.law, p0)
    head = settings_json(theory)
    rows: list[Row | str | Answer] = [
        chain.text,
        *closure_lines(theory),
        f"u_x = p0 + v(ξ), ξ = x - V_s τ, p0 = {field.p0}; v rises by B",
        "",
        Row("background", "", field.p0, form="formula"),
        Row("speed", "V_s", field.speed(field.rise), form="formula"),
        f"  dx/dt = V_s · {field.time_scale}",
        *_unit_rise(field),
    ]
    shown: list[Shown | str] = [field]
    try:
        kdv = field.kdv
    except NoSolitaryWave as reason:
        head["kdv"] = None
        rows += ["", str(reason)]
    else:
        shown.append(kdv)
        rows += _small_waves(kdv)
    return Answer(head, rows, chain.scale, shown, _ERRORS)


def _unit_rise(field: Background) -> Iterator[Row]:
    """Rows of the wave whose strain rises by 1; none with symbols, or if there is none."""
    cell: Cell = field.cell
    place = "B = 1"
    # D is the unit of length where it is a symbol; beside a law that is no power it is 1.
    if cell.spacing.is_Symbol and not field.law.homogeneous:
        cell = cell.at(**{cell.spacing.name: 1})
        place += f", {field.cell.spacing} = 1"
    with suppress(NoSolitaryWave, InputError):
        wave = loaded_wave(cell, rise=1, background=field.p0, law=field.law)
        speed = wave.field.speed(wave.strain)
        if speed.free_symbols - {cell.spacing}:
            return
        yield Row("speed", f"V_s at {place}", speed, form="number")
        for q in QUANTITIES:
            label = f"FWHM of the {q} at {place}"
            yield Row(
                f"fwhm.{q}", label, wave.fwhm(q), form="number", digits=_WIDTH_DIGITS
            )


def _small_waves(kdv: KdV) -> list[Row | str | Answer]:
    """Rows of the Korteweg-de Vries equation and its solitary wave."""
    equation = "small waves: v_τ + c0 v_x + α v v_x + γ v_xxx = 0, v = B sech²(ξ/L)"
    if kdv.rise.is_negative:
        equation += ", B < 0"
    return [
        "",
        equation,
        Row("kdv.sound_speed", "c0", kdv.sound_speed),
        Row("kdv.nonlinearity", "α", kdv.nonlinearity),
        Row("kdv.dispersion", "γ", kdv.dispersion),
        Row("kdv.speed", "V_s of a small wave", kdv.speed(), symbol="V_{s}"),
        Row("kdv.width", "L", kdv.width(), symbol="L"),
    ]
