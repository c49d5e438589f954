"""The commands `lwa dispersion` and `lwa envelope`: linear waves, and envelopes of their modes."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import click
import sympy as sp

from lwa.base.exact import InputError
from lwa.base.frozen import Shown
from lwa.command.chain import take_chain
from lwa.command.options import (
    BACKGROUND,
    PRECOMPRESSION,
    SPACING,
    SPHERES,
    angle,
    cell_options,
    given,
    reader,
    series_options,
    value,
)
from lwa.command.rows import PRINTED_DIGITS, Answer, Row, Values
from lwa.law import Power
from lwa.linear.dispersion import Dispersion, LoadedChain
from lwa.spheres.hertz import EXPONENT


@click.command()
@series_options("1", "Highest power of κ in Ω², an integer.")
@PRECOMPRESSION
@SPACING
@SPHERES
def dispersion(
    order: int, style: str, precompression: sp.Expr | None, **options: Any
) -> None:
    """Expand the squared frequency Ω² of linear waves in the wavenumber κ.

    Ω is the frequency in the time τ of `lwa derive`, and κ the wavenumber, both times D. The
    exponent k matters for unequal contacts only, whose shares of the strain depend on k.

    With --precompression also the bands about this load (k = 3/2 unless --k is given), in rad/s
    for masses, stiffnesses and spacing in SI, and with --spheres. In JSON `band_edges_value` has
    the frequencies (from, to) of each band, and `band_edges_frequency_value` these over 2π (Hz in
    SI).
    """
    spheres = options["spheres"] is not None
    chain = take_chain(options)
    precompression = chain.load(None, precompression)
    if precompression is not None and not (spheres or given("k")):
        chain = replace(chain, law=Power(EXPONENT))
    linear = Dispersion(chain.cell, chain.law.exponent)
    rows: list[Row | str] = [
        chain.text,
        "Ω²(κ), κ = qD and Ω/D the frequency in τ",
        "",
    ]
    head: Values = {"acoustic": None, "optical": None}
    for name, series in linear.series(order).items():
        head[name] = {str(n): str(c) for n, c in series.items()}
        rows += [
            f"{name}:",
            *(f"  {f'κ^{n}' if n else '1'}: {c}" for n, c in series.items()),
        ]
    if precompression is None:
        Answer(head, rows, shown=[linear]).print(style)
        return
    loaded = LoadedChain(chain.cell, chain.law, precompression)
    rows += [
        "",
        f"about the load {precompression}:",
        Row("precompression", "", precompression, digits=0),
        Row("spring_constants", "spring constants", loaded.spring_constants, "N/m"),
        Row("sound_speed", "sound speed dx/dt", loaded.sound_speed, "m/s"),
    ]
    numbers = (*chain.cell.masses, *loaded.spring_constants)
    if not any(x.free_symbols for x in numbers):
        edges = loaded.bands.edges()
        head["band_edges_value"] = edges.tolist()
        head["band_edges_frequency_value"] = (edges / (2 * math.pi)).tolist()
        unit = "s" if chain.si else "unit of time"
        for i, (low, high) in enumerate(edges, start=1):
            hertz = (
                f" ({low / (2 * math.pi):.6g} … {high / (2 * math.pi):.6g} Hz)"
                * chain.si
            )
            band = f"{low:.{PRINTED_DIGITS}g} … {high:.{PRINTED_DIGITS}g}"
            rows.append(f"  band {i}: {band}, in rad per {unit}{hertz}")
    Answer(head, rows, chain.si, chain.cell.spacing, [linear, loaded]).print(style)


@click.command()
@cell_options()
@SPHERES
@BACKGROUND
@PRECOMPRESSION
@value(
    "--wavenumber",
    "Wavenumber κ per cell, 0 … pi: a number, a name, or a part of pi such as pi/3.",
    "pi",
    reader(angle),
)
@click.option(
    "--branch",
    metavar="NAME|N",
    help="Branch of the mode: acoustic, optical, or its number from 0.  [default: optical; "
    "acoustic for equal beads]",
)
@value(
    "--frequency",
    "Frequency f of a breather: in Hz if the chain is in SI, else in radians per time.",
)
@value(
    "--detuning",
    "Relative detuning 1 - f/f0 of a breather from the band's edge f0, in place of --frequency.",
)
def envelope(
    style: str,
    background: sp.Expr | None,
    precompression: sp.Expr | None,
    wavenumber: sp.Expr,
    branch: str | None,
    frequency: sp.Expr | None,
    detuning: sp.Expr | None,
    **options: Any,
) -> None:
    """Nonlinear Schrödinger equation of a mode of a loaded chain, and its breathers.

    Needs --background or --precompression. With --frequency or --detuning also the breather of
    this frequency, a standing envelope whose mode is at the edge of a band.

    Wavenumbers and lengths are in cells, frequencies in radians per unit of time; with --spheres
    frequencies are in Hz, displacements in m and forces in N. In JSON `amplitude` is the largest
    displacement of each bead, and `width` is 1/b of the envelope sech(bn) or tanh(bn).
    """
    from lwa.envelopes import (
        schrodinger,
    )  # here: it loads NumPy, which `lwa dispersion` may spare

    if frequency is not None and detuning is not None:
        raise InputError(
            "--frequency and --detuning are both given: one says the other"
        )
    chain = take_chain(options)
    cell = chain.cell
    place: Any = int(branch) if branch and branch.isdecimal() else branch
    load = {
        "background": background,
        "precompression": chain.load(background, precompression),
    }
    equation = schrodinger.envelope(
        cell, law=chain.law, **load, wavenumber=wavenumber, branch=place
    )
    turn = 2 * sp.pi if chain.si else sp.S.One
    name = "ω/(2π)" if chain.si else "ω"
    rows: list[Row | str] = [
        chain.text,
        "u = Ψ(X, T) U e^{i(κ n - ω t)} + c.c., Σ m |U|² = 1, n and κ per cell",
        "i Ψ_T + ½ ω'' Ψ_XX = χ |Ψ|² Ψ",
        "",
        Row("wavenumber", "κ", equation.wavenumber, digits=0),
        Row("frequency", f"frequency {name}", equation.frequency / turn, "Hz"),
        Row("group_velocity", "dω/dκ", equation.group_velocity, "cells/s"),
        Row("dispersion", "ω''", equation.dispersion, "cells²/s"),
        Row("nonlinearity", "χ", equation.nonlinearity, "1/(s kg m²)"),
    ]
    head: dict[str, str | None] = {"branch": str(equation.branch), "kind": None}
    try:
        head["kind"] = equation.kind
        rows.append(f"  {equation.kind} envelopes")
    except InputError as fault:
        rows.append(f"  bright or dark: {fault}")
    shown: list[Shown] = [equation]
    if frequency is not None or detuning is not None:
        breather = equation.breather(frequency and frequency * turn, detuning=detuning)
        shown.append(breather)
        shape = "sech" if breather.kind == "bright" else "tanh"
        rows += [
            "",
            f"{breather.kind} breather, |Ψ| = a {shape}(b n):",
            Row(
                "breather_frequency",
                f"frequency {name}",
                breather.frequency / turn,
                unit="Hz",
            ),
            Row("detuning", "detuning Δ = 1 - f/f0", breather.detuning),
            Row("amplitude", "largest displacement by bead", breather.amplitude, "m"),
            Row("width", "width 1/b in cells", breather.width),
        ]
    Answer(head, rows, chain.si, cell.spacing, shown).print(style)
