"""The command `lwa wave`: the lattice's own wave, the compact wave, and waves under load."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click
import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, read_exact
from lwa.base.frozen import Estimate, NoSolitaryWave, Shown
from lwa.base.words import EXTENTS, LANGUAGES, QUANTITIES, ExtentName, QuantityName
from lwa.command.answer import (
    LONG,
    Answer,
    Form,
    Lines,
    Row,
    Scale,
    as_float,
    attempt,
    estimated,
)
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
from lwa.expansion.lattice_wave import LatticeWave, lattice_wave
from lwa.theory import Theory, homogenize
from lwa.wave.compact import CompactWave, canonical_wave
from lwa.wave.reduction import Reduction

if TYPE_CHECKING:
    from lwa.cell import Cell
    from lwa.loaded.background import Background, KdV

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

    Beside it stands the lattice's own wave, for equal beads, light beads between heavy ones and
    beads nearly alike: in JSON `lattice`.

    With --force the wave of this peak contact force, in space and time; with --spheres in m, s, kg
    and N. With --background or --precompression the wave in a chain under load, in the canonical
    field (--closure full --field center), and its Korteweg-de Vries limit for small amplitudes.

    A programming language as --format gives the source of functions that compute the wave without
    load.

    Without --force the floats in JSON are those at ``B = 1`` (speed) and at ``V_s = 1`` (B, mu),
    with D as the unit of length if D is a symbol. `speed` is ``V_s = dx/dτ``, and dx/dt with
    --force.
    """
    spheres = options["spheres"] is not None
    chain = take_chain(options)
    static = chain.load(precompression)
    # Options of which one says the other are not given together.
    load = static if background is None else background
    loaded = _is_loaded(chain, load, force)
    if loaded:
        _take_canonical(options)
    if style in LANGUAGES and (loaded or force is not None):
        raise InputError(
            f"--format {style} is that of a chain without load, whose functions take any force",
            format="text",
        )
    theory = homogenize(chain.cell, law=chain.law, **options)
    if style in LANGUAGES:
        click.echo(_compact(theory).code(style))
        return
    # Numbers in SI are those of a force; without one results hold the symbol F.
    peak = read_exact("F", "force") if force is None else force
    if loaded and background is not None:
        answer = on_background(chain, theory, background)
    elif loaded:
        answer = under_load(chain, theory, peak, static or sp.S.Zero)
    elif spheres or force is not None:
        answer = of_force(chain, theory, peak)
    else:
        answer = any_amplitude(chain, theory)
    answer.print(style)


def _is_loaded(chain: ChainInput, load: sp.Expr | None, force: sp.Expr | None) -> bool:
    """True if the wave is that of a chain under a load, or of a law that is no power.

    The compact wave is that of a power law. Under another law a load of zero is a load, too.
    """
    if chain.law.homogeneous:
        return load is not None and not load.is_zero
    if load is None and force is None:
        raise InputError(
            f"law is {chain.law.text}: the compact wave is that of a power law; waves under a "
            "load or of a force have any law",
            background="1/10",
        )
    return True


def _take_canonical(options: dict[str, Any]) -> None:
    """Set the closure, the field and the branch of waves under load; refuse others."""
    for name, wanted in (
        ("closure", "full"),
        ("field", "center"),
        ("branch", "acoustic"),
    ):
        # A default is no wish.
        if given(name) and options[name] != wanted:
            raise InputError(
                f"{name} is {options[name]!r}: under load the wave is that of the canonical field",
                **{name: wanted},
            )
        options[name] = wanted


def _compact(theory: Theory) -> CompactWave:
    """The compact wave of a theory; a refusal has the numbers of the canonical field."""
    try:
        return theory.pde.traveling_wave()
    except (InputError, NoSolitaryWave) as refusal:
        # Below order 4 there is no dispersion, and no wave in any field.
        if not depends_on_first(theory) or theory.order < 4:
            raise
        canonical = canonical_wave(theory.cell, theory.k)
        width = as_float(canonical.fwhm("force") / canonical.D)
        speed = as_float(canonical.speed(sp.S.One))
        if width is None or speed is None:  # symbols
            raise
        raise NoSolitaryWave(
            f"{refusal.reason}; this is the field of the first bead. In {CANONICAL}, V_s = "
            f"{speed:.6g} at B = 1 and the FWHM of the force is {width:.6g} D",
            closure="full",
            field="center",
        ) from None


