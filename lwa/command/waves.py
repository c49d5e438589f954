"""Traveling waves as rows: the compact wave, the wave of a given force, waves under load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lwa.base.exact import InputError, exact
from lwa.base.quantities import QUANTITIES, NoSolitaryWave
from lwa.cell import Cell
from lwa.command.derivation import FIELDS, chain_json, chain_text, listed
from lwa.command.options import ChainInput
from lwa.command.reserved_names import demand_free
from lwa.command.rows import Answer, Row, Values, attempt
from lwa.theory import Theory
from lwa.wave.background import BackgroundWave
from lwa.wave.physical import PrecompressedWave
from lwa.wave.traveling import TravelingWave

RADIATES = 0.05
"""Bound of `lwa.Radiation` on c² and the widths from which on a note is printed: for dimers of
spheres m2/m1 = 0.06 … 0.73."""


def radiation_note(cell: Cell, k: sp.Expr) -> list[str]:
    """A note on the radiation of unlike beads, if its bound exceeds `RADIATES`."""
    if k.free_symbols or len({*cell.masses}) == len({*cell.stiffnesses}) == 1:
        return []
    from lwa.expansion.radiation import radiation  # here, for a quick start of the others

    found = radiation(cell, k)
    lost = found.relative(float(k)) if found else 0.0
    if lost < RADIATES:
        return []
    return [
        "between isolated mass ratios these unlike beads have no true solitary wave: a pulse "
        f"radiates and decays, which the theory leaves out (bound on speed² and widths: {lost:.0%})"
        "; the force of a contact may have several humps, of which a width is the highest one's"
    ]


WIDTHS = (("fwhm", "FWHM of the {}", "length"), ("fwhm_time", "FWHM of the {} in time", "time"))
"""Key, label and extent of the widths of a wave with units."""


def _fwhm(wave: Any, *extent: str) -> dict[str, sp.Expr]:
    return {quantity: wave.fwhm(quantity, *extent) for quantity in QUANTITIES}


def _fwhm_rows(key: str, label: str, widths: Mapping[str, sp.Expr], **settings: Any) -> list[Row]:
    symbol = r"\mathrm{{FWHM}}_{{\mathrm{{{}}}{}}}"
    of_time = r",\,\tau" if "time" in key else ""
    return [
        Row(f"{key}.{q}", label.format(q), width, symbol.format(q, of_time), **settings)
        for q, width in widths.items()
    ]


def compact(theory: Theory, wave: TravelingWave) -> Answer:
    """Return the rows of `lwa wave`: the compact wave for a general peak force.

    Floats are for V_s = 1 (B, mu) and for B = 1 (speed).
    """
    one, other = (wave.reduction(root) for root in (0, 1))
    names = ("p", "a", "mu", "eta", "sigma", "s")

    def roots() -> list[dict[str, str]]:
        return [{name: str(getattr(r, name)) for name in names} for r in (one, other)]

    log_B = -sp.log(wave.speed_factor) / (wave.k - 1)
    rows: list[Row | str] = [
        f"masses {listed(theory.cell.masses)}; k = {wave.k}; closure {theory.closure.name}; "
        + FIELDS[theory.closure.field],
        "v = u_x = B cos^(2/(k-1))(β ξ), ξ = x - V_s τ, on |ξ| ≤ π/(2β)",
        "",
        Row("beta", "β", wave.beta, r"\beta"),
        Row("width", "width π/β", wave.width, "L"),
        *_fwhm_rows("fwhm", "FWHM of the {}", _fwhm(wave)),
        Row("B", "B", wave.amplitude(), "B"),
        Row("speed", "V_s", wave.speed(), "V_{s}"),
        f"  F_m ∝ V_s^({wave.force_exponent});  dx/dt = V_s · {wave.speed_scale}",
        Row("speed_factor", "", wave.speed_factor, number=None),
        Row("time_scale", "", wave.speed_scale, r"\mathrm{d}x/\mathrm{d}t / V_{s}", number=None),
        Row("log_B", "", log_B, expression=False),
        "",
        "v = z^p, integrating factor z^a: z'' = μ z^η - σ z",
        *_reduction_rows(theory, one),
        Row("", "the other root, p", other.p),
        Row("", "with a", other.a),
    ]
    notes = radiation_note(theory.cell, wave.k)
    return Answer(chain_json(theory) | {"roots": roots}, rows, spacing=wave.D, notes=notes)


def _reduction_rows(theory: Theory, found: Any) -> list[Row]:
    """Rows of p, a, μ, η, σ and s; long ones in LaTeX by p, a, H and I, as in the paper."""
    formulas = {
        "a": r"1 - k p + 3 (p - 1) + \frac{p H}{I}",
        "mu": r"\frac{V_{s}^{2}}{I (p + a)}",
        "eta": "1 + p - k p",
        "sigma": r"\frac{1}{I (k p + a)}",
        "s": r"\frac{2}{1 - \eta}",
    }
    rows = [
        Row(name, name, getattr(found, name), symbol, formula=formulas.get(name, ""))
        for name, symbol in _SYMBOLS.items()
    ]
    found_terms = theory.pde.third_order
    return rows + [Row("", "", found_terms[name], name) for name in "HI"]


_SYMBOLS = {"p": "p", "a": "a", "mu": r"\mu", "eta": r"\eta", "sigma": r"\sigma", "s": "s"}


def at_force(theory: Theory, wave: TravelingWave, F: sp.Expr, units: Mapping[str, str]) -> Answer:
    """Return the rows of `lwa wave --force F`: the compact wave of peak contact force F.

    B is the peak strain of this wave, V_s = dx/dτ and ``speed`` = dx/dt. ``compressions`` has the
    peak compression of each contact, ``compression`` the mean. ``fwhm`` and ``fwhm_time`` are the
    widths in space and time.
    """
    cell, answer = theory.cell, wave.at_force(F)
    rows: list[Row | str] = [
        f"closure {theory.closure.name}; {FIELDS[theory.closure.field]}",
        f"contact force F = A δ^k, k = {theory.k}; an endless chain without load",
        *_chain_rows(cell, units),
        "",
        Row("force", "peak contact force F", answer.force, "F"),
        Row("strain", "peak strain B", answer.strain),
        Row("compression", "", answer.compression, r"\delta"),
        Row("compressions", "peak compression", answer.compressions),
        Row("speed", "speed dx/dt", answer.speed, r"\mathrm{d}x/\mathrm{d}t"),
        Row("bead_velocity", "peak velocity of the beads", answer.bead_velocity, "u_{t}"),
        *(row for key, label, e in WIDTHS for row in _fwhm_rows(key, label, _fwhm(answer, e))),
        Row("beta", "", wave.beta, r"\beta"),
        Row("width", "", wave.width, "L"),
        Row("speed_factor", "", wave.speed_factor),
        Row("time_scale", "", wave.speed_scale, r"\mathrm{d}x/\mathrm{d}t / V_{s}"),
        Row("B", "", answer.strain, "B"),
        Row("V_s", "", wave.speed(answer.strain), "V_{s}"),
    ]
    notes = radiation_note(cell, wave.k)
    return Answer(chain_json(theory), rows, units, wave.D, notes=notes)


def _chain_rows(cell: Cell, units: Mapping[str, str]) -> list[Row]:
    """Rows of masses, stiffnesses and spacing; without units not in JSON, whose head has them."""
    named = (
        ("masses", "masses", cell.masses, "m"),
        ("stiffnesses", "A", cell.stiffnesses, "A"),
        ("spacing", "spacing D", cell.spacing, "D"),
    )
    if units:
        return [Row(*parts) for parts in named]
    return [Row("", label, value) for _, label, value, _ in named]


def on_background(theory: Theory, wave: BackgroundWave) -> Answer:
    """Return the rows of `lwa wave --background P0`: the waves on the strain p0.

    In such a wave the strain rises from p0 to p0 + B at its peak and travels at V_s = dx/dτ.
    ``speed`` is V_s as a function of p0 and B. ``kdv`` is the Korteweg–de Vries limit of small B,
    the wave v = B sech²(ξ/L) of width L; it is null if the speed of sound is zero. Floats are for
    B = 1, and are left out if the wave of B = 1 does not exist.
    """
    head: Values = chain_json(theory)
    speed, widths = _at_one(wave)
    rows: list[Row | str] = [
        chain_text(theory),
        FIELDS[theory.closure.field],
        f"u_x = p0 + v(ξ), ξ = x - V_s τ, p0 = {wave.p0}; v rises by B",
        "",
        Row("background", "", wave.p0, "p_{0}", number=None),
        Row("I", "", wave.I, "I", number=None),
        Row("speed", "V_s", wave.speed(), "V_{s}", number=None),
        Row("time_scale", "dx/dt over V_s", wave.time_scale, _SCALE, number=None),
    ]
    if speed is not None:
        rows.append(Row("speed", "V_s at B = 1", sp.S.Zero, number=speed, expression=False))
    rows += _fwhm_rows("fwhm", "FWHM of the {} at B = 1", widths, expression=False)
    try:
        kdv = wave.kdv
    except NoSolitaryWave as reason:
        head["kdv"] = None
        rows += ["", str(reason)]
    else:
        rows += [
            "",
            "small waves: v_τ + c0 v_x + α v v_x + γ v_xxx = 0, v = B sech²(ξ/L)",
            Row("kdv.sound_speed", "c0", kdv.sound_speed, "c_{0}"),
            Row("kdv.nonlinearity", "α", kdv.nonlinearity, r"\alpha"),
            Row("kdv.dispersion", "γ", kdv.dispersion, r"\gamma"),
            Row("kdv.speed", "V_s of a small wave", kdv.speed(), r"V_{s} (B \to 0)"),
            Row("kdv.width", "L", kdv.width(), "L"),
        ]
    return Answer(head, rows, spacing=wave.cell.spacing)


_SCALE = r"\mathrm{d}x/\mathrm{d}t / V_{s}"


def _at_one(wave: BackgroundWave) -> tuple[sp.Expr | None, dict[str, sp.Expr]]:
    """Speed and widths of the wave of B = 1; (None, {}) without a wave or with symbols."""
    try:
        speed = wave.speed(1)
        if speed.free_symbols - {wave.cell.spacing}:
            return None, {}
        return speed, {q: wave.fwhm(1, q) for q in QUANTITIES}
    except NoSolitaryWave:
        return None, {}
    except InputError:
        return speed, {}


def precompressed(theory: Theory, wave: PrecompressedWave, units: Mapping[str, str]) -> Answer:
    """Return the rows of `lwa wave --precompression F0 --force F`: the wave under a load.

    ``speed`` and ``sound_speed`` are dx/dt, V_s is dx/dτ; ``background`` is the strain under the
    load, B the rise of the strain in the wave, ``compressions`` the rises of the cell's contacts.
    Widths are numbers, lengths and (``fwhm_time_value``) times.
    """
    rows: list[Row | str] = [
        chain_text(theory) if not units else f"contact force F = A δ^k, k = {theory.k}",
        FIELDS[theory.closure.field],
        *(_chain_rows(theory.cell, units) if units else []),
        "",
        Row("precompression", "static force F0", wave.precompression, "F_{0}"),
        Row("force", "peak contact force F, in all", wave.force, "F"),
        Row("background", "static strain p0", wave.background.p0, "p_{0}"),
        Row("static_compression", "static compression", wave.static_compression, r"\delta_{0}"),
        Row("B", "rise of the strain B", wave.strain, "B"),
        Row("compression", "rise of the compression", wave.compression, r"\delta - \delta_{0}"),
        Row("compressions", "rise by contact", wave.compressions),
        Row("V_s", "V_s", wave.background.speed(wave.strain), "V_{s}"),
        Row("time_scale", "dx/dt over V_s", wave.background.time_scale, _SCALE),
        Row("speed", "speed dx/dt", wave.speed, r"\mathrm{d}x/\mathrm{d}t"),
        Row("sound_speed", "speed of sound dx/dt", wave.sound_speed, r"c_{0}"),
        Row("bead_velocity", "peak velocity of the beads", wave.bead_velocity, "u_{t}"),
    ]
    for key, label, extent in WIDTHS:
        if not isinstance(widths := attempt(_fwhm, wave, extent), InputError):  # no symbols
            rows += _fwhm_rows(key, label, widths, expression=False)
    return Answer(chain_json(theory), rows, units, theory.cell.spacing)


@dataclass(frozen=True)
class Load:
    """Options that say how strongly a chain is pressed and which wave runs in it."""

    force: sp.Expr | None
    background: sp.Expr | None
    precompression: sp.Expr | None

    def under(self, other: bool) -> bool:
        """True if the wave runs under a load; 0 is a load if the law is no power (``other``).

        Raises `lwa.InputError` for two loads.
        """
        if self.background is not None and self.precompression is not None:
            raise InputError("--background and --precompression are both given: one says the other")
        load = self.precompression if self.background is None else self.background
        return load is not None and (other or not load.is_zero)

    def demand_free(self, output: str) -> None:
        """Refuse symbols with names of the output."""
        named = ((self.force, "F"), (self.precompression, "F0"), (self.background, "p0"))
        for value, own in named:
            demand_free(output, () if value is None else (value,), own)


def peak(force: sp.Expr | None) -> sp.Expr:
    """The force of a wave; the symbol F where none is given."""
    return exact("F", "force") if force is None else force


def under_load(theory: Theory, load: Load, units: dict[str, str]) -> Answer:
    """The wave under a load as rows."""
    if load.precompression is not None:
        F, F0 = peak(load.force), load.precompression
        return precompressed(theory, PrecompressedWave(theory.cell, theory.law, F, F0), units)
    if load.force is not None:
        raise InputError("--force goes with --precompression, a force; --background is a strain")
    return on_background(theory, BackgroundWave(theory.cell, theory.law, load.background))


def source(theory: Theory, load: Load | None, language: str) -> str:
    """The wave as source text; of a chain without load where ``load`` is None."""
    if load is None:
        return theory.pde.traveling_wave().code(language)
    p0 = load.background
    if load.precompression is not None:
        loaded = PrecompressedWave(theory.cell, theory.law, exact("F", "F"), load.precompression)
        p0 = loaded.background.p0
    return BackgroundWave(theory.cell, theory.law, p0).code(language)


def left_out(chain: ChainInput) -> list[str]:
    """A note that the load of a file does not enter."""
    if not chain.precompression:
        return []
    said = f"{float(chain.precompression):g} {chain.units.get('force', '')}".rstrip()
    return [f"the load of the file, {said}, is left out: the theory used is of a chain without"]
