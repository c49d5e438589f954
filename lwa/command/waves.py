"""The command `lwa wave`: the lattice's own wave, the compact wave, and waves under load."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click
import sympy as sp

import lwa  # its names are loaded when they are used: waves under a load need NumPy
from lwa.base import latex
from lwa.base.exact import InputError, brief, number, read_exact
from lwa.base.frozen import Estimate, NoSolitaryWave
from lwa.base.words import EXTENTS, LANGUAGES, QUANTITIES, ExtentName
from lwa.command.answer import LONG, Answer, Lines, Row, Scale, Shows, attempt, rows_of
from lwa.command.chain import ChainInput
from lwa.command.derivation import closure_lines, depends_on_first, settings_json
from lwa.command.options import (
    BACKGROUND,
    FORCE,
    PRECOMPRESSION,
    SPHERES,
    THEORY,
    command,
    given,
)
from lwa.expansion.lattice_wave import LatticeWave, lattice_wave
from lwa.theory import Theory, homogenize
from lwa.wave.compact import CompactWave, canonical_wave

if TYPE_CHECKING:
    from lwa.cell import Cell
    from lwa.loaded.background import Background, KdV

CANONICAL = "the canonical field, whichever bead is the first"
"""Heading of the canonical wave beside the wave of a first field."""

SPEED = "speed dx/dt (m/s)"
"""Label of a speed in space and time, beside V_s in the time τ of the wave equation."""


@command(
    "lwa wave --k 3/2 --masses 0.45,0.123",
    "lwa wave --masses 1 --k 5/2 --spacing 1 --force 8 --precompression 1",
    "lwa wave --masses 1,2,3 --format latex",
    page="paper",
    languages=LANGUAGES,
)
@THEORY
@FORCE
@SPHERES
@BACKGROUND
@PRECOMPRESSION
def wave(
    chain: ChainInput, force: sp.Expr | None, background: sp.Expr | None, **options: Any
) -> Answer | str:
    """Compact traveling wave: β, width, FWHM, amplitude and speed.

    Beside it stands the lattice's own wave, the solitary wave of the beads' equations of motion,
    for equal beads, light beads between heavy ones and beads nearly alike: in JSON `lattice`. FWHM
    is the full width at half maximum.

    With --force the wave of this peak contact force, in space and time; with --spheres in m, s, kg
    and N. With --background or --precompression the wave in a chain under load, in the canonical
    field (--closure full --field center), and its Korteweg-de Vries limit for small amplitudes.

    A programming language as --format gives the source of functions that compute the wave without
    load.

    Without --force the floats in JSON are those at ``B = 1`` (speed) and at ``V_s = 1`` (B, mu),
    with --spheres at ``F = 1``, and D is the unit of length if D is a symbol. `speed` is ``V_s =
    dx/dτ``, and dx/dt with --force.
    """
    style = click.get_current_context().params["style"]
    # Options of which one says the other are not given together.
    load = chain.precompression if background is None else background
    # The compact wave is that of a power law. Under another law a load of zero is a load, too.
    loaded = bool(load) or not chain.law.homogeneous
    if loaded and load is None and force is None:
        raise InputError(
            f"law is {chain.law.text}: the compact wave is that of a power law; waves under a "
            "load or of a force have any law",
            background="1/10",
        )
    if loaded:
        _take_canonical(options)
    if style in LANGUAGES and (loaded or force is not None):
        raise InputError(
            f"--format {style} is that of a chain without load, whose functions take any force",
            format="text",
        )
    # The equation is derived for every answer: closure and settings stand in its head.
    theory = homogenize(chain.cell, law=chain.law, **options)
    if style in LANGUAGES:
        return _compact(theory).code(style)
    if force is None and (chain.file or loaded):
        # Numbers in SI are those of a force, and so are those under a load.
        force = read_exact("F", "force")
    if loaded and background is not None:
        return on_background(chain, theory, background)
    if loaded:
        return under_load(chain, theory, force)
    return compact(chain, theory, force)


def _take_canonical(options: dict[str, Any]) -> None:
    """Set the closure, the field and the branch of waves under load; refuse others."""
    canonical = {"closure": "full", "field": "center", "branch": "acoustic"}
    for name, wanted in canonical.items():
        # A default is no wish.
        if given(name) and options[name] != wanted:
            raise InputError(
                f"{name} is {options[name]!r}: under load the wave is that of the canonical field",
                **{name: wanted},
            )
    options |= canonical


def _compact(theory: Theory) -> CompactWave:
    """The compact wave of a theory; a refusal has the numbers of the canonical field."""
    try:
        return theory.pde.traveling_wave()
    except (InputError, NoSolitaryWave) as refusal:
        # Below order 4 there is no dispersion, and no wave in any field.
        if not depends_on_first(theory) or theory.order < 4:
            raise
        # Lengths in D, whatever the spacing is.
        wave = canonical_wave(replace(theory.cell, spacing=sp.S.One), theory.k)
        # Short enough to stand in one message with the line to paste.
        raise NoSolitaryWave(
            f"{refusal.reason}; in the canonical field V_s = {brief(wave.speed(1))} at B = 1, and "
            f"the FWHM of the force is {brief(wave.fwhm('force'))} D",
            closure="full",
            field="center",
        ) from None


# --- rows of all waves ---


def width_rows(wave: Any, extents: Sequence[ExtentName] = ("length",)) -> Iterator[Row]:
    """Rows of the widths of a wave; none under a load with symbols, where widths are numbers."""
    for extent in extents:
        for q in QUANTITIES:
            # A wave of any amplitude has no width in time, and its method no extent.
            arguments: list[str] = [q]
            key = f"fwhm.{q}"
            label = f"FWHM of the {q} (m)"
            symbol = latex.fwhm(q)
            if extent == "time":
                arguments.append(extent)
                key = f"fwhm_time.{q}"
                label = f"FWHM of the {q} in time (s)"
                symbol += "^{(t)}"
            row = Row.of(wave, "fwhm", label, *arguments, key=key, symbol=symbol)
            if isinstance(row.value, InputError):
                return
            yield row


def pulse_rows(wave: Any, prefix: str) -> Iterator[Row]:
    """Rows of the size, the speed and the widths of a wave.

    Parameters
    ----------
    wave : PhysicalWave or LoadedWave
        The wave of a peak force.
    prefix : str
        Words in front of "strain" and "compression": "peak", or under load "rise of the".
    """
    yield Row.of(wave, "force", "peak contact force F (N)")
    # B is the paper's letter of the peak strain.
    yield Row.of(wave, "strain", f"{prefix} strain B", key="B")
    yield from rows_of(
        wave,
        compression=f"{prefix} compression (m)",
        speed=SPEED,
        bead_velocity="peak velocity of the beads (m/s)",
    )
    yield from width_rows(wave, EXTENTS)


# --- without load -------------------------------------------------------------------------------


def compact(chain: ChainInput, theory: Theory, force: sp.Expr | None) -> Answer:
    """The compact wave of a peak contact force, or of any amplitude: V_s by B, and B by V_s.

    Its shape stands first. With a force its numbers in space and time follow, without one V_s by B
    and the paper's reduction. The canonical wave, where the field's wave depends on the first bead,
    and the lattice's own wave stand beside it.
    """
    wave = _compact(theory)
    rows: Lines = [
        chain.text,
        "the compact wave in a chain without load:",
        *closure_lines(theory),
        f"v = u_x = B cos^({wave.m})(β ξ), ξ = x - V_s τ, on |ξ| ≤ π/(2β)",
        "",
        *rows_of(wave, beta="β (1/m)", width="width π/β (m)"),
    ]
    shown: Shows = [theory.pde, wave]
    notes = []
    # A number of the size turns V_s and B into speed and strain in space and time.
    if force is not None:
        physical = wave.at_force(force)
        rows += pulse_rows(physical, "peak")
        shown = [wave, physical]
        notes = chain.hertz_notes(force)
    else:
        reduction = wave.reduction()
        rows += [
            *width_rows(wave),
            Row.of(wave, "amplitude", "B", key="B"),
            Row.of(wave, "speed", "V_s"),
            f"  F_m ∝ V_s^({wave.force_exponent});  dx/dt = V_s · {wave.time_scale}",
            "",
            "v = z^p, integrating factor z^a: z'' = μ z^η - σ z, s = 2/(1 - η)",
        ]
        # The root p of a symbolic dimer takes a page, and everything else is made of p.
        short = len(str(reduction.p)) <= LONG
        if short:
            shown.append(reduction)
        else:
            rows.append("  p, a, μ, η, σ and s are long: --format json has them")
        # A row without a label stands in JSON alone.
        for name in ("p", "a", "mu", "eta", "sigma", "s"):
            rows.append(Row.of(reduction, name, name if short else ""))
    if depends_on_first(theory):
        canonical = canonical_wave(theory.cell, theory.k)
        # `CompactWave.speed` gives V_s by B.
        part = _beside("canonical", CANONICAL, canonical, "speed", force, chain.scale)
        rows.append(part)
    notes += _put_lattice(rows, chain, force)
    return Answer(settings_json(theory), rows, chain.scale, shown, notes=notes)


_BEST = 0.25
"""Relative error below which the lattice's own wave stands before the compact wave.

