"""Files of runs: the records of the sensors, the pulses measured in them, and the scene.

JSON: the result's document, and under ``records`` the arrays of `validation.lattice.run.Records`,
their names ending in ``_value``. NumPy's .npz: the same arrays, the columns of the result's tables
as ``sensors_arrival_value``, ``speeds_speed_value`` and so on (NaN without a pulse), and
``document``, a JSON text. CSV, for spreadsheets: time and records by sensor, with units in the
header, but neither result nor scene. Forces are total: static forces are included.
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lwa.base import files
from lwa.base.arrays import Array
from validation.lattice.run import Records, Run
from validation.report.files import replacing
from validation.scenes.checks import SceneError
from validation.scenes.scenefile import scene

KEPT = (".json", ".npz")  # suffixes of files with the scene and the result
SUFFIXES = (*KEPT, ".csv")
RECORDS = tuple(name for name in Records.__dataclass_fields__ if name != "scene")
TABLES = ("sensors", "speeds")
_MOST_BYTES = 10**9


@dataclass(frozen=True, eq=False, repr=False)
class Stored(Records):
    """Records of a run as read from a file, with the tables of its result.

    sensors, speeds : columns of the tables by their keys; NaN without a pulse.
    """

    sensors: Mapping[str, NDArray[Any]]
    speeds: Mapping[str, NDArray[Any]]


def store(run: Run, document: Mapping[str, Any], file: Path) -> None:
    """Write a run and the document of its result; only a complete file replaces an old one."""
    arrays = {name: getattr(run, name) for name in RECORDS}
    suffix = file.suffix.lower()
    with replacing(file) as new, new.open("wb") as stream:
        if suffix == ".npz":
            for table in TABLES:
                columns = _columns(document[table])
                arrays |= {f"{table}_{name}": column for name, column in columns.items()}
            np.savez_compressed(stream, document=json.dumps(document), **arrays)
        elif suffix == ".csv":
            columns = run.columns()
            rows = np.column_stack(list(columns.values()))
            np.savetxt(stream, rows, "%s", ",", header=",".join(columns), comments="")
        else:
            records = {f"{name}_value": _null(array) for name, array in arrays.items()}
            stream.write(json.dumps({**document, "records": records}).encode())


def load(path: str | Path) -> Stored:
    """Read a .json or .npz file written by `lwa-validate run --out`.

    Raises `SceneError`, in one line, for a file that cannot be read or was written otherwise.
    """
    file = Path(path)
    if (suffix := file.suffix.lower()) not in KEPT:
        raise SceneError(f"{path}: a stored run is a file ending in {' or '.join(KEPT)}")
    try:
        document, records = (_archive if suffix == ".npz" else _text)(file)
        tables: dict[str, Any] = {table: _columns(document[table]) for table in TABLES}
        return Stored(scene(document["scene"]), **records | tables)
    except SceneError:
        raise
    except OSError as error:
        raise SceneError(f"{path}: {files.reason(error)}") from None
    except Exception:  # NumPy's errors of damaged files are of many kinds
        raise SceneError(f"{path}: not what `lwa-validate run --out` writes") from None


def _text(file: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    document = files.load(file, "a stored run", dict)
    records = document["records"]
    return document, {name: np.array(records[f"{name}_value"], float) for name in RECORDS}


def _archive(file: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    with np.load(io.BytesIO(files.content(file, _MOST_BYTES))) as held:
        return json.loads(str(held["document"])), {name: held[name] for name in RECORDS}


def _null(array: Array) -> Any:
    """Return an array as nested lists with None for NaN, as in JSON."""
    found = array.astype(object)
    found[np.isnan(array)] = None
    return found.tolist()


def _columns(rows: list[dict[str, Any]]) -> dict[str, NDArray[Any]]:
    """Return the columns of a table by key, with "" (texts) or NaN (numbers) for null."""
    columns = {name: [row[name] for row in rows] for name in (rows[0] if rows else ())}
    return {
        name: np.array([text or "" for text in column])
        if name in ("kind", "missing")
        else np.array(column, float)
        for name, column in columns.items()
    }
