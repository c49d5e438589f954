"""A result as a table for people, as a document for JSON, and as a file.

`text` and `document` take any result of this package. In a document floats stand under names that
end in ``_value`` and exact numbers as strings that SymPy reads.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import singledispatch
from pathlib import Path
from typing import Any

import numpy as np

from validation.pulses.pulse import Measured
from validation.pulses.sensors import READINGS, SPEEDS, Recording, Sensor, Speed
from validation.report.files import replacing
from validation.scenes.scenefile import document as scene_document

STORED = (".json", ".npz")
"""Suffixes of the files that `store` writes."""

RECORDS = ("time", "contact_force", "compression", "bead_force", "bead_velocity")
"""The samples of a `validation.lattice.run.Run`."""


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Columns of text, the first aligned left, the others right.

    >>> print(table(("bead", "force"), (("first", "1.5"), ("second", "12.25"))))
    bead    force
    first     1.5
    second  12.25
    """
    lines = [header, *rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join(
        "  ".join(
            cell.rjust(width) if i else cell.ljust(width)
            for i, (cell, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    )


@singledispatch
def text(result: Any) -> str:
    """The result as a table, with what it takes to read it."""
    raise TypeError(f"nothing is known to print of {type(result).__name__}")


@singledispatch
def document(result: Any) -> dict[str, Any]:
    """The result for JSON.

    `Recording` → ``scene`` (as in a file, see `validation.scenes.scenefile`), ``sensors``:
    ``kind``, ``number``, ``arrival_value``, ``peak_value``, ``fwhm_value``; ``speeds``: ``kind``,
    ``from``, ``to``, ``speed_sites_value``, ``speed_value`` (null without spacings); each value
    with its error, as ``arrival_error_value``, and all null where ``missing`` says why;
    ``energy_drift_value``, and ``momentum_drift_value``, null with a wall.
    """
    raise TypeError(f"nothing is known to print of {type(result).__name__}")


def percent(error: float) -> str:
    return f"{100 * error:+.3g} %"


@text.register
def _(result: Recording) -> str:
    scene = result.run.scene
    wall = ", the last one the wall's" if scene.wall is not None else ""
    momentum = result.run.momentum_drift
    head = (
        f"{scene.size} beads, {scene.contact_count} contacts{wall}, k = {scene.k:g}; "
        f"duration {scene.duration:g}, energy drift {result.run.energy_drift:.0e}"
        + (", momentum not conserved" if momentum is None else f", momentum drift {momentum:.0e}")
    )
    sensors = [(f"{s.kind} {s.number}", s) for s in result.sensors]
    speeds = [(f"{s.kind} {s.start} → {s.end}", s) for s in result.speeds]
    blocks = [head]
    for header, names, lines in (
        (("sensor", "arrival", "peak force", "FWHM"), READINGS, sensors),
        (("speed", "sites/time", "length/time"), SPEEDS, speeds),
    ):
        rows = [(label, *(_number(s.numbers.get(name)) for name in names)) for label, s in lines]
        if rows:
            blocks.append(table(header, rows))
    blocks += ["\n".join(f"{label}: {s.missing}" for label, s in sensors + speeds if s.missing)]
    if sensors:
        blocks.append(
            "The first pulse at each sensor, dynamic forces, in the scene's own units. ±: by how "
            "much a less\naccurate run differs."
        )
    return "\n\n".join(filter(None, blocks))


def _number(measured: Measured | None) -> str:
    return "-" if measured is None else f"{measured.value:.8g} ± {measured.error:.0e}"


@document.register
def _(result: Recording) -> dict[str, Any]:
    return {
        "scene": scene_document(result.run.scene),
        "sensors": [
            {"kind": s.kind, "number": s.number} | _values(READINGS, s) for s in result.sensors
        ],
        "speeds": [
            {"kind": s.kind, "from": s.start, "to": s.end} | _values(SPEEDS, s)
            for s in result.speeds
        ],
        "energy_drift_value": result.run.energy_drift,
        "momentum_drift_value": result.run.momentum_drift,
    }


def _values(names: Sequence[str], found: Sensor | Speed) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name in names:
        measured = found.numbers.get(name)
        values[f"{name}_value"] = None if measured is None else measured.value
        values[f"{name}_error_value"] = None if measured is None else measured.error
    return values | {"missing": found.missing}


def store(result: Recording, file: Path) -> None:
    """Write a recording with all its samples; only a complete file replaces an old one.

    JSON: the `document` and ``records``, which holds the arrays of
    `validation.lattice.run.Run` under their names with ``_value``, in the order of
    ``sensors``. NumPy's .npz: the same arrays under their own names and ``document``, a JSON text.
    Static forces are included.
    """
    arrays = {name: getattr(result.run, name) for name in RECORDS}
    content = document(result)
    with replacing(file) as new, new.open("wb") as stream:
        if file.suffix.lower() == ".npz":
            np.savez_compressed(stream, document=json.dumps(content), **arrays)
        else:
            records = {f"{name}_value": array.tolist() for name, array in arrays.items()}
            stream.write(json.dumps(content | {"records": records}).encode())
