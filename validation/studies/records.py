"""Files of runs: the records of the sensors, the pulses measured in them, and the scene.

JSON: the result's document, and under ``records`` the arrays of `validation.lattice.run.Records`,
their names ending in ``_value``. NumPy's .npz: the same arrays, the numbers of the result's tables
as ``sensors_arrival_value`` and so on (NaN without a pulse), and ``document``, a JSON text.

CSV, for spreadsheets: time and records by sensor, with units in the header, but neither result nor
scene. Forces are total: static forces are included.
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lwa.base import files
from validation.lattice.run import Records, Run
from validation.report.files import replacing
from validation.report.table import plain
from validation.scenes.checks import SceneError
from validation.scenes.scenefile import scene

STORED = (".json", ".npz")  # suffixes of files with the scene and the result
SUFFIXES = (*STORED, ".csv")
RECORDS = tuple(name for name in Records.__dataclass_fields__ if name != "scene")
_MOST_BYTES = 10**9


@dataclass(frozen=True, eq=False, repr=False)
class Stored(Records):
    """Records of a run as read from a file, with the JSON ``document`` of its result."""

    document: Mapping[str, Any]


def store(run: Run, document: Mapping[str, Any], file: Path) -> None:
    """Write a run and the document of its result; only a complete file replaces an old one."""
    arrays = {name: getattr(run, name) for name in RECORDS}
    suffix = file.suffix.lower()
    with replacing(file) as new, new.open("wb") as stream:
        if suffix == ".npz":
            for table in ("sensors", "speeds"):
                for name in document[table][0] if document[table] else ():
                    if name not in ("kind", "missing"):  # texts
                        column = np.array([row[name] for row in document[table]], float)
                        arrays[f"{table}_{name}"] = column
            np.savez_compressed(stream, document=json.dumps(document), **arrays)
        elif suffix == ".csv":
            columns = run.columns()
            rows = np.column_stack(list(columns.values()))
            np.savetxt(stream, rows, "%s", ",", header=",".join(columns), comments="")
        else:
            records = {f"{name}_value": plain(array) for name, array in arrays.items()}
            stream.write(json.dumps({**document, "records": records}).encode())


def load(path: str | Path) -> Stored:
    """Read a .json or .npz file written by `lwa-validate run --out`.

    Raises `SceneError`, in one line, for a file that cannot be read or was written otherwise.
    """
    file = Path(path)
    if (suffix := file.suffix.lower()) not in STORED:
        raise SceneError(f"{path}: a stored run is a file ending in {' or '.join(STORED)}")
    try:
        if suffix == ".npz":
            with np.load(io.BytesIO(files.content(file, _MOST_BYTES))) as archive:
                document = json.loads(str(archive["document"]))
                arrays = {name: archive[name] for name in RECORDS}
        else:
            document = files.load(file, "a stored run", dict)
            records = document.pop("records")
            arrays = {name: np.array(records[f"{name}_value"], float) for name in RECORDS}
        return Stored(scene(document["scene"]), document=document, **arrays)
    except SceneError:
        raise
    except OSError as error:
        raise SceneError(f"{path}: {files.reason(error)}") from None
    except Exception:  # NumPy's errors of damaged files are of many kinds
        raise SceneError(f"{path}: not what `lwa-validate run --out` writes") from None
