"""CPU time of the integrators against their errors, as the book's page on integration shows it."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

from lwa import Cell, Dimer
from validation import Damping, Run, Scene, measure, simulate

SCENES = {
    "contacts that open": Scene.of_cell(
        Dimer(1, "0.2733", spacing=1),
        100,
        "3/2",
        velocities=(1.0,),
        contact_sensors=(180,),
        duration=205.0,
        samples=6001,
    ),
    "contacts that stay closed": Scene.of_cell(
        Cell([1], spacing=1),
        200,
        "3/2",
        velocities=(0.5,),
        wall=1.0,
        precompression=1.0,
        contact_sensors=(150,),
        duration=150.0,
        samples=9001,
    ),
    "damped contacts": Scene.of_cell(
        Dimer(1, "0.2733", spacing=1),
        50,
        "3/2",
        velocities=(1.0,),
        contact_sensors=(80,),
        duration=110.0,
        damping=Damping("restitution", 0.95),
        samples=6001,
    ),
}
METHODS: dict[str, tuple[dict[str, Any], Sequence[int]]] = {
    "RKN86": ({}, range(4, 12)),
    "symplectic": ({"method": "symplectic"}, range(4, 10)),
    "SciPy DOP853": ({"method": "DOP853"}, (5, 7)),
}
"""Options of `simulate` by label, and the tolerances 10^-n."""


def work_precision() -> dict[tuple[str, str], list[tuple[float, float]]]:
    """CPU times in seconds and relative errors of the peak force, by scene and method."""
    rows: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for name, scene in SCENES.items():
        truth = _peak(simulate(scene, rtol=1e-13))
        for label, (options, tolerances) in METHODS.items():
            if scene.damping and label == "symplectic":
                continue  # forces that depend on velocities are no kicks
            if label != "SciPy DOP853":
                simulate(scene, rtol=1e-4, **options)  # compiles
            for n in tolerances:
                start = time.process_time()
                run = simulate(scene, rtol=10.0**-n, **options)
                spent = time.process_time() - start
                rows.setdefault((name, label), []).append(
                    (spent, abs(_peak(run) / truth - 1))
                )
    return rows


def _peak(run: Run) -> float:
    """Peak dynamic force at the sensor."""
    force = run.contact_force[0]
    return measure(run.time, force - force[0]).peak
