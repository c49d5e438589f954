"""The command `lwa wave`: the compact wave, the wave of a given force, waves under load."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click
import sympy as sp

from lwa.base.exact import InputError, read_exact
from lwa.base.frozen import QUANTITIES, NoSolitaryWave, Shown
from lwa.command.chain import ChainInput, take_chain
from lwa.command.derivation import UNKNOWNS, settings_json
from lwa.command.options import (
    BACKGROUND,
    FORCE,
    PRECOMPRESSION,
    SPHERES,
    given,
    theory_options,
)
from lwa.command.rows import PRINTED_DIGITS, Answer, Row, attempt
from lwa.spheres.hertz import EXPONENT
from lwa.theory import Theory, homogenize
from lwa.wave.compact import CompactWave, PhysicalWave, canonical_wave
from lwa.wave.source import LANGUAGES

if TYPE_CHECKING:
    from lwa.loaded.background import Background
    from lwa.loaded.wave import LoadedWave

# Compression over the spacing from which on a note is printed: the radius of contact of equal
# spheres is then a tenth of their radius R, a/R = √(δ/2R), where Hertz (1882) wants a ≪ R.
HERTZIAN = 0.01

_REDUCTION = ("p", "a", "mu", "eta", "sigma", "s")  # of the paper's v = z^p

_WIDTH_DIGITS = 12  # of widths under a load that are right (`lwa.loaded.quadrature`)


@click.command()
@theory_options(tuple(LANGUAGES))
@FORCE
@SPHERES
@BACKGROUND
@PRECOMPRESSION
def wave(
    style: str,
    force: sp.Expr | None,
    background: sp.Expr | None,
    precompression: sp.Expr | None,
    **options: Any,
) -> None:
    """Compact traveling wave: β, width, FWHM, amplitude and speed.

    With --force the wave of this peak contact force, in space and time; with --spheres in m, s, kg
    and N. With --background or --precompression the wave in a chain under load, in the canonical
    field (--closure full --field center), and its Korteweg-de Vries limit for small amplitudes.

    A programming language as --format gives the source of functions that compute the wave without
    load.

    Without --force the floats in JSON are those at B = 1 (speed) and at V_s = 1 (B, mu), with D as
    the unit of length if D is a symbol. `speed` is V_s = dx/dτ, and dx/dt with --force.
    """
    spheres = options["spheres"] is not None
    chain = take_chain(options)
    cell, law = chain.cell, chain.law
    if background is not None and precompression is not None:
        raise InputError(
            "--background and --precompression are both given: one says the other"
        )
    precompression = chain.load(background, precompression)
    load = precompression if background is None else background
    # no load is a load, too, under a law that is no power: the compact wave is that of a power
    if law.homogeneous:
        loaded = load is not None and not load.is_zero
    else:
        loaded = load is not None or force is not None
    if loaded:
        for name, wanted in (
            ("closure", "full"),
            ("field", "center"),
            ("branch", "acoustic"),
        ):
            if given(name) and options[name] != wanted:
                raise InputError(
                    f"{name} is {options[name]!r}: under load the wave is that of the canonical "
                    f"field, {name} {wanted!r}"
                )
            options[name] = wanted
    if style in LANGUAGES and (loaded or force is not None):
        fault = (
            "of a chain without load"
            if loaded
            else "for any force: --force goes with text"
        )
        raise InputError(f"--format {style} is {fault}")
    peak = read_exact("F", "force") if force is None else force
    theory = homogenize(cell, law=law, **options)
    if not loaded:
        compact = theory.pde.traveling_wave()
        if style in LANGUAGES:
            click.echo(compact.code(style))
        elif force is None and not spheres:
            _compact(chain, theory, compact).print(style)
        else:
            _at_force(chain, theory, compact.at_force(peak)).print(style)
    elif background is None:
        from lwa.loaded.wave import loaded_wave  # start-up: it loads NumPy

        static = precompression or sp.S.Zero
        pressed = loaded_wave(cell, force=peak, precompression=static, law=law)
        _at_force(chain, theory, pressed).print(style)
    elif force is not None:
        raise InputError(
            "--force goes with --precompression, a force; --background is a strain"
        )
    else:
        from lwa.loaded.background import Background

        _on_background(chain, theory, Background(cell, law, background)).print(style)


def hertz_note(chain: ChainInput, force: sp.Expr) -> list[str]:
    """Note on a force that presses spheres too much for Hertz's contact; [] for other chains."""
    cell = chain.cell
    if not chain.si or chain.law.exponent != EXPONENT or force.free_symbols:
        return []
    strain = float(chain.law.compression(cell, force) / cell.spacing)
    if strain < HERTZIAN:
        return []
    return [
        f"contacts are compressed by {strain:.2g} of the spacing: Hertz's contact is that of "
        f"elastic spheres up to about {HERTZIAN}, and metals yield before"
    ]


