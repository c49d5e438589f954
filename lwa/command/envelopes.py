"""Envelopes of a mode of a loaded chain, and breathers, as rows: `lwa envelope`."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from lwa.base.exact import InputError
from lwa.command.rows import Answer, Row
from lwa.envelopes.breather import Breather
from lwa.envelopes.schrodinger import Envelope


def envelope(
    found: Envelope, breather: Breather | None, units: Mapping[str, str], spoken: str
) -> Answer:
    """The nonlinear Schrödinger equation of a mode, and the breather of a frequency.

    Wavenumbers and lengths are in cells, frequencies in radians per unit of time, for a chain in
    SI in Hz. ``amplitude`` is the largest displacement of each bead, ``width`` 1/b of the envelope
    sech(bn) or tanh(bn), ``opening_load`` the static force at which contacts begin to open if the
    frequency, or the amplitude, is held.

    spoken : the chain in text.
    """
    turn = 2 * sp.pi if units else sp.S.One
    name, symbol = ("ω/(2π)", r"\omega / 2 \pi") if units else ("ω", r"\omega")
    rows: list[Row | str] = [
        spoken,
        "u = Ψ(X, T) U e^{i(κ n - ω t)} + c.c., Σ m |U|² = 1, n and κ per cell",
        "i Ψ_T + ½ ω'' Ψ_XX = χ |Ψ|² Ψ",
        "",
        Row("wavenumber", "κ", found.wavenumber, r"\kappa", number=None),
        Row("frequency", f"frequency {name}", found.frequency / turn, symbol),
        Row("group_velocity", "dω/dκ", found.group_velocity, r"\omega'"),
        Row("dispersion", "ω''", found.dispersion, r"\omega''"),
        Row("nonlinearity", "χ", found.nonlinearity, r"\chi"),
    ]
    head: dict[str, str | None] = {"branch": str(found.branch), "kind": None}
    try:
        head["kind"] = found.kind
        rows.append(f"  {found.kind} envelopes")
    except InputError as fault:
        rows.append(f"  bright or dark: {fault}")
    notes: list[str] = []
    if breather is not None:
        shape = "sech" if breather.kind == "bright" else "tanh"
        rows += [
            "",
            f"{breather.kind} breather, |Ψ| = a {shape}(b n):",
            Row("breather_frequency", f"frequency {name}", breather.frequency / turn),
            Row("detuning", "detuning Δ = 1 - f/f0", breather.detuning, r"\Delta"),
            Row("amplitude", "largest displacement by bead", breather.amplitude, "2 a U"),
            Row("width", "width 1/b in cells", breather.width, "b^{-1}"),
        ]
        if breather.opening != sp.oo:
            rows.append(Row("opening_detuning", _OPENING, breather.opening_detuning))
            notes.append(_EARLIER)
        if breather.opening != sp.oo and breather.k is not sp.nan:
            for held, label in _LOADS.items():
                load = breather.opening_load(held)
                load = sp.N(load, 15) if load.is_Rational else load  # sixth powers have many digits
                rows.append(Row(f"opening_load.{held}", label, load))
    return Answer(head, rows, units, found.cell.spacing, notes=notes)


_OPENING = "contacts open from the detuning"
_EARLIER = (
    "contacts open at these values to leading order; on the lattice they open earlier, in dimers "
    "of spheres at about three quarters of the detuning"
)
_LOADS = {
    "frequency": "at this frequency, from the load F0",
    "amplitude": "at this amplitude, below the load F0",
}

UNITS = {
    "frequency": "Hz",
    "group_velocity": "cells/s",
    "dispersion": "cells²/s",
    "nonlinearity": "1/(s kg m²)",
    "breather_frequency": "Hz",
    "amplitude": "m",
    "opening_load": "N",
}
"""Units of an envelope of a chain in SI."""
