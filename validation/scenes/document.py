"""Content of scene files: the inverse of `validation.scenes.scenefile.scene`."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import fields
from itertools import pairwise, product
from typing import Any

import sympy as sp

from lwa.base.exact import InputError
from lwa.law import NAMES, ContactLaw, named
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene


def _law_text(law: ContactLaw) -> str:
    """Return a law as text, such as "hertz2:1,2"; `SceneError` for a law without a name.

    The parameters are searched among the numbers in F, their negatives and their reciprocals.
    """
    numbers = {x for x in law.F.atoms(sp.Number) if x}
    numbers |= {1 / x for x in numbers} | {sp.S.One}
    numbers |= {-x for x in numbers} | {sp.S.Zero}
    for title in NAMES:
        for values in product(sorted(numbers), repeat=len(named(title).symbols)):
            with suppress(InputError):
                if named(title, *values) == law:
                    return f"{title}:{','.join(map(str, values))}"
    raise SceneError(f"law is {law.F}: a file holds the laws {', '.join(NAMES)}")


def overlap(what: Scene) -> int:
    """Return the number (from 1) of the first contact pressed at the start, not at rest; or 0."""
    if what.gravity or what.precompression:
        return 0
    pairs = pairwise((*what.displacements, 0.0))  # beyond them, and at the wall
    deeper = (i for i, (y, after) in enumerate(pairs, start=1) if y > after)
    return next((i for i in deeper if i <= what.contact_count), 0)


def document(what: Scene) -> dict[str, Any]:
    """Return the content of a scene's file, for JSON; `scenefile.scene` reads an equal scene."""
    period = _period(what)
    chain: dict[str, Any] = {"cell": list(what.masses[:period])}
    chain |= {"k": what.k} if what.law is None else {"law": _law_text(what.law)}
    if period < what.size:
        chain["repeat"] = what.size // period
    for name in ("stiffnesses", "spacings"):
        if values := getattr(what, name):
            chain[name] = values[0] if len(set(values)) == 1 else list(values[:period])
    result: dict[str, Any] = {"duration": what.duration, "samples": what.samples}
    own = {name: getattr(what, name) for name in ("units", "gravity", "precompression")}
    result |= {name: value for name, value in own.items() if value} | {"chain": chain}
    if what.wall is not None:
        result["wall"] = {"stiffness": what.wall}
    if what.damping is not None:
        result["damping"] = {what.damping.kind: what.damping.value}
    if what.drive is not None:
        drive = {f.name: getattr(what.drive, f.name) for f in fields(what.drive)}
        result["drive"] = {
            name: list(value) if isinstance(value, tuple) else value
            for name, value in drive.items()
            if value or (value == 0 and name != "ramp")
        }
    if len(what.velocities) == 1 and not what.displacements:
        result["striker"] = {"velocity": what.velocities[0]}
    elif what.velocities or what.displacements:
        start = {"velocities": what.velocities, "displacements": what.displacements}
        result["start"] = {name: list(values) for name, values in start.items() if values}
        if overlap(what):
            result["start"]["overlap"] = True
    sensors = {"beads": what.bead_sensors, "contacts": what.contact_sensors}
    heard = {name: [i + 1 for i in indices] for name, indices in sensors.items() if indices}
    return result | ({"sensors": heard} if heard else {})


def _period(what: Scene) -> int:
    """Return the size of the smallest cell whose repetition is the chain."""
    n, rows = what.size, (what.masses, what.stiffnesses, what.spacings)
    return next(
        p
        for p in range(1, n + 1)
        if n % p == 0 and all(row[p:] == row[: max(len(row) - p, 0)] for row in rows)
    )
