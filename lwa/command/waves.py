"""The command `lwa wave`: the lattice's own wave, the compact wave, and waves under load."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import click
import sympy as sp

from lwa.base.exact import InputError, read_exact
from lwa.base.frozen import TABLE_DIGITS, NoSolitaryWave, Shown
from lwa.base.words import LANGUAGES, QUANTITIES
from lwa.command.answer import Answer, Values
from lwa.command.chain import ChainInput, take_chain
from lwa.command.derivation import closure_lines, depends_on_first, settings_json
from lwa.command.options import (
    BACKGROUND,
    FORCE,
    PRECOMPRESSION,
    SPHERES,
    command,
    given,
    theory_options,
)
from lwa.command.rows import LONG, Row, as_float
from lwa.theory import Theory, homogenize
from lwa.wave.compact import CompactWave, canonical_wave
from lwa.wave.reduction import Reduction

CANONICAL = "the canonical field, whichever bead is the first"


@command(
    "lwa wave --k 3/2 --masses 0.45,0.123",
    "lwa wave --masses 1 --k 5/2 --spacing 1 --force 8 --precompression 1",
    "lwa wave --masses 1,2,3 --format latex",
    page="paper",
)
@theory_options(LANGUAGES)
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
    precompression = chain.load(background, precompression)
    load = precompression if background is None else background
    loaded = load is not None and not load.is_zero
    if not chain.law.homogeneous:
        # The compact wave is that of a power: under another law no load is a load, too.
        loaded = load is not None or force is not None
    if loaded:
        _take_canonical(options)
    _check_language(style, loaded, force)
    theory = homogenize(chain.cell, law=chain.law, **options)
    if not loaded and not chain.law.homogeneous:
        raise InputError(
            f"law is {chain.law.text}: the compact wave is that of a power law; waves under a "
            "load or of a force have any law",
            background="1/10",
        )
    peak = read_exact("F", "force") if force is None else force
    if style in LANGUAGES:
        click.echo(_compact(theory).code(style))
    elif not loaded and force is None and not spheres:
        any_amplitude(chain, theory).print(style)
    elif not loaded:
        of_force(chain, theory, peak).print(style)
    else:
        from lwa.command import pressed  # here: it loads NumPy

        if background is None:
            static = precompression or sp.S.Zero
            pressed.of_force(chain, theory, peak, static).print(style)
        elif force is None:
            pressed.on_background(chain, theory, background).print(style)
        else:
            raise InputError(
                "--force goes with --precompression, a force; --background is a strain",
                force=None,
            )


def _take_canonical(options: dict[str, Any]) -> None:
    """Set the closure, the field and the branch of waves under load; refuse others."""
    for name, wanted in (
        ("closure", "full"),
        ("field", "center"),
        ("branch", "acoustic"),
    ):
        if given(name) and options[name] != wanted:
            raise InputError(
                f"{name} is {options[name]!r}: under load the wave is that of the canonical field",
                **{name: wanted},
            )
        options[name] = wanted


def _check_language(style: str, loaded: bool, force: sp.Expr | None) -> None:
    """Refuse the source code of a wave under load or of a given force."""
    if style not in LANGUAGES:
        return
    if loaded:
        raise InputError(f"--format {style} is of a chain without load", format="text")
    if force is not None:
        raise InputError(
            f"--format {style} is for any force: its functions take one", force=None
        )


def _compact(theory: Theory) -> CompactWave:
    """The compact wave of a theory; a refusal has the numbers of the canonical field."""
    try:
        return theory.pde.traveling_wave()
    except (InputError, NoSolitaryWave) as refusal:
        if not depends_on_first(theory) or theory.order < 4:
            raise
        canonical = canonical_wave(theory.cell, theory.k)
        width = as_float(canonical.fwhm("force") / canonical.D)
        speed = as_float(canonical.speed(sp.S.One))
        if width is None or speed is None:
            raise
        raise NoSolitaryWave(
            f"{refusal.reason}; this is the field of the first bead. In {CANONICAL}, V_s = "
            f"{speed:.6g} at B = 1 and the FWHM of the force is {width:.6g} D",
            closure="full",
            field="center",
        ) from None


# --- without load -------------------------------------------------------------------------------


def any_amplitude(chain: ChainInput, theory: Theory) -> Answer:
    """The compact wave of any amplitude: the speed V_s by the peak strain B, and B by V_s."""
    wave = _compact(theory)
    reduction = wave.reduction()
    rows: list[Row | str | Answer] = [
        chain.text,
        *closure_lines(theory),
        "v = u_x = B cos^(2/(k-1))(β ξ), ξ = x - V_s τ, on |ξ| ≤ π/(2β)",
        "",
        Row("beta", "β", wave.beta),
        Row("width", "width π/β", wave.width, symbol=r"\frac{\pi}{\beta}"),
    ]
    for q in QUANTITIES:
        rows.append(_width_row(q, wave.fwhm(q)))
    rows += [
        Row("B", "B", wave.amplitude()),
        Row("speed", "V_s", wave.speed()),
        f"  F_m ∝ V_s^({wave.force_exponent});  dx/dt = V_s · {wave.time_scale}",
        "",
        *_reduction_rows(reduction),
        *_canonical(chain, theory, None),
    ]
    shown: list[Shown | str] = [theory.pde, wave]
    shown += [reduction] if _is_short(reduction) else RELATIONS
    return Answer(settings_json(theory), rows, chain.scale, shown)


def _width_row(quantity: str, width: sp.Expr, time: bool = False) -> Row:
    """The row of a width in space or in time."""
    symbol = rf"\mathrm{{FWHM}}_{{\mathrm{{{quantity}}}}}"
    if time:
        label = f"FWHM of the {quantity} in time"
        return Row(f"fwhm_time.{quantity}", label, width, "s", rf"{symbol}^{{(t)}}")
    return Row(f"fwhm.{quantity}", f"FWHM of the {quantity}", width, "m", symbol)


RELATIONS = (
    r"(G + H + I) p^{2} - (H + 3 I) p + 2 I = 0",
    r"a = 1 - k p + 3 (p - 1) + p \frac{H}{I}",
    r"\mu = \frac{V_{s}^{2}}{I (p + a)}",
    r"\eta = 1 + p - k p",
    r"\sigma = \frac{1}{I (k p + a)}",
)
"""The oscillator's constants by G, H, I and p, the smaller root, in LaTeX."""