def _compact(chain: ChainInput, theory: Theory, wave: CompactWave) -> Answer:
    """Rows of the compact wave of any amplitude: speed V_s by peak strain B, and B by V_s."""
    reduction = wave.reduction()
    rows: list[Row | str] = [
        chain.text,
        f"closure {theory.closure.name}; {UNKNOWNS[theory.closure.field]}",
        "v = u_x = B cos^(2/(k-1))(β ξ), ξ = x - V_s τ, on |ξ| ≤ π/(2β)",
        "",
        Row("beta", "β", wave.beta),
        Row("width", "width π/β", wave.width),
        *(Row(f"fwhm.{q}", f"FWHM of the {q}", wave.fwhm(q)) for q in QUANTITIES),
        Row("B", "B", wave.amplitude()),
        Row("speed", "V_s", wave.speed()),
        f"  F_m ∝ V_s^({wave.force_exponent});  dx/dt = V_s · {wave.time_scale}",
        "",
        "v = z^p, integrating factor z^a: z'' = μ z^η - σ z",
        *(Row(name, name, getattr(reduction, name)) for name in _REDUCTION),
    ]
    shown, parts = [theory.pde, wave, reduction], _canonical(chain, theory, None)
    return Answer(settings_json(theory), rows, spacing=wave.D, shown=shown, parts=parts)


def _at_force(
    chain: ChainInput, theory: Theory, at: PhysicalWave | LoadedWave
) -> Answer:
    """Rows of the wave of a peak contact force F, without or under a load, with speeds dx/dt."""
    compact = isinstance(at, PhysicalWave)
    load, peak = getattr(at, "precompression", 0), "peak" if compact else "rise of the"
    rows: list[Row | str] = [
        f"endless chain {'under a load' if load else 'without load'}; closure "
        f"{theory.closure.name}; {UNKNOWNS[theory.closure.field]}",
        chain.text,
        "",
        Row("force", "peak contact force F", at.force, "N"),
        Row("B", f"{peak} strain B", at.strain),
        Row("compression", f"{peak} compression", at.compression, "m"),
        Row("speed", "speed dx/dt", at.speed, "m/s"),
        Row("bead_velocity", "peak velocity of the beads", at.bead_velocity, "m/s"),
    ]
    widths = (("fwhm", "", "length", "m"), ("fwhm_time", " in time", "time", "s"))
    for key, label, extent, unit in widths:
        for q in QUANTITIES:
            width = attempt(at.fwhm, q, extent)
            if not isinstance(width, InputError):  # under a load widths are numbers
                digits = PRINTED_DIGITS if compact else _WIDTH_DIGITS
                label_q = f"FWHM of the {q}{label}"
                rows.append(
                    Row(f"{key}.{q}", label_q, width, unit, digits, expression=compact)
                )
    shown: list[Shown] = [at]
    if isinstance(at, PhysicalWave):
        rows += [
            Row("beta", "", at.wave.beta, "1/m"),
            Row("width", "", at.wave.width, "m"),
        ]
        shown, parts = [at.wave, at], _canonical(chain, theory, at.force)
    else:
        parts = {}
        rows += [
            Row("precompression", "static force F0", at.precompression, "N"),
            Row("background", "static strain p0", at.background),
            Row("static_compression", "static compression", at.static_compression, "m"),
            Row("sound_speed", "speed of sound dx/dt", at.sound_speed, "m/s"),
        ]
    head, notes = settings_json(theory), hertz_note(chain, at.force)
    return Answer(head, rows, chain.si, theory.cell.spacing, shown, notes, parts)


