"""Files of scenes, TOML or JSON, read by `read_scene`.

The file ``keys.toml`` beside this module lists all keys with examples: these keys are known, and
others are refused. `lwa-validate run --keys` prints the list.

Beads and contacts are counted from 1, as in the paper and on the command line (a `Scene` counts
from 0). Stiffnesses are as many as the cell has beads, the last one joining it to the next cell,
or as many as the whole chain has contacts; spacings likewise. Exponents, laws and values of damping
that differ are as many as the cell has beads, or as the scene has contacts, the wall's included.

Every fault is one line that names the key.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from lwa.base.exact import shorten
from lwa.base.files import (
    Reader,
    Table,
    among,
    each,
    entries,
    load,
    place,
)
from lwa.law import read_law
from lwa.spheres.beads import (
    Row,
    read_beads,
    read_materials,
    read_row,
    striker_velocity,
)
from lwa.spheres.hertz import Material, Sphere, stiffness
from validation.scenes.checks import SceneError, finite, positive
from validation.scenes.forcing import DAMPINGS, Damping, Drive
from validation.scenes.measured import MeasuredFile
from validation.scenes.scene import Scene, contacts_of

MOST_BEADS = 1_000_000  # so many are read in 2 s and 40 MB
_STATED = ("columns", "units", "step")  # keys on the file of a drive
# Keys of a striker or a defect that is a bead unlike the others
_OTHER = ("like", "mass")
# Faults of a key for which its example helps: it is missing or unknown, or of another type.
_ABOUT = re.compile(
    r"([\w.]+) is (missing|unknown|.*: a (?:number|list|sequence) is wanted)(?:: .*)?"
)


def read_scene(
    path: str | Path, samples: Callable[[Scene], int] | None = None
) -> Scene:
    """Read a scene from a file, TOML or JSON; "-" is standard input.

    Parameters
    ----------
    path : str or Path
        Name of the file.
    samples : callable, optional
        Number of samples of a scene whose file gives none; by default that of `Scene`.

    Raises
    ------
    SceneError
        In one line, for a file that cannot be read or is not a scene.
    """

    def read(content: Any) -> Scene:
        """Read the scene of a file's content, with a number of samples if it gives none."""
        try:
            found = scene(content, Path(path).parent)
        except SceneError as fault:
            raise SceneError(f"{fault}{_line(str(fault))}") from None
        if samples is None or "samples" in content:
            return found
        return replace(found, samples=samples(found))

    return load(path, "a scene", read)


def scene(content: Any, folder: Path = Path()) -> Scene:
    """Return the scene of a parsed file; `SceneError` for unknown keys and invalid values.

    Parameters
    ----------
    content : object
        The parsed file.
    folder : Path
        Folder of the measured files that the content names.

    Notes
    -----
    The tables of beads and the chain give the fields of all contacts between beads (`_chain`). The
    wall, exponents or laws, damping, start, units, drive and duration follow, in this order: each
    needs what stands before it.
    """
    known = _known()
    file = Table(content, "", known)

    def part(name: str) -> Table:
        """Return a table of the file, an empty one if it is left out."""
        return Table(file.entries.get(name, {}), name, known[name])

    # All tables are read first: an unknown key is refused before a missing value.
    start = part("start")
    sensors = part("sensors")
    striker = part("striker")
    materials = read_materials(file)
    beads = read_beads(file, materials)
    row = read_row(file, beads)
    # Counted before the beads are made: a chain too long would fill the memory.
    if row.size > MOST_BEADS:
        made = f"chain.cell and repeat make {shorten(row.size)} beads"
        raise SceneError(f"{made}: at most {MOST_BEADS} are wanted")
    spheres = row.spheres * row.repeat
    fields = _chain(row, spheres, beads, _defects(file, striker))
    contacts = row.size - 1
    if "wall" in file:
        fields["wall"] = _wall(part("wall"), spheres, materials)
        # The wall's contact is the last.
        contacts += 1
    own = partial(
        _per_contact, period=len(row.spheres or row.masses), contacts=contacts
    )
    # Spheres have the law of Hertz.
    if not spheres:
        key = row.given.one("k", "law")
        fields[key] = row.given.read(key, own(finite if key == "k" else read_law))
    if "damping" in file:
        damping = part("damping")
        kind = damping.one(*DAMPINGS)
        value = damping.read(kind, own(finite))
        fields["damping"] = Damping(kind, value)
    fields |= start.entries
    if "striker" in file:
        if "start" in file:
            raise SceneError(
                "striker and start are both there: one says how the beads start"
            )
        fields["velocities"] = (striker_velocity(striker),)
    # Materials are in SI.
    units = file.read("units", among({"SI": "SI"}), "SI" if spheres else "")
    if "drive" in file:
        fields["drive"] = _drive(part("drive"), units, folder)
    # The scene checks these and the start; a key that is left out keeps the scene's default.
    for key in ("gravity", "precompression", "samples"):
        if key in file:
            fields[key] = file.entries[key]
    # A law of another form, or a list of exponents, has no passage in closed form.
    passage = None
    if "striker" in file and isinstance(fields.get("k"), float):
        passage = _passage(fields) or None  # a bead alone has no contact
    return Scene(
        **fields,
        duration=file.read("duration", positive, passage),
        units=units,
        bead_sensors=sensors.read("beads", _sensors(row.size), ()),
        contact_sensors=sensors.read("contacts", _sensors(contacts), ()),
    )