# --- rows of all waves ---

_WIDTHS = {"length": ("fwhm", "", "m"), "time": ("fwhm_time", " in time", "s")}
"""Key in JSON, end of the label and unit of a width, by its extent."""


def width_row(
    quantity: QuantityName, width: Any, extent: ExtentName = "length", **settings: Any
) -> Row:
    """The row of a width; ``settings`` are further fields of the row."""
    key, end, unit = _WIDTHS[extent]
    symbol = rf"\mathrm{{FWHM}}_{{\mathrm{{{quantity}}}}}"
    if extent == "time":
        symbol += "^{(t)}"
    label = f"FWHM of the {quantity}{end}"
    return Row(f"{key}.{quantity}", label, width, unit, symbol, **settings)


def pulse_rows(wave: Any, rise: str, form: Form) -> Iterator[Row]:
    """Rows of the size, the speed and the widths of a wave.

    Parameters
    ----------
    wave : PhysicalWave or LoadedWave
        The wave of a peak force.
    rise : str
        What its strain is called: "peak", or "rise of the" static strain.
    form : {"both", "formula", "number"}
        What is shown of the widths.
    """
    speed = estimated(wave, "speed")
    yield Row("force", "peak contact force F", wave.force, "N")
    yield Row("B", f"{rise} strain B", wave.strain)
    yield Row("compression", f"{rise} compression", wave.compression, "m")
    yield Row("speed", "speed dx/dt", wave.speed, "m/s", estimate=speed)
    yield Row("bead_velocity", "peak velocity of the beads", wave.bead_velocity, "m/s")
    for extent in EXTENTS:
        for q in QUANTITIES:
            width = attempt(wave.fwhm, q, extent)
            if isinstance(width, InputError):  # under a load widths are numbers
                return
            error = estimated(wave, "fwhm", q, extent)
            yield width_row(q, width, extent, form=form, estimate=error)


# --- without load -------------------------------------------------------------------------------


def any_amplitude(chain: ChainInput, theory: Theory) -> Answer:
    """The compact wave of any amplitude: the speed V_s by the peak strain B, and B by V_s."""
    wave = _compact(theory)
    reduction = wave.reduction()
    rows: Lines = [
        chain.text,
        *closure_lines(theory),
        "v = u_x = B cos^(2/(k-1))(β ξ), ξ = x - V_s τ, on |ξ| ≤ π/(2β)",
        "",
        Row("beta", "β", wave.beta),
        Row("width", "width π/β", wave.width, symbol=r"\frac{\pi}{\beta}"),
    ]
    for q in QUANTITIES:
        rows.append(width_row(q, wave.fwhm(q)))
    rows += [
        Row("B", "B", wave.amplitude()),
        Row("speed", "V_s", wave.speed()),
        f"  F_m ∝ V_s^({wave.force_exponent});  dx/dt = V_s · {wave.time_scale}",
        "",
        *_reduction_rows(reduction),
        *_canonical(chain, theory, None),
    ]
    notes = _put_lattice(rows, chain, None)
    shown: list[Shown | str] = [theory.pde, wave]
    if _is_short(reduction):
        shown.append(reduction)
    else:
        shown += RELATIONS
    return Answer(settings_json(theory), rows, chain.scale, shown, notes=notes)


RELATIONS = (
    r"(G + H + I) p^{2} - (H + 3 I) p + 2 I = 0",
    r"a = 1 - k p + 3 (p - 1) + p \frac{H}{I}",
    r"\mu = \frac{V_{s}^{2}}{I (p + a)}",
    r"\eta = 1 + p - k p",
    r"\sigma = \frac{1}{I (k p + a)}",
)
"""The oscillator's constants by G, H, I and p, the smaller root, in LaTeX."""


