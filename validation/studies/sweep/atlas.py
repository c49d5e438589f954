"""Sweeps as tables, as documents for JSON, and as maps.

Importing this module teaches `validation.report.text` and `validation.report.figure` what a `Sweep`
is.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lwa.exact import InputError
from validation.pulses.pulse import Measured
from validation.pulses.steady import QUANTITIES, STRETCH, Point
from validation.report.command import output, progress, show
from validation.report.figure import figure
from validation.report.text import document, table, text
from validation.studies.sweep.executors import cluster, processes
from validation.studies.sweep.sweep import CLOSURES, Sweep, SweepError, axis, sweep

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


def _axis(context: click.Context, option: click.Parameter, text: str) -> tuple[sp.Rational, ...]:
    return axis(text, option.opts[0].lstrip("-"))


@click.command("sweep")
@click.option(
    "--k", "ks", callback=_axis, default="5/4:3:8", show_default=True,
    help="Exponents of F = δ^k: values and ranges start:stop:count, separated by commas.",
)  # fmt: skip
@click.option(
    "--omega", "omegas", callback=_axis, default="1/20:1:20", show_default=True,
    help="Mass ratios m2/m1, likewise.",
)  # fmt: skip
@click.option(
    "--stretch", type=int, default=STRETCH, show_default=True,
    help="Cells from one place at which the pulse is measured to the next; more below k = 3/2.",
)  # fmt: skip
@click.option(
    "--file", metavar="FILE",
    help="Keep finished points (.jsonl); with the same file a sweep goes on where it was left.",
)  # fmt: skip
@click.option("--jobs", type=int, help="Processes; by default one for each processor.")
@click.option(
    "--cluster", "address", metavar="ADDRESS",
    help="Compute on a Dask cluster instead, whose scheduler is there, such as tcp://host:8786.",
)  # fmt: skip
@output
def sweep_command(
    ks: tuple[sp.Rational, ...],
    omegas: tuple[sp.Rational, ...],
    stretch: int,
    file: str | None,
    jobs: int | None,
    address: str | None,
    style: str,
    picture: Path | None,
) -> None:
    """Maps over k and m2/m1: width, speed and decay of a struck chain's pulse."""
    if address is not None and jobs is not None:
        raise InputError(f"jobs is {jobs}: a cluster has workers of its own")
    executor = processes(jobs) if address is None else cluster(address)
    try:
        result: Sweep = sweep(
            ks, omegas, stretch=stretch, executor=executor, file=file, progress=progress
        )
    except SweepError as error:
        raise click.ClickException(str(error)) from None
    except KeyboardInterrupt:
        if file is not None and Path(file).exists():
            click.echo(f"finished points are in {file}: the same command goes on", err=True)
        raise
    show(result, style, picture)
