"""Rows that the waves of a peak contact force have in common."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from lwa.base.exact import InputError
from lwa.base.words import EXTENTS, QUANTITIES, ExtentName, QuantityName
from lwa.command.rows import Form, Row, attempt, estimated

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