def _canonical(
    chain: ChainInput, theory: Theory, force: sp.Expr | None
) -> dict[str, Answer]:
    """Speed and widths of the canonical wave, beside the linear closure's; {} where it has none.

    The numbers of the linear closure depend on the bead that is called first, those of the
    canonical wave do not. Without a force they are at B = 1, and the speed is V_s.
    """
    cell, k = chain.cell, chain.law.exponent
    numbers = (k, *cell.masses, *cell.stiffnesses, sp.S.One if force is None else force)
    linear = theory.closure.name == "linear" and theory.amplitude_ratio == 1
    if cell.uniform or not linear or any(x.free_symbols for x in numbers):
        return {}
    wave = canonical_wave(cell, k=k)
    at = wave if force is None else wave.at_force(force)
    speed = Row(
        "speed", "V_s at B = 1", wave.speed(sp.S.One), digits=6, expression=False
    )
    if force is not None:
        speed = replace(speed, label="speed dx/dt", value=at.speed, unit="m/s")
    rows: list[Row | str] = [
        "",
        "consistent closure, whichever bead is the first:",
        speed,
    ]
    for q in QUANTITIES:
        label = "FWHM of the force" if q == "force" else ""
        rows.append(
            Row(f"fwhm.{q}", label, at.fwhm(q), "m", digits=6, expression=False)
        )
    return {"canonical": Answer({}, rows, chain.si, cell.spacing)}


def _on_background(chain: ChainInput, theory: Theory, field: Background) -> Answer:
    """Rows of the waves on the strain p0, with V_s a function of the rise B of the strain."""
    from lwa.loaded.wave import loaded_wave  # start-up: it loads NumPy

    head, cell = settings_json(theory), field.cell
    rows: list[Row | str] = [
        chain.text,
        UNKNOWNS[theory.closure.field],
        f"u_x = p0 + v(ξ), ξ = x - V_s τ, p0 = {field.p0}; v rises by B",
        "",
        Row("background", "", field.p0, digits=0),
        Row("speed", "V_s", field.speed(field.rise), digits=0),
        f"  dx/dt = V_s · {field.time_scale}",
    ]
    # D is the unit of length where it is a symbol; beside a law that is no power it is 1.
    if cell.spacing.is_Symbol and not field.law.homogeneous:
        cell = cell.at(**{cell.spacing.name: 1})
    with suppress(NoSolitaryWave, InputError):  # no wave of this rise, or symbols
        wave = loaded_wave(cell, rise=1, background=field.p0, law=field.law)
        speed = wave.field.speed(wave.strain)
        if not speed.free_symbols - {cell.spacing}:
            rows.append(Row("speed", "V_s at B = 1", speed, expression=False))
            for q in QUANTITIES:
                label, width = f"FWHM of the {q} at B = 1", wave.fwhm(q)
                rows.append(
                    Row(f"fwhm.{q}", label, width, "", _WIDTH_DIGITS, expression=False)
                )
    shown: list[Shown] = [field]
    try:
        kdv = field.kdv
    except NoSolitaryWave as reason:
        head["kdv"] = None
        rows += ["", str(reason)]
    else:
        shown.append(kdv)
        rows += [
            "",
            "small waves: v_τ + c0 v_x + α v v_x + γ v_xxx = 0, v = B sech²(ξ/L)"
            + ", B < 0" * bool(kdv.rise.is_negative),
            Row("kdv.sound_speed", "c0", kdv.sound_speed),
            Row("kdv.nonlinearity", "α", kdv.nonlinearity),
            Row("kdv.dispersion", "γ", kdv.dispersion),
            Row("kdv.speed", "V_s of a small wave", kdv.speed()),
            Row("kdv.width", "L", kdv.width()),
        ]
    return Answer(head, rows, spacing=field.cell.spacing, shown=shown)