def _reduction_rows(reduction: Reduction) -> Lines:
    """Rows of the oscillator z'' = μ z^η - σ z; where p is long, of its relations to G, H, I."""
    names = ("p", "a", "mu", "eta", "sigma", "s")
    lines: Lines = ["v = z^p, integrating factor z^a: z'' = μ z^η - σ z"]
    short = _is_short(reduction)
    if not short:
        lines += [
            "  (G + H + I) p² - (H + 3 I) p + 2 I = 0, the smaller root;",
            "  a = 1 - k p + 3 (p - 1) + p H/I;  μ = V_s²/(I (p + a));  η = 1 + p - k p;",
            "  σ = 1/(I (k p + a));  s = 2/(1 - η)",
        ]
    for name in names:
        # JSON has the values, however long.
        label = name if short else ""
        lines.append(Row(name, label, getattr(reduction, name)))
    return lines


def _is_short(reduction: Reduction) -> bool:
    return len(str(reduction.p)) <= LONG


def of_force(chain: ChainInput, theory: Theory, force: sp.Expr) -> Answer:
    """The compact wave of a peak contact force, in space and time."""
    wave = _compact(theory).at_force(force)
    rows: Lines = [
        chain.text,
        "the compact wave in a chain without load:",
        *closure_lines(theory),
        "",
        *pulse_rows(wave, "peak", "both"),
        Row("beta", "", wave.wave.beta, "1/m"),
        Row("width", "", wave.wave.width, "m", r"\frac{\pi}{\beta}"),
        *_canonical(chain, theory, wave.force),
    ]
    notes = _put_lattice(rows, chain, wave.force) + chain.hertz_notes(wave.force)
    shown: list[Shown | str] = [wave.wave, wave]
    return Answer(settings_json(theory), rows, chain.scale, shown, notes=notes)


_BEST = 0.25
"""Relative error from which on the compact wave, wrong by a sixth at most where that was measured,
may be as near to the lattice."""


def _put_lattice(rows: Lines, chain: ChainInput, force: sp.Expr | None) -> list[str]:
    """Put the lattice's own wave, where it is known, among the rows of the compact wave.

    Behind the line on the chain if every error is known and below `_BEST`, else at the end.
    Returns a note where the lattice has no such wave.
    """
    cell = chain.cell
    if not cell.uniform and any(m.free_symbols for m in cell.masses):
        return []  # nobody knows which bead is light, if any
    peak = sp.S.One if force is None else force
    try:
        wave = lattice_wave(cell, law=chain.law, force=peak)
    except InputError:  # a cell without a closed form
        return []
    except NoSolitaryWave as reason:
        return [reason.reason]
    part = _lattice(chain.scale, wave, force)
    measured = [row.measured for row in part.rows if isinstance(row, Row)]
    if all(found and found.relative_error < _BEST for found in measured):
        rows[1:1] = [part, ""]
    else:
        rows.append(part)
    return []


def _lattice(scale: Scale, wave: LatticeWave, force: sp.Expr | None) -> Answer:
    """Speed and widths of the lattice's own wave; without a force those at B = 1."""
    measured = wave
    if scale.spacing.is_Symbol:  # the unit of length
        measured = wave.at(**{scale.spacing.name: 1})
    if force is None:
        error = estimated(measured, "scaled_speed", 1)
        rows = [_speed_row(wave.scaled_speed(1), force, error)]
        extents = EXTENTS[:1]  # a time of passage is that of a force
    else:
        rows = [_speed_row(wave.speed, force, estimated(measured, "speed"))]
        extents = EXTENTS
        for name, unit, symbol in (
            ("momentum", "N s", r"\sum m v"),
            ("energy", "J", "E"),
        ):
            value = getattr(wave, name)
            error = estimated(measured, name)
            rows.append(Row(name, name, value, unit, symbol, estimate=error))
    for extent in extents:
        for q in QUANTITIES:
            error = estimated(measured, "fwhm", q, extent)
            rows.append(width_row(q, wave.fwhm(q, extent), extent, estimate=error))
    lines: Lines = ["", f"the lattice's own wave ({wave.theory}):"]
    for row in rows:
        # LaTeX has the compact wave's quantities of the same names, too.
        symbol = rf"{row.symbol}\big|_{{\mathrm{{lattice}}}}"
        lines.append(replace(row, symbol=symbol))
    return Answer({"theory": wave.theory}, lines, scale, errors=_ERRORS, key="lattice")


