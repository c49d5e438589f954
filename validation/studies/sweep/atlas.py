"""Sweeps as tables, as documents for JSON, and as maps.

Importing this module teaches `validation.report.text` and `validation.report.figure` what a `Sweep`
is.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from validation.pulses.pulse import Measured
from validation.pulses.steady import QUANTITIES, Point
from validation.report.figure import figure
from validation.report.text import document, table, text
from validation.studies.sweep.sweep import CLOSURES, Sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Sweep"]

Array = NDArray[np.float64]

_UNSURE = 0.01
"""Relative error from which on a map marks a point."""

_NO_DECAY = 1e-7
"""Per site: what a map shows as no decay."""

_MOST_ERROR = 50.0
"""Of the theory, in percent: where the colours of its map end."""


@text.register(Sweep)
def _(result: Sweep) -> str:
    blocks = []
    shown = ("width", "speed")
    header = ["ω = m2/m1"]
    for name in shown:
        header += [name, *(f"{closure}" for closure in CLOSURES)]
    header += ["decay per site", "sites"]
    rows = list(zip(result.points, _theory_rows(result), strict=True))
    for k, group in groupby(rows, lambda row: row[0].k):
        lines = []
        for point, theory in group:
            line = [str(point.omega)]
            for name in shown:
                line += [_measured(point, name)]
                line += [_percent(theory[closure][name], point, name) for closure in CLOSURES]
            start, end = point.sites or ("-", "-")
            lines.append([*line, _measured(point, "decay"), f"{start} … {end}"])
        blocks.append(f"k = {k}\n{table(header, lines)}")
    blocks.append(
        "\n".join(
            f"k = {p.k}, ω = {p.omega}: {p.missing}" for p in result.points if p.missing is not None
        )
    )
    theories = "; ".join(f"{closure}: the {name}" for closure, name in CLOSURES.items())
    blocks.append(
        "Width: FWHM of a contact's force, in sites. Speed: sites over time at contact force 1, "
        "with A = D = m1 = 1.\nDecay: of the logarithm of the peak force. ±: the largest change "
        "over two stretches, or of a less accurate run.\nSites: from the struck bead, where it was "
        f"measured. Theory/lattice - 1 of the wave of\n{theories}."
    )
    return "\n\n".join(filter(None, blocks))


@document.register(Sweep)
def _(result: Sweep) -> dict[str, Any]:
    """``stretch``, ``missing`` (how many), and ``points``: ``k``, ``omega`` (exact), ``sites``,
    ``width_value``, ``strain_width_value``, ``speed_value``, ``decay_value`` and their errors
    (``width_error_value``, …), null where ``missing`` says why; ``theory`` by closure:
    ``width_value``, ``strain_width_value``, ``speed_value``, null where there is no wave.
    """
    return {
        "stretch": result.stretch,
        "missing": sum(point.missing is not None for point in result.points),
        "points": [
            {"k": str(point.k), "omega": str(point.omega)}
            | {"sites": None if point.sites is None else list(point.sites)}
            | _values(point)
            | {"missing": point.missing}
            | {
                "theory": {
                    closure: {f"{name}_value": value for name, value in wave.items()}
                    for closure, wave in theory.items()
                }
            }
            for point, theory in zip(result.points, _theory_rows(result), strict=True)
        ],
    }


def _values(point: Point) -> dict[str, float | None]:
    values: dict[str, float | None] = {}
    for name in QUANTITIES:
        number = point.numbers.get(name)
        values[f"{name}_value"] = None if number is None else number.value
        values[f"{name}_error_value"] = None if number is None else number.error
    return values


def _theory_rows(result: Sweep) -> list[dict[str, dict[str, float | None]]]:
    """The theory's numbers point by point, None where there is no wave."""
    return [
        {
            closure: {
                name: None if np.isnan(values.flat[i]) else float(values.flat[i])
                for name, values in wave.items()
            }
            for closure, wave in result.theory.items()
        }
        for i in range(len(result.points))
    ]


def _measured(point: Point, name: str) -> str:
    number = point.numbers.get(name)
    if number is None:
        return "-"
    return _scientific(number) if name == "decay" else str(number)


def _scientific(number: Measured) -> str:
    return f"{number.value:.2e} ± {number.error:.0e}"


def _percent(theory: float | None, point: Point, name: str) -> str:
    if theory is None or point.missing is not None:
        return "-"
    return f"{100 * (theory / point.numbers[name].value - 1):+.2f} %"


