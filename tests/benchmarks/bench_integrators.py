"""CPU time of the engine and of CyRK on the tasks of `lwa-validate accuracy`, and many chains.

    python -m pytest -s tests/benchmarks/bench_integrators.py

Wants CyRK and prints, for each task, the CPU time of the cheapest run from which on the peak force
is good to 1e-4 … 1e-10, and for many chains the wall time a chain over a thread a core. LAMMPS'
GRANULAR package, which is not run here, takes 20 ms for the task "experiment" to 2e-6 and 204 ms to
2e-8, where the engine takes 0.4 and 0.6 ms (one core; LAMMPS with timesteps of 1e-7 and 1e-8 s). No
time is asserted; every method must come to the reference.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from functools import partial
from timeit import repeat

import numpy as np
import pytest

from tests.benchmarks import cyrk
from tests.benchmarks.located import around, read
from validation.lattice.simulate import COMPILED, simulate, simulate_many
from validation.lattice.threads import cores, threads
from validation.pulses.pulse import MeasureError
from validation.studies.accuracy import FINEST, TASKS, WANTED, cost, relative_errors, timed

pytestmark = [
    pytest.mark.optional("CyRK"),
    pytest.mark.filterwarnings("default::DeprecationWarning"),
]


def tolerances(finest):
    """Half decades from 1e-4 on."""
    return 10.0 ** -np.arange(4, -np.log10(finest) + 0.1, 0.5)


@pytest.mark.parametrize("name", TASKS)
def test_cost(name):
    task = TASKS[name]()
    truth = task.truth or task.read(simulate(task.scene, rtol=FINEST))
    times, methods = around(task, truth), {}
    for method in COMPILED:
        simulate(task.scene, method=method, rtol=1e-3)  # compiles
        run = partial(simulate, task.scene, method=method)
        methods[method] = 1e-12, lambda rtol, run=run: run(rtol=rtol), task.read
    for method, finest in cyrk.METHODS.items():
        solve = cyrk.prepared(task, method)
        run = lambda rtol, solve=solve: solve(rtol, task, times)  # noqa: E731
        methods[f"CyRK {method}"] = finest, run, partial(read, task, times)
    print(f"\n{name}, CPU time (ms) for the peak force to {WANTED}")
    for method, (finest, run, pulse) in methods.items():
        rows = []
        for rtol in tolerances(finest):
            found, seconds = timed(partial(run, rtol))
            with suppress(MeasureError):  # no pulse comes through
                rows.append((relative_errors(pulse(found), truth)["peak"], seconds))
        assert min(rows)[0] < 1e-5
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
        return list(simulate_many((t.scene for t in tasks), workers=workers, rtol=rtol))

    def all_peer(solve, rtol, workers):
        with threads(workers) as pool:
            return list(pool.map(lambda t, times: solve(rtol, t, times), tasks, each))

    def error(found):
        """Median of the peaks' errors, of runs or of forces."""
        errors = []
        for task, truth, times, x in zip(tasks, truths, each, found, strict=True):
            pulse = read(task, times, x) if isinstance(x, np.ndarray) else task.read(x)
            errors.append(relative_errors(pulse, truth)["peak"])
        return np.median(errors)

    each = [around(*pair) for pair in zip(tasks, truths, strict=True)]
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
        both, one = (min(repeat(partial(run, rtol, n), number=1)) for n in (cores(), 1))
        print(name, f"{10 * both:.3g} {10 * one:.3g} {one / both / cores():.2f}")