def _line(fault: str) -> str:
    """Return the example, in the list of keys, of the key that a fault is about; "" for none.

    The key is missing, has a value of another type, or stands in a table, not above all tables.
    """
    about = _ABOUT.fullmatch(fault)
    if about is None:
        return ""
    *tables, key = about[1].split(".")
    if about[2] == "unknown":
        tables = []
    found: Any = _known()
    for name in tables:
        # Names of beads and of materials are free.
        found = found.get(name) or next(iter(found.values()))
    value = found.get(key)
    if value is None or isinstance(value, dict):
        return ""
    where = f"in [{'.'.join(tables)}]" if tables else "above all tables"
    # A number, a text or a list of them is written in TOML as in JSON.
    return f"; try: {key} = {json.dumps(value)}  # {where}"


@cache
def _known() -> dict[str, Any]:
    """Return the list of all keys as a parsed file."""
    text = Path(__file__).with_name("keys.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def _passage(fields: Mapping[str, Any]) -> float:
    """About twice the time in which the pulse of a striker runs through a chain and leaves it.

    A contact, the last one twice, takes the time in which a bead at the striker's velocity covers
    the compression that holds its energy, ``A δ^{k+1}/(k+1) = m v²/2``: of equal spheres 0.9 of
    the pulse's time.
    """
    masses = np.array(fields["masses"])
    stiffnesses = [*fields["stiffnesses"]]
    if "wall" in fields:
        stiffnesses.append(fields["wall"])
    k = fields["k"]
    (velocity,) = fields["velocities"]
    # A heavy bead is as fast as the momentum of a light striker makes it.
    speed = velocity * masses[0] / masses.max()
    # At the wall the last bead moves alone.
    heavier = np.maximum(masses, np.append(masses[1:], 0))[: len(stiffnesses)]
    energies = heavier * speed**2 / 2
    times = (energies * (k + 1) / stiffnesses) ** (1 / (k + 1)) / speed
    return float(2 * (times.sum() + times[-1:].sum()))


def _sensors(count: int) -> Reader:
    """Return a reader of sensors: a list of numbers from 1 to ``count``, or "all"."""
    return lambda value, name: (
        range(count) if value == "all" else each(place(count))(value, name)
    )


def _per_contact(reader: Reader, period: int, contacts: int) -> Reader:
    """Return a reader of a value for all contacts, or of a list.

    A list has an entry for each bead of a cell, and is repeated, or for each contact of the chain.
    """

    def read(value: Any, name: str) -> Any:
        """Read one value, or a list, which is returned with an entry for each contact."""
        if not isinstance(value, list):
            return reader(value, name)
        values = each(reader)(value, name)
        if len(values) not in (period, contacts):
            raise SceneError(
                f"{name} holds {len(values)}: {period}, one for each bead of the cell, or "
                f"{contacts}, one for each contact, are wanted, or one for all"
            )
        return (values * (contacts // len(values) + 1))[:contacts]

    return read


def _defects(file: Table, striker: Table) -> list[Table]:
    """Read the tables of ``defects``, at most one of each bead and contact.

    A striker that is described takes the place of bead 1.
    """
    given = [*file.read("defects", each(_defect), ())]
    own = {key: striker.entries[key] for key in _OTHER if key in striker}
    if own:
        given.append(_defect({"bead": 1, **own}, "striker"))
    named: set[str] = set()
    for defect in given:
        kind = defect.one("contact", "bead")
        at = f"{kind} {shorten(defect.entries[kind])}"
        if at in named:
            raise SceneError(
                f"{at} has two tables of defects, or one and the striker's: one is wanted"
            )
        named.add(at)
    return given


def _defect(value: Any, name: str) -> Table:
    """Read one table of ``defects``."""
    # A defect is told by what it names: a contact or a bead.
    if "contact" in entries(value, name):
        return Table(value, name, ("contact", "stiffness"))
    given = Table(value, name, ("bead", *_OTHER))
    given.one(*_OTHER)
    return given


def _chain(
    row: Row,
    spheres: list[Sphere],
    beads: Mapping[str, Sphere],
    defects: Sequence[Table],
) -> dict[str, Any]:
    """Return masses, stiffnesses and spacings of a chain with its defects.

    The fields of spheres, in which defects put other beads, hold their exponent, too.
    """
    # Spheres are replaced first: the contacts beside them follow from their radii.
    for defect in defects:
        if "like" in defect:
            if not spheres:
                named = defect.path("like")
                raise SceneError(f"{named} names a bead in a chain of masses")
            at = defect.read("bead", place(len(spheres)))
            spheres[at] = defect.read("like", among(beads))
    fields: dict[str, Any] = {
        "masses": row.masses * row.repeat,
        "stiffnesses": row.by_contact(row.stiffnesses) or [1.0] * (row.size - 1),
        "spacings": row.by_contact(row.spacings),
    }
    if spheres:
        fields = contacts_of(spheres)
    for defect in defects:
        if "contact" in defect:
            stiffnesses = fields["stiffnesses"]
            at = defect.read("contact", place(len(stiffnesses)))
            stiffnesses[at] = defect.read("stiffness", positive)
        elif "mass" in defect:
            at = defect.read("bead", place(len(fields["masses"])))
            fields["masses"][at] = defect.read("mass", positive)
    return fields


def _wall(
    given: Table, row: Sequence[Sphere], materials: Mapping[str, Material]
) -> float:
    """Read the stiffness of the wall's contact."""
    if given.one("material", "stiffness") == "stiffness":
        return float(given.read("stiffness", positive))
    if not row:
        raise SceneError(
            "wall.material is given, but a chain of masses needs wall.stiffness"
        )
    return float(stiffness(row[-1], given.read("material", among(materials))))


def _drive(given: Table, units: str, folder: Path) -> Drive:
    """Read the motion of bead 1; the key ``file`` names a file of its time and displacement."""
    motion = dict(given.entries)
    stated = {key: motion.pop(key) for key in _STATED if key in motion}
    if "file" in given:
        name = motion.pop("file")
        if not isinstance(name, str):
            raise SceneError(f"drive.file is {shorten(name)}: a file's name is wanted")
        try:
            file = MeasuredFile.read(folder / name, **stated)
            check_units(file.si, units, file.path)
            motion["time"], motion["displacement"] = file.rows("time", "displacement").T
        except SceneError as error:
            # The error proposes arguments of Python, as in "; try columns={'time': '1'}". But for
            # the colons these are lines of a TOML file, which "; try: " proposes.
            fault = str(error).replace("': '", "' = '")
            raise SceneError(fault.replace("; try ", "; try: ")) from None
    return Drive(**motion)


def check_units(si: bool, units: str, name: Any) -> None:
    """Refuse a measured file that states its units beside a scene that does not."""
    if si and not units:
        raise SceneError(
            f"{name}: it states units, the scene does not: units = 'SI' is wanted"
        )
