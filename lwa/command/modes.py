"""The commands `lwa dispersion` and `lwa envelope`: linear waves, and envelopes of their modes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

import lwa  # its names are loaded when they are used: `lwa dispersion` spares NumPy
from lwa.base.exact import InputError, positive
from lwa.base.words import BRANCHES, BranchName, one_of
from lwa.command.answer import Answer, Lines, Row, Shows, Values, rows_of
from lwa.command.chain import ChainInput
from lwa.command.options import (
    BACKGROUND,
    CELL,
    MASSES,
    PRECOMPRESSION,
    SPACING,
    SPHERES,
    STIFFNESSES,
    angle,
    command,
    exponent_option,
    given,
    order_option,
    value,
)
from lwa.law import Power
from lwa.linear.dispersion import Dispersion, LoadedChain
from lwa.spheres.hertz import EXPONENT


@command(
    "lwa dispersion --masses 3,1 --order 6",
    "lwa dispersion --masses 1,2 --precompression 1 --spacing 1",
    page="pressed",
)
@exponent_option("1")
@MASSES
@STIFFNESSES
@order_option("Highest power of κ in Ω², an integer.")
@PRECOMPRESSION
@SPACING
@SPHERES
def dispersion(chain: ChainInput, order: int) -> Answer:
    """Expand the squared frequency Ω² of linear waves in the wavenumber κ.

    Ω is the frequency in the time τ of `lwa derive`, and κ the wavenumber, both times D. The
    exponent k matters for unequal contacts only, whose shares of the strain depend on k.

    With --precompression also the bands about this load (``k = 3/2`` unless --k is given), in rad/s
    for masses, stiffnesses and spacing in SI, and with --spheres. In JSON `band_edges_value` has
    the frequencies (from, to) of each band, and `band_edges_frequency_value` these over 2π (Hz in
    SI).
    """
    precompression = chain.precompression
    # The series of equal contacts is that of any k; the bands are those of spheres then.
    if precompression is not None and not (chain.file or given("k")):
        chain = replace(chain, law=Power(EXPONENT))
    linear = Dispersion(chain.cell, chain.law.exponent)
    # null for a branch that has no series: readers find the same keys.
    series = linear.series(order)
    head: Values = {"acoustic": None, "optical": None} | series
    rows: Lines = [
        chain.text,
        "coefficients of Ω²(κ), κ = qD and Ω/D the frequency in τ",
        "",
        _series_lines(series),
    ]
    shown: Shows = [linear]
    if precompression is not None:
        loaded = LoadedChain(chain.cell, chain.law, precompression)
        shown.append(loaded)
        head["precompression"] = precompression
        rows += [
            "",
            "about the load:",
            Row("", "static force F0 (N)", precompression),
            *rows_of(
                loaded,
                spring_constants="spring constants (N/m)",
                sound_speed="sound speed dx/dt (m/s)",
            ),
        ]
        # Edges are roots, which have no closed form beyond two masses.
        numbers = sp.Tuple(*chain.cell.masses, *loaded.spring_constants)
        if not numbers.free_symbols:
            edges = loaded.bands.edges()
            frequencies = edges / (2 * math.pi)
            head["band_edges_value"] = edges.tolist()
            head["band_edges_frequency_value"] = frequencies.tolist()
            # Text has Hz for a chain in SI. Other chains have no unit of time, and rad.
            shown_edges = frequencies if chain.si else edges
            unit = " (Hz)" if chain.si else ", in rad per unit of time"
            for i, band in enumerate(shown_edges, start=1):
                rows.append(Row("", f"band {i}{unit}", tuple(map(sp.Float, band))))
    return Answer(head, rows, chain.scale, shown)


def _series_lines(branches: Mapping[str, Mapping[int, sp.Expr]]) -> Iterator[str]:
    """Lines of text with the coefficients of each branch, exact, one a line."""
    for name, series in branches.items():
        yield f"{name}:"
        for n, c in series.items():
            power = f"κ^{n}" if n else "1"
            yield f"  {power}: {c}"


def _branch(text: str, name: str) -> BranchName | int:
    """Read a branch by its name or its number."""
    # Cells of many beads have more branches than names.
    if text.isdecimal():
        return int(text)
    return one_of(text, BRANCHES, name)


@command(
    "lwa envelope --masses 1,1/2 --k 3/2 --precompression 1 --detuning 1/1000",
    "lwa envelope --masses 1 --k 2 --background 1 --wavenumber pi/3",
    page="modes",
)
@CELL
@SPHERES
@BACKGROUND
@PRECOMPRESSION
@value(
    "--wavenumber",
    "Wavenumber κ per cell, 0 … pi: a number, a name, or a part of pi such as pi/3.",
    "pi/3",
    angle,
    "pi",
)
@value(
    "--branch",
    "Branch of the mode: acoustic, optical, or its number from 0.  [default: optical; acoustic for "
    "equal beads]",
    "acoustic",
    _branch,
    metavar="NAME|N",
)
@value(
    "--frequency",
    "Frequency f of a breather: in Hz if the chain is in SI, else in radians per time.",
    "2.4",
    positive,
)
@value(
    "--detuning",
    "Relative detuning 1 - f/f0 of a breather from the band's edge f0, in place of --frequency.",
    "1/1000",
)
def envelope(
    chain: ChainInput,
    background: sp.Expr | None,
    frequency: sp.Expr | None,
    detuning: sp.Expr | None,
    **mode: Any,
) -> Answer:
    """Nonlinear Schrödinger equation of a mode of a loaded chain, and its breathers.

    Needs --background or --precompression. With --frequency or --detuning also the breather of
    this frequency, a standing envelope whose mode is at the edge of a band.

    Wavenumbers and lengths are in cells, frequencies in radians per unit of time; with --spheres
    frequencies are in Hz, displacements in m and forces in N. In JSON `amplitude` is the largest
    displacement of each bead, and `width` is 1/b of the envelope sech(bn) or tanh(bn).
    """
    # `mode` holds the wavenumber and the branch. Without a load nothing is linear, and no mode
    # exists.
    if background is None and chain.precompression is None:
        raise InputError(
            "neither --background nor --precompression is given: a mode is that of a loaded chain",
            precompression=1,
        )
    equation = lwa.envelope(
        chain.cell,
        law=chain.law,
        background=background,
        precompression=chain.precompression,
        **mode,
    )
    # Theory has radians; sensors and the literature have Hz where there is a second.
    turn = sp.S.One
    frequency_label = "frequency ω"
    if chain.si:
        turn = 2 * sp.pi
        frequency_label = "frequency ω/(2π) (Hz)"
    head: Values = {"branch": str(equation.branch), "kind": None}
    try:
        head["kind"] = equation.kind
        described = f"  {equation.kind} envelopes"
    except InputError as unknown:  # it depends on the values of symbols
        described = f"  bright or dark: {unknown}"
    rows: Lines = [
        chain.text,
        "u = Ψ(X, T) U e^{i(κ n - ω t)} + c.c., Σ m |U|² = 1, n and κ per cell",
        "i Ψ_T + ½ ω'' Ψ_XX = χ |Ψ|² Ψ",
        "",
        Row.of(equation, "wavenumber", "κ"),
        Row("frequency", frequency_label, equation.frequency / turn),
        *rows_of(
            equation,
            group_velocity="dω/dκ (cells/s)",
            dispersion="ω'' (cells²/s)",
            nonlinearity="χ (1/(s kg m²))",
        ),
        described,
    ]
    shown: Shows = [equation]
    # A breather is one solution of the equation: that of a frequency.
    if frequency is not None or detuning is not None:
        angular = frequency and frequency * turn
        breather = equation.breather(angular, detuning=detuning)
        shown.append(breather)
        # Bright and dark envelopes of the cubic equation have these shapes.
        shape = {"bright": "sech", "dark": "tanh"}[breather.kind]
        rows += [
            "",
            f"{breather.kind} breather, |Ψ| = a {shape}(b n):",
            Row("breather_frequency", frequency_label, breather.frequency / turn),
            *rows_of(
                breather,
                detuning="detuning Δ = 1 - f/f0",
                amplitude="largest displacement by bead (m)",
                width="width 1/b in cells",
            ),
        ]
    return Answer(head, rows, chain.scale, shown)
