"""The command `lwa dispersion`: the linear chain, and its bands under a load."""

from __future__ import annotations

from typing import Any

import click
import sympy as sp

from lwa.base import latex
from lwa.command.chain import take_chain
from lwa.command.derivation import listed
from lwa.command.options import PRECOMPRESSION, SPACING, given, series_options
from lwa.command.rows import PRINTED_DIGITS, Answer, Row, Values
from lwa.law import Power
from lwa.linear.dispersion import Dispersion, LoadedChain
from lwa.spheres.hertz import EXPONENT

PLACES = 8  # intervals of the wavenumbers, 0 to π/(PD), at which bands are printed


@click.command()
@series_options("1", "Highest power of κ in Ω², an integer.")
@PRECOMPRESSION
@SPACING
def dispersion(order: int, style: str, precompression: sp.Expr | None, **options: Any) -> None:
    """Expand the squared frequency Ω² of linear waves in the wavenumber κ.

    Ω is the frequency in the time τ of `lwa derive`, and κ the wavenumber, both times D. The
    exponent k matters for unequal contacts only, which share the strain by it.

    With --precompression also the bands and group velocities of the chain about this load, with k =
    3/2 unless --k is given: in rad/s and m/s for masses, stiffnesses and spacing in SI. In JSON
    `band_edges_value` has the frequencies (from, to) of each band, `gaps_value` those of each gap,
    and `branches_value` frequencies and group velocities by wavenumber (lengths in D where D is a
    symbol).
    """
    chain = take_chain(options)
    law, loaded = chain.law, None
    if precompression is not None:
        law = law if given("k") else Power(EXPONENT)
        loaded = LoadedChain(chain.cell, law, precompression)
    _answer(Dispersion(chain.cell, law.exponent), order, loaded).print(style)


def _answer(chain: Dispersion, order: int, loaded: LoadedChain | None) -> Answer:
    """Rows of both branches; ``optical`` is null unless the cell has two particles."""
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
    bands = _bands(loaded)
    rows += [
        "",
        f"about the load {loaded.precompression}, law {loaded.law.F}:",
        Row("precompression", "", loaded.precompression, "F_{0}", digits=False),
        Row("spring_constants", "spring constants", loaded.spring_constants, "K"),
        Row("sound_speed", "sound speed dx/dt", loaded.sound_speed, "c_{0}"),
        *_bands_text(bands),
    ]
    return Answer(head | bands, rows, spacing=cell.spacing, equations=equations)


def _bands(loaded: LoadedChain) -> Values:
    """Bands, gaps and branches in floats; {} if a mass or a spring constant is a symbol."""
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