@figure.register(Sweep)
def _(result: Sweep) -> Figure:
    """Maps over ω and k, or curves where one of the two has a single value."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(11, 8), layout="constrained")
    plots = picture.subplots(2, 2).ravel()
    if min(len(result.ks), len(result.omegas)) > 1:
        _draw_maps(picture, plots, result)
    else:
        _draw_curves(plots, result)
    return picture


def _draw_maps(picture: Figure, plots: Sequence[Axes], result: Sweep) -> None:
    from matplotlib.colors import LogNorm

    width, decay = result.map("width"), result.map("decay")
    with np.errstate(invalid="ignore"):
        unsure = result.map("width", "error") > _UNSURE * width
    theory = 100 * (result.theory["linear"]["width"] / width - 1)
    largest = min(np.max(np.abs(theory), initial=1e-3, where=np.isfinite(theory)), _MOST_ERROR)
    most = np.max(decay, initial=10 * _NO_DECAY, where=np.isfinite(decay))
    maps: list[tuple[str, Array, str, dict[str, Any]]] = [
        (QUANTITIES["width"], width, "neither", {"cmap": "viridis"}),
        (QUANTITIES["speed"], result.map("speed"), "neither", {"cmap": "viridis"}),
        (
            QUANTITIES["decay"],
            np.maximum(decay, _NO_DECAY),
            "min",
            {"cmap": "cividis", "norm": LogNorm(_NO_DECAY, most)},
        ),
        (
            f"FWHM of force: {CLOSURES['linear']}/lattice - 1 (%)",
            theory,
            "both" if largest == _MOST_ERROR else "neither",
            {"cmap": "PuOr", "vmin": -largest, "vmax": largest},
        ),
    ]
    (x, x_scale), (y, y_scale) = _borders(result.omegas), _borders(result.ks)
    k, omega = np.meshgrid(_floats(result.ks), _floats(result.omegas), indexing="ij")
    for axes, (label, values, extend, style) in zip(plots, maps, strict=True):
        image = axes.pcolormesh(x, y, np.ma.masked_invalid(values), **style)
        picture.colorbar(image, ax=axes, label=label, extend=extend)
        axes.plot(omega[unsure], k[unsure], "rx", ms=4, label=f"error above {_UNSURE:.0%}")
        axes.set(xlabel="ω = m2/m1", ylabel="k", xscale=x_scale, yscale=y_scale)
        axes.set_facecolor("0.8")
    note = "grey: not measured"
    if unsure.any():
        note += f"; red ×: width known to less than {_UNSURE:.0%}"
    picture.supxlabel(note, fontsize="small")


def _draw_curves(plots: Sequence[Axes], result: Sweep) -> None:
    over_k = len(result.ks) > 1
    fixed = f"ω = {result.omegas[0]}" if over_k else f"k = {result.ks[0]}"
    x = _floats(result.ks if over_k else result.omegas)
    for axes, (name, label) in zip(plots, QUANTITIES.items(), strict=True):
        value, error = (result.map(name, part).ravel() for part in ("value", "error"))
        if name == "decay":  # on a logarithmic axis: what is less than its error is shown as that
            value = np.fmax(value, error)
            axes.set_yscale("log")
        axes.errorbar(x, value, error, fmt="ko", ms=3, label="lattice")
        for style, (closure, wave) in zip(("C0-", "C1--"), result.theory.items(), strict=True):
            if name in wave:
                axes.plot(x, wave[name].ravel(), style, label=CLOSURES[closure])
        axes.set(xlabel="k" if over_k else "ω = m2/m1", ylabel=label, title=fixed)
    plots[0].legend()


def _borders(values: Sequence[sp.Rational]) -> tuple[Array, str]:
    """Half way between values and as far beyond the outer ones, and the scale on which they are."""
    centres = _floats(values)
    scale = "log" if centres[-1] > 50 * centres[0] else "linear"
    if scale == "log":
        centres = np.log(centres)
    half = np.diff(centres) / 2
    borders = np.concatenate(
        ([centres[0] - half[0]], centres[:-1] + half, [centres[-1] + half[-1]])
    )
    return (np.exp(borders) if scale == "log" else borders), scale


def _floats(values: Sequence[sp.Rational]) -> Array:
    return np.array([float(value) for value in values])
