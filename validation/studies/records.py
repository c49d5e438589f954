"""A run's file: what its sensors recorded, what was read off it, and the scene, to run it again.

JSON: the document of the result and ``records``, the arrays of `validation.lattice.run.Run` under
their names with ``_value``, in the order of the scene's sensors; static forces are included.
NumPy's .npz: the same arrays under their own names, the columns of the result's tables as
``sensors_arrival_value``, ``speeds_speed_value`` and so on (NaN where a pulse is missing), and
``document``, a JSON text. CSV, for spreadsheets, has neither result nor scene: ``time``, and a
column of the dynamic force for each sensor.
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
from validation.lattice.run import Run
from validation.pulses.sensors import tracks
from validation.report.files import replacing
from validation.scenes.checks import SceneError, of_scene
from validation.scenes.scene import Scene
from validation.scenes.scenefile import scene

KEPT = (".json", ".npz")  # suffixes of files that hold the scene and the result as well
SUFFIXES = (*KEPT, ".csv")
RECORDS = (
    "time",
    "contact_force",
    "compression",
    "bead_force",
    "bead_displacement",
    "bead_velocity",
)
TABLES = ("sensors", "speeds")
_MOST_BYTES = 10**9


@dataclass(frozen=True, eq=False)
class Stored:
    """What a file of a run holds.

    scene : what was simulated.
    records : (S,) the time, and (sensors, S) what was recorded, as in `validation.Run`.
    sensors, speeds : the columns of the result's tables, NaN where a pulse is missing.
    """

    scene: Scene
    records: Mapping[str, Array]
    sensors: Mapping[str, NDArray[Any]]
    speeds: Mapping[str, NDArray[Any]]


def store(run: Run, document: Mapping[str, Any], file: Path) -> None:
    """Write a run and the document of its result; only a complete file replaces an old one."""
    arrays = {name: getattr(run, name) for name in RECORDS}
    suffix = file.suffix.lower()
    with replacing(file) as new, new.open("wb") as stream:
        if suffix == ".npz":
            arrays |= {
                f"{table}_{name}": column
                for table in TABLES
                for name, column in _columns(document[table]).items()
            }
            np.savez_compressed(stream, document=json.dumps(document), **arrays)
        elif suffix == ".csv":
            heard = tracks(run)
            names = ",".join(("time", *(f"{track.kind}_{track.number}" for track in heard)))
            rows = np.column_stack((run.time, *(track.force for track in heard)))
            np.savetxt(stream, rows, "%s", ",", header=names, comments="")
        else:
            records = {f"{name}_value": array.tolist() for name, array in arrays.items()}
            stream.write(json.dumps({**document, "records": records}).encode())


def load(path: str | Path) -> Stored:
    """Read a file that `lwa-validate run --out` wrote, .json or .npz.

    Raises `SceneError`, in one line, for a file that cannot be read or is none.
    """
    file = Path(path)
    if (suffix := file.suffix.lower()) not in KEPT:
        raise SceneError(f"{path}: a stored run is a file ending in {' or '.join(KEPT)}")
    read = _archive if suffix == ".npz" else _text
    try:
        document, records = read(file)
        sensors, speeds = (_columns(document[table]) for table in TABLES)
        return Stored(scene(document["scene"]), records, sensors, speeds)
    except SceneError:
        raise
    except OSError as error:
        raise SceneError(f"{path}: {files.reason(error)}") from None
    except Exception:  # whatever a foreign or damaged file makes of NumPy
        raise SceneError(f"{path}: not what `lwa-validate run --out` writes") from None


def _text(file: Path) -> tuple[dict[str, Any], dict[str, Array]]:
    document = of_scene(files.load)(file, "a stored run", dict)
    records = document["records"]
    return document, {name: np.array(records[f"{name}_value"], float) for name in RECORDS}


def _archive(file: Path) -> tuple[dict[str, Any], dict[str, Array]]:
    with np.load(io.BytesIO(of_scene(files.content)(file, _MOST_BYTES))) as held:
        return json.loads(str(held["document"])), {name: held[name] for name in RECORDS}


def _columns(rows: list[dict[str, Any]]) -> dict[str, NDArray[Any]]:
    """A table's columns; those of texts hold "" where there is none."""
    texts = ("kind", "missing")
    return {
        name: np.array(
            [(row[name] or "") if name in texts else row[name] for row in rows],
            str if name in texts else float,
        )
        for name in (rows[0] if rows else ())
    }
