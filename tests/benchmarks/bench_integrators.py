"""CPU time of the engine and of CyRK on the tasks of `lwa-validate accuracy`, and many chains.

    python -m pytest -s tests/benchmarks/bench_integrators.py

Wants CyRK and prints, for each task, the CPU time of the cheapest run from which on the peak force
is good to 1e-4 … 1e-10, and for many chains the wall time a chain over a thread a core. LAMMPS'
GRANULAR package, which is not run here, takes 20 ms for the task "experiment" to 2e-6 and 204 ms to
2e-8, where the engine takes 0.4 and 0.6 ms (one core; LAMMPS with timesteps of 1e-7 and 1e-8 s). No
time is asserted; every method must come to the reference.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from time import perf_counter

import numpy as np
import pytest

from tests.benchmarks import cyrk
from tests.benchmarks.located import around, read
from validation.lattice.simulate import COMPILED, simulate, simulate_many
from validation.lattice.threads import cores, threads
from validation.pulses.pulse import MeasureError
from validation.studies.accuracy import FINEST, TASKS, WANTED, Row, cost, relative_errors, timed

pytestmark = [
    pytest.mark.optional("CyRK"),
    pytest.mark.filterwarnings("default::DeprecationWarning"),
]


def tolerances(finest):
    """Half decades from 1e-4 on."""
    return 10.0 ** -np.arange(4, -np.log10(finest) + 0.1, 0.5)


def engine(method, task, times, rtol):
    return task.read(simulate(task.scene, method=method, rtol=rtol))


def peer(solve, task, times, rtol):
    return read(task, times, solve(rtol, task, times))


@pytest.mark.parametrize("name", TASKS)
def test_cost(name):
    task = TASKS[name]()
    truth = task.truth or task.read(simulate(task.scene, rtol=FINEST))
    times, methods = around(truth), {}
    for method in COMPILED:
        simulate(task.scene, method=method, rtol=1e-3)  # compiles
        methods[method] = 1e-12, partial(engine, method)
    for method, finest in cyrk.METHODS.items():
        methods[f"CyRK {method}"] = finest, partial(peer, cyrk.prepared(task, method))
    print(f"\n{name}, CPU time (ms) for the peak force to {WANTED}")
    for method, (finest, run) in methods.items():
        rows = []
        for rtol in tolerances(finest):
            try:
                pulse, seconds = timed(partial(run, task, times, rtol))
            except MeasureError:  # no pulse comes through
                continue
            rows.append(Row(name, method, False, rtol, relative_errors(pulse, truth), seconds))
        assert min(row.errors["peak"] for row in rows) < 1e-5
        print(method, *(f"{1e3 * cost(rows, wanted):.3g}" for wanted in WANTED))


def test_many_chains():
    """100 of the paper's chains with random masses, each method at a median error of 1e-6."""
    task, random = TASKS["experiment"](), np.random.default_rng(38)
    factors = random.lognormal(0.0, 0.1, (100, task.scene.size))
    tasks = [
        replace(task, scene=replace(task.scene, masses=tuple(row * task.scene.masses)))
        for row in factors
    ]
    truths = [task.read(simulate(task.scene, rtol=FINEST)) for task in tasks]

    def all_engine(rtol, workers):
        runs = simulate_many((t.scene for t in tasks), workers=workers, rtol=rtol)
        return [t.read(run) for t, run in zip(tasks, runs, strict=True)]

    def all_peer(solve, rtol, workers):
        with threads(workers) as pool:
            each = [around(truth) for truth in truths]
            return list(pool.map(lambda t, times: peer(solve, t, times, rtol), tasks, each))

    def error(found):
        pairs = zip(found, truths, strict=True)
        return np.median([relative_errors(*pair)["peak"] for pair in pairs])

    methods = {COMPILED[0]: all_engine}
    for method in ("TSIT5", "VERN7", "DOP853"):
        methods[f"CyRK {method}"] = partial(all_peer, cyrk.prepared(task, method))
    print(f"\nwall time (ms) a chain on {cores()} threads, on one, share of the ideal gain")
    for name, run in methods.items():
        for rtol in tolerances(1e-9):
            if error(run(rtol, 1)) <= 1e-6:
                break
        else:
            pytest.fail(f"{name} does not reach 1e-6")
        both, one = (timed(partial(run, rtol, n), perf_counter)[1] for n in (cores(), 1))
        print(name, f"{10 * both:.3g} {10 * one:.3g} {one / both / cores():.2f}")