The compact wave is wrong by a sixth at most where its error was measured: beside a wave with a
larger error than a quarter, the compact one may be the nearer one.
"""


def _put_lattice(rows: Lines, chain: ChainInput, force: sp.Expr | None) -> list[str]:
    """Put the lattice's own wave, where it is known, among the rows of the compact wave.

    The wave stands first, after the line on the chain, if all its errors are known and below
    `_BEST`; else it stands at the end. Returns a note where the lattice has no such wave.
    """
    cell = chain.cell
    if not cell.uniform and any(m.free_symbols for m in cell.masses):
        return []  # nobody knows which bead is light, if any
    try:
        wave = lattice_wave(cell, law=chain.law)
    except InputError:  # a cell without a closed form
        return []
    except NoSolitaryWave as reason:
        return [reason.reason]
    title = f"the lattice's own wave ({wave.theory})"
    part = _beside("lattice", title, wave, "scaled_speed", force, chain.scale)
    width = attempt(wave.estimate, "fwhm")  # the least accurate of the numbers
    if isinstance(width, Estimate) and width.relative_error < _BEST:
        rows[1:1] = [part, ""]
    else:
        rows.append(part)
    return []


def _beside(
    name: str,
    title: str,
    wave: CompactWave | LatticeWave,
    speed: str,
    force: sp.Expr | None,
    scale: Scale,
) -> Answer:
    """Speed and widths of another wave, at ``B = 1`` or at a force, there with momentum and energy.

    Parameters
    ----------
    name, title : str
        Name of the wave in JSON and LaTeX, and in text.
    wave : CompactWave or LatticeWave
        The wave.
    speed : str
        Name of the wave's method that gives V_s by B.
    force : Expr, optional
        The peak contact force.
    scale : Scale
        Units of the numbers.
    """
    # Widths in time need the speed of the wave, which a force fixes.
    if force is None:
        symbol = "V_{s}"
        first = Row.of(wave, speed, "V_s at B = 1", 1, key="speed", symbol=symbol)
        rows = [first, *width_rows(wave)]
    else:
        moving = wave.at_force(force)
        first = Row.of(moving, "speed", SPEED, symbol=latex.SPEED)
        rows = [first, *width_rows(moving, EXTENTS)]
        # The compact wave has no energy that its equation conserves in every field.
        if isinstance(moving, LatticeWave):
            momentum = Row.of(moving, "momentum", "momentum (N s)", symbol=r"\sum m v")
            rows += [momentum, Row.of(moving, "energy", "energy (J)", symbol="E")]
    lines: Lines = ["", f"{title}:"]
    for row in rows:
        # LaTeX has the compact wave's quantities of the same names, too.
        symbol = rf"{row.symbol}\big|_{{\mathrm{{{name}}}}}"
        lines.append(replace(row, symbol=symbol))
    return Answer({"theory": title}, lines, scale, errors=_ERRORS, key=name)


# --- under load ---

_ERRORS = "bound of the difference to waves of the lattice, by those that were measured"


def under_load(chain: ChainInput, theory: Theory, force: sp.Expr) -> Answer:
    """The wave of a peak contact force in a chain under a static force."""
    static = chain.precompression or sp.S.Zero
    wave = lwa.loaded_wave(
        chain.cell, force=force, precompression=static, law=chain.law
    )
    rows: Lines = [
        chain.text,
        "the wave in a chain under load:",
        *closure_lines(theory),
        "",
        *pulse_rows(wave, "rise of the"),
        *rows_of(
            wave,
            precompression="static force F0 (N)",
            background="static strain p0",
            static_compression="static compression (m)",
            sound_speed="speed of sound dx/dt (m/s)",
        ),
    ]
    notes = chain.hertz_notes(wave.force)
    return Answer(settings_json(theory), rows, chain.scale, [wave], _ERRORS, notes)


def on_background(chain: ChainInput, theory: Theory, p0: sp.Expr) -> Answer:
    """The waves on the strain p0: V_s by the rise B of the strain, and the limit of small waves."""
    field = lwa.loaded_wave(chain.cell, background=p0, law=chain.law).field
    speed = field.speed(field.rise)
    head = settings_json(theory) | {"background": field.p0, "speed": speed}
    rows: Lines = [
        chain.text,
        *closure_lines(theory),
        f"u_x = p0 + v(ξ), ξ = x - V_s τ, p0 = {field.p0}; v rises by B",
        "",
        f"  V_s = {speed}",
        f"  dx/dt = V_s · {field.time_scale}",
        *_unit_rise(field),
    ]
    shown: Shows = [field]
    # Small waves of a law without curvature have another equation, and a chain without load none.
    try:
        kdv = field.kdv
    except NoSolitaryWave as reason:
        head["kdv"] = None
        rows += ["", str(reason)]
    else:
        shown.append(kdv)
        rows += _small_waves(kdv)
    return Answer(head, rows, chain.scale, shown, _ERRORS)


def _unit_rise(field: Background) -> Iterator[Row | str]:
    """Rows of the wave whose strain rises by 1; none with symbols, or if there is none."""
    cell: Cell = field.cell
    place = "B = 1"
    # Errors are those of numbers: a spacing that is a symbol is the unit of length.
    if cell.spacing.is_Symbol:
        place += f", {cell.spacing} = 1"
        cell = cell.at(**{cell.spacing.name: 1})
    with suppress(NoSolitaryWave, InputError):
        wave = lwa.loaded_wave(cell, rise=1, background=field.p0, law=field.law)
        speed = Estimate(number(wave.field.speed(wave.strain)), 0.0)
        # V_s is dx/dt over an exact factor: the relative errors are the same.
        speed = speed.widened(wave.estimate("speed").relative_error)
        yield f"at {place}:"
        yield Row("speed", "V_s", speed)
        for row in width_rows(wave):
            # LaTeX has the waves of any rise alone.
            yield replace(row, symbol="")


def _small_waves(kdv: KdV) -> Lines:
    """Rows of the Korteweg-de Vries equation and its solitary wave."""
    # The limit is exact: its coefficients carry no error.
    equation = "small waves: v_τ + c0 v_x + α v v_x + γ v_xxx = 0, v = B sech²(ξ/L)"
    if kdv.rise.is_negative:
        equation += ", B < 0"
    return [
        "",
        equation,
        Row.of(kdv, "sound_speed", "c0", key="kdv.sound_speed"),
        Row.of(kdv, "nonlinearity", "α", key="kdv.nonlinearity"),
        Row.of(kdv, "dispersion", "γ", key="kdv.dispersion"),
        Row.of(kdv, "speed", "V_s of a small wave", key="kdv.speed", symbol="V_{s}"),
        Row.of(kdv, "width", "L", key="kdv.width", symbol="L"),
    ]