def _reduction_rows(reduction: Reduction) -> list[Row | str]:
    """Rows of the oscillator z'' = μ z^η - σ z; where p is long, of its relations to G, H, I."""
    names = ("p", "a", "mu", "eta", "sigma", "s")
    lines: list[Row | str] = ["v = z^p, integrating factor z^a: z'' = μ z^η - σ z"]
    short = _is_short(reduction)
    if not short:
        lines += [
            "  (G + H + I) p² - (H + 3 I) p + 2 I = 0, the smaller root;",
            "  a = 1 - k p + 3 (p - 1) + p H/I;  μ = V_s²/(I (p + a));  η = 1 + p - k p;",
            "  σ = 1/(I (k p + a));  s = 2/(1 - η)",
        ]
    for name in names:
        lines.append(Row(name, name if short else "", getattr(reduction, name)))
    return lines


def _is_short(reduction: Reduction) -> bool:
    return len(str(reduction.p)) <= LONG


def of_force(chain: ChainInput, theory: Theory, force: sp.Expr) -> Answer:
    """The compact wave of a peak contact force, in space and time."""
    wave = _compact(theory).at_force(force)
    rows: list[Row | str | Answer] = [
        "endless chain without load",
        *closure_lines(theory),
        chain.text,
        "",
        Row("force", "peak contact force F", wave.force, "N"),
        Row("B", "peak strain B", wave.strain),
        Row("compression", "peak compression", wave.compression, "m"),
        Row("speed", "speed dx/dt", wave.speed, "m/s"),
        Row("bead_velocity", "peak velocity of the beads", wave.bead_velocity, "m/s"),
    ]
    for q in QUANTITIES:
        rows.append(_width_row(q, wave.fwhm(q)))
    for q in QUANTITIES:
        rows.append(_width_row(q, wave.fwhm(q, "time"), time=True))
    rows += [
        Row("beta", "", wave.wave.beta, "1/m"),
        Row("width", "", wave.wave.width, "m", r"\frac{\pi}{\beta}"),
        *_canonical(chain, theory, wave.force),
    ]
    shown: list[Shown | str] = [wave.wave, wave]
    head: Values = settings_json(theory)
    notes = chain.hertz_notes(wave.force)
    return Answer(head, rows, chain.scale, shown, notes=notes)


def _canonical(
    chain: ChainInput, theory: Theory, force: sp.Expr | None
) -> list[Answer]:
    """Speed and widths of the canonical wave, beside those of the first bead's field.

    Without a force they are at B = 1, and the speed is V_s. Nothing for other fields, and for a
    chain or a force with symbols.
    """
    cell = chain.cell
    k = chain.law.exponent
    numbers = (k, *cell.masses, *cell.stiffnesses)
    if force is not None:
        numbers += (force,)
    if not depends_on_first(theory) or any(x.free_symbols for x in numbers):
        return []
    wave = canonical_wave(cell, k=k)
    rows: list[Row | str | Answer] = ["", f"{CANONICAL}:"]
    if force is None:
        at: Any = wave
        speed = Row("speed", "V_s at B = 1", wave.speed(sp.S.One))
    else:
        at = wave.at_force(force)
        speed = Row("speed", "speed dx/dt", at.speed, "m/s")
    widths = (_width_row(q, at.fwhm(q)) for q in QUANTITIES)
    for row in (speed, *widths):
        # A comparison needs no formula, and no LaTeX beside that of the field asked for.
        rows.append(replace(row, form="number", digits=TABLE_DIGITS, symbol=""))
    return [Answer({}, rows, chain.scale, key="canonical")]
