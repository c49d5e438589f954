"""Envelopes of a mode of a loaded chain, and breathers, as rows: `lwa envelope`."""

from __future__ import annotations

from collections.abc import Mapping

from lwa.base.exact import InputError
from lwa.command.rows import Answer, Row
from lwa.envelopes.breather import Breather
from lwa.envelopes.schrodinger import Envelope


def envelope(
    found: Envelope, breather: Breather | None, units: Mapping[str, str], spoken: str
) -> Answer:
    """The nonlinear Schrödinger equation of a mode, and the breather of a frequency.

    Wavenumbers and lengths are in cells, ``frequency`` in radians per unit of time, ``amplitude``
    the largest displacement of each bead and ``width`` 1/b of the envelope sech(bn) or tanh(bn).

    spoken : the chain in text.
    """
    rows: list[Row | str] = [
        spoken,
        "u = A(X, T) φ e^{i(κ n - ω t)} + c.c., Σ m |φ|² = 1, n and κ per cell",
        "i A_T + ½ ω'' A_XX = χ |A|² A",
        "",
        Row("wavenumber", "κ", found.wavenumber, r"\kappa", number=None),
        Row("frequency", "ω", found.frequency, r"\omega"),
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
    if breather is not None:
        shape = "sech" if breather.kind == "bright" else "tanh"
        rows += [
            "",
            f"{breather.kind} breather, |A| = a {shape}(b n):",
            Row("breather_frequency", "frequency", breather.frequency, r"(1 - \nu) \omega"),
            Row("detuning", "detuning ν", breather.detuning, r"\nu"),
            Row("amplitude", "largest displacement by bead", breather.amplitude, r"2 a \phi"),
            Row("width", "width 1/b in cells", breather.width, "b^{-1}"),
            Row("opening_detuning", _OPENING, breather.opening_detuning),
        ]
    return Answer(head, rows, units, found.cell.spacing)


_OPENING = "detuning from which on contacts open"

UNITS = {
    "frequency": "rad/s",
    "group_velocity": "cells/s",
    "dispersion": "cells²/s",
    "breather_frequency": "rad/s",
    "amplitude": "m",
}
"""Units of an envelope of a chain in SI; χ is in rad/(s kg m²)."""
