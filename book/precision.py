"""CPU time and order of the integrators against their errors, as the appendix measures them."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from lwa import Cell, Dimer
from validation import Run, Scene, measure, simulate

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
}
METHODS: dict[str, tuple[dict[str, Any], Sequence[int]]] = {
    "RKN86": ({}, range(4, 12)),
    "SRKN14": ({"method": "SRKN14"}, range(4, 10)),
    "SciPy DOP853": ({"method": "DOP853"}, (5, 7)),
}
"""Options of `simulate` by label, and the tolerances 10^-n."""

SIX = Scene(
    masses=(1.0, 0.3, 2.0, 0.7, 1.1, 0.5),
    stiffnesses=(1.0, 2.0, 0.5, 1.5, 3.0),
    wall=1.0,
    k=1.5,
    precompression=1.0,
    velocities=(0.05, -0.02, 0.03, 0.0, -0.04, 0.01),
    duration=200.0,
    samples=2,
)
"""Six unequal beads in front of a wall, whose contacts stay closed."""


def work_precision() -> dict[tuple[str, str], list[tuple[float, float]]]:
    """CPU times in seconds and relative errors of the peak force, by scene and method."""
    rows: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for name, scene in SCENES.items():
        truth = _peak(simulate(scene, rtol=1e-13))
        for label, (options, tolerances) in METHODS.items():
            simulate(scene, rtol=1e-4, **options)  # compiles
            for n in tolerances:
                start = time.process_time()
                run = simulate(scene, rtol=10.0**-n, **options)
                spent = time.process_time() - start
                rows.setdefault((name, label), []).append((spent, abs(_peak(run) / truth - 1)))
    return rows


def cheapest(runs: Sequence[tuple[float, float]], wanted: float) -> float | None:
    """CPU time of the cheapest run such that all costlier runs are as accurate."""
    found = None
    for spent, off in reversed(runs):
        if off > wanted:
            break
        found = spent
    return found


def orders(
    opens: bool, ranges: Mapping[str, tuple[float, float]]
) -> dict[str, tuple[list[float], list[float], float]]:
    """Mean steps, errors of the displacements, and the slope between them, by method.

    opens : weak load and strong blows, so that contacts open and close.
    ranges : the largest and the smallest step of each method.
    """
    blows = np.random.default_rng(8).uniform(-1, 1, (8, 6)) / (1 if opens else 10)
    load = 0.2 if opens else 1.0
    scenes = [
        replace(SIX, precompression=load, velocities=tuple(blow), duration=8.0) for blow in blows
    ]
    truth = [simulate(scene, rtol=1e-13).displacements for scene in scenes]
    return {method: _errors(method, scenes, truth, *ends) for method, ends in ranges.items()}


def _errors(
    method: str, scenes: Sequence[Scene], truth: Iterable[Any], coarse: float, fine: float
) -> tuple[list[float], list[float], float]:
    steps, off = [], []
    pairs = list(zip(scenes, truth, strict=True))
    for step in np.geomspace(coarse, fine, 6):
        runs = [
            (simulate(scene, method=method, step=step * shaken, rtol=1e-2), end)
            for scene, end in pairs
            for shaken in np.linspace(0.8, 1.25, 9)
        ]
        steps.append(float(np.mean([run.step for run, _ in runs])))
        off.append(float(np.median([np.abs(run.displacements - end).max() for run, end in runs])))
    return steps, off, float(np.polyfit(np.log(steps), np.log(off), 1)[0])


def _peak(run: Run) -> float:
    """Peak dynamic force at the sensor."""
    force = run.contact_force[0]
    return measure(run.time, force - force[0]).peak