def _speed_row(
    speed: sp.Expr, force: sp.Expr | None, error: Estimate | None = None
) -> Row:
    """The row of a speed dx/dt, or without a force of V_s at B = 1."""
    if force is None:
        return Row("speed", "V_s at B = 1", speed, "", "V_{s}", estimate=error)
    return Row("speed", "speed dx/dt", speed, "m/s", latex.SPEED, estimate=error)


def _canonical(
    chain: ChainInput, theory: Theory, force: sp.Expr | None
) -> list[Answer]:
    """Speed and widths of the canonical wave, beside those of the first bead's field.

    Without a force they are at B = 1, and the speed is V_s. Nothing for other fields, and for a
    chain or a force with symbols.
    """
    cell = chain.cell
    k = chain.law.exponent
    numbers = [k, *cell.masses, *cell.stiffnesses]
    if force is not None:
        numbers.append(force)
    if not depends_on_first(theory) or any(x.free_symbols for x in numbers):
        return []
    wave = canonical_wave(cell, k=k)
    speed = wave.speed(sp.S.One)
    if force is not None:
        speed = wave.at_force(force).speed
    rows = [_speed_row(speed, force)]
    rows += [width_row(q, wave.fwhm(q)) for q in QUANTITIES]
    # A comparison needs no formula, and no LaTeX beside that of the field asked for.
    numeric = [replace(row, form="number", symbol="") for row in rows]
    lines: Lines = ["", f"{CANONICAL}:", *numeric]
    return [Answer({}, lines, chain.scale, key="canonical")]


# --- under load ---

_ERRORS = "bound of the difference to waves of the lattice, by those that were measured"


def under_load(
    chain: ChainInput, theory: Theory, force: sp.Expr, static: sp.Expr
) -> Answer:
    """The wave of a peak contact force in a chain under a static force."""
    from lwa.loaded.wave import loaded_wave  # here: it loads NumPy

    wave = loaded_wave(chain.cell, force=force, precompression=static, law=chain.law)
    rows: Lines = [
        chain.text,
        f"the wave in a chain under the load {static}:",
        *closure_lines(theory),
        "",
        *pulse_rows(wave, "rise of the", "number"),
        Row("precompression", "static force F0", wave.precompression, "N"),
        Row("background", "static strain p0", wave.background),
        Row("static_compression", "static compression", wave.static_compression, "m"),
        Row("sound_speed", "speed of sound dx/dt", wave.sound_speed, "m/s"),
    ]
    notes = chain.hertz_notes(wave.force)
    return Answer(settings_json(theory), rows, chain.scale, [wave], _ERRORS, notes)


def on_background(chain: ChainInput, theory: Theory, p0: sp.Expr) -> Answer:
    """The waves on the strain p0: V_s by the rise B of the strain, and the limit of small waves."""
    from lwa.loaded.background import Background  # here: it loads NumPy

    field = Background(chain.cell, chain.law, p0)
    head = settings_json(theory)
    rows: Lines = [
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


def _unit_rise(field: Background) -> Iterator[Row]:
    """Rows of the wave whose strain rises by 1; none with symbols, or if there is none."""
    from lwa.loaded.wave import loaded_wave

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
            width = wave.fwhm(q)
            row = width_row(q, width, form="number")
            yield replace(row, label=f"{row.label} at {place}", unit="", symbol="")


def _small_waves(kdv: KdV) -> Lines:
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
