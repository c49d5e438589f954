"""Files of scenes, TOML or JSON, read by `read_scene`.

The file ``keys.toml`` beside this module lists all keys with examples; `lwa-validate run --keys`
prints the list.

Beads and contacts are counted from 1, as in the paper and on the command line (a `Scene` counts
from 0). Stiffnesses are as many as the cell has beads, the last one joining it to the next cell,
or as many as the whole chain has contacts; spacings likewise.

Unknown keys are refused, and every fault is one line that names the key.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from lwa.base.exact import shorten
from lwa.base.files import (
    Reader,
    Table,
    among,
    each,
    entries,
    load,
    place,
    places,
    table,
)
from lwa.law import read_law
from lwa.spheres.beads import (
    CHAIN,
    FILE,
    STRIKER,
    Row,
    read_beads,
    read_materials,
    read_row,
)
from lwa.spheres.hertz import Material, Sphere, stiffness
from validation.scenes.checks import SceneError, finite, positive
from validation.scenes.columns import MeasuredFile
from validation.scenes.forcing import DAMPINGS, Damping, Drive
from validation.scenes.scene import Scene

MOST_BEADS = 1_000_000
_TABLES = {  # that a file may leave out
    "wall": ("material", "stiffness"),
    "damping": DAMPINGS,
    "drive": (
        "velocity",
        "amplitude",
        "frequency",
        "ramp",
        "file",
        "time",
        "displacement",
    ),
    "striker": STRIKER,
    "start": ("velocities", "displacements"),
    "sensors": ("beads", "contacts"),
}
KEYS: Mapping[str, Sequence[str]] = {"file": FILE, "chain": CHAIN, **_TABLES}
"""Keys of a file, and of each of its tables."""


def read_scene(path: str | Path) -> Scene:
    """Read a scene from a TOML or a JSON file.

    Raises `SceneError`, in one line, for a file that cannot be read or is not a scene.
    """
    return load(path, "a scene", lambda content: scene(content, Path(path).parent))


def scene(content: Any, folder: Path = Path()) -> Scene:
    """Return the scene of a parsed file; `SceneError` for unknown keys and invalid values.

    folder : folder of the measured files that the content names.
    """
    file = Table(content, "", FILE)
    tables = {
        name: file.read(name, table(keys), Table({}, name, keys))
        for name, keys in _TABLES.items()
    }
    materials = read_materials(file)
    beads = read_beads(file, materials)
    defects = [*file.read("defects", _defects, ())]
    if "like" in (striker := tables["striker"]):
        if any(defect.entries.get("bead") == 1 for defect in defects):
            raise SceneError(
                "striker.like and defects name bead 1: one of them is wanted"
            )
        other = {"bead": 1, "like": striker.entries["like"]}
        defects.append(Table(other, "striker", ("bead", "like")))
    row, chain = _chain(read_row(file, beads), beads, defects, folder)
    n, start, sensors = len(chain["masses"]), tables["start"], tables["sensors"]
    wall = _wall(tables["wall"], row, materials) if "wall" in file else None
    velocities = start.read("velocities", each(finite), ())
    if "striker" in file:
        if "start" in file:
            raise SceneError(
                "striker and start are both there: one says how the beads start"
            )
        velocities = (tables["striker"].read("velocity", finite),)
    damping = None
    if "damping" in file:
        kind = tables["damping"].one(*DAMPINGS)
        damping = Damping(kind, tables["damping"].entries[kind])
    units = file.read("units", among({"SI": "SI"}), "SI" if row else "")
    # A pulse that passes the chain once in the duration has 20 samples a bead: a half width of one
    # bead then holds more than the 16 that `validation.pulses.noisy` wants. 100,000 spare memory.
    samples = min(max(1001, 20 * n), 100_000)
    return Scene(
        **chain,
        **{
            key: file.entries[key]
            for key in ("gravity", "precompression")
            if key in file
        },
        wall=wall,
        duration=file.read("duration", positive),
        samples=file.entries.get("samples", samples),
        units=units,
        displacements=start.read("displacements", each(finite), ()),
        velocities=velocities,
        damping=damping,
        drive=_drive(tables["drive"], units, folder) if "drive" in file else None,
        bead_sensors=sensors.read("beads", _sensors(n), ()),
        contact_sensors=sensors.read("contacts", _sensors(n - (wall is None)), ()),
    )


def _sensors(count: int) -> Reader:
    """Return a reader of sensors: a list of numbers from 1 to ``count``, or "all"."""
    return lambda value, name: (
        range(count) if value == "all" else places(count)(value, name)
    )


def _defects(value: Any, name: str) -> list[Table]:
    """Read the tables of ``defects``, at most one of each bead and contact."""
    found: dict[str, Table] = {}
    for defect in each(_defect)(value, name):
        kind = defect.one("contact", "bead")
        if (at := f"{kind} {shorten(defect.entries[kind])}") in found:
            raise SceneError(f"{name} has two tables of {at}: one is wanted")
        found[at] = defect
    return [*found.values()]


def _defect(value: Any, name: str) -> Table:
    """Read one table of ``defects``."""
    if "contact" in entries(value, name):
        return Table(value, name, ("contact", "stiffness"))
    given = Table(value, name, ("bead", "like", "mass"))
    given.one("like", "mass")
    return given


def _chain(
    found: Row, beads: Mapping[str, Sphere], defects: Sequence[Table], folder: Path
) -> tuple[list[Sphere], dict[str, Any]]:
    """Return the named beads (none in a chain of masses), and the chain's fields of the `Scene`."""
    n = found.size
    if n > MOST_BEADS:
        made = f"chain.cell and repeat make {shorten(n)} beads"
        raise SceneError(f"{made}: at most {MOST_BEADS} are wanted")
    row = found.spheres * found.repeat
    if row:
        for defect in defects:
            if "like" in defect:
                row[defect.read("bead", place(n))] = defect.read("like", among(beads))
        plain = Scene.of_beads(row, duration=1)
        masses, stiffnesses = list(plain.masses), list(plain.stiffnesses)
        law, spacings = {"k": plain.k}, plain.spacings
    else:
        masses = found.masses * found.repeat
        key = found.given.one("k", "law")
        law = {key: found.given.read(key, finite if key == "k" else read_law)}
        stiffnesses = found.by_contact(found.stiffnesses) or [1.0] * (n - 1)
        spacings = tuple(found.by_contact(found.spacings))
    for defect in defects:
        if "contact" in defect:
            at = defect.read("contact", place(n - 1))
            stiffnesses[at] = defect.read("stiffness", positive)
        elif "mass" in defect:
            masses[defect.read("bead", place(n))] = defect.read("mass", positive)
        elif not row:
            raise SceneError(f"{defect.path('like')} names a bead in a chain of masses")
    return row, {
        "masses": masses,
        "stiffnesses": stiffnesses,
        "spacings": spacings,
    } | law


def _wall(
    given: Table, row: Sequence[Sphere], materials: Mapping[str, Material]
) -> float:
    if given.one("material", "stiffness") == "stiffness":
        return float(given.read("stiffness", positive))
    if not row:
        raise SceneError(
            "wall.material is given, but a chain of masses needs wall.stiffness"
        )
    return float(stiffness(row[-1], given.read("material", among(materials))))


def _drive(given: Table, units: str, folder: Path) -> Drive:
    """Read the motion of bead 1; the key ``file`` names a CSV file of its time and displacement."""
    motion = dict(given.entries)
    if "file" in given:
        if not isinstance(name := motion.pop("file"), str):
            raise SceneError(
                f"drive.file is {shorten(name)}: the name of a CSV file is wanted"
            )
        file = MeasuredFile(folder / name, "time", "displacement")
        check_units(file.si, units, file.path)
        motion["time"], motion["displacement"] = file.rows("time", "displacement").T
    return Drive(**motion)


def check_units(si: bool, units: str, name: Any) -> None:
    """Refuse a measured file that states its units beside a scene that does not."""
    if si and not units:
        raise SceneError(
            f"{name}: it states units, the scene does not: units = 'SI' is wanted"
        )
