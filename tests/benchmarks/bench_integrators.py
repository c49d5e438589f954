"""CPU time of the engine and of CyRK, in C++, on the tasks of `book/studies/accuracy.py`.

    python -m pytest -s tests/benchmarks/bench_integrators.py

Wants CyRK and prints, for each task, the CPU time of the cheapest run from which on the force of
the pulse is good to 1e-4 … 1e-10 of its peak. CyRK is given the same equations of motion as a C
function, and integrates the whole chain. LAMMPS' GRANULAR package, which is not run here, takes
20 ms for the task "experiment" to 2e-6 and 204 ms to 2e-8, where the engine takes 0.4 and 0.6 ms
(one core; LAMMPS with timesteps of 1e-7 and 1e-8 s). No time is asserted; every method must come to
the engine's finest run.
"""

import math
from functools import partial

import numba
import numpy as np
import pytest

from book.studies.accuracy import FINEST, TASKS, WANTED, cost, timed
from validation.lattice.equations import Motion
from validation.lattice.simulate import COMPILED, simulate

pytestmark = [
    pytest.mark.optional("CyRK"),
    pytest.mark.filterwarnings("default::DeprecationWarning"),
]
PEERS = {"RK45": 1e-9, "TSIT5": 1e-11, "VERN7": 1e-12, "DOP853": 1e-12}
"""CyRK's methods with their finest tolerances."""


def move(rate, t, y, c):
    """The equations of motion for k = 3/2 as a C function; ``c`` as `peer` has it."""
    n, behind = int(c[0]), 0.0
    for i in range(n):
        rate[i] = y[n + i]
        ahead = y[i + 1] if i < n - 1 else 0.0
        d = c[1 + 2 * n + i] + y[i] - ahead
        force = (c[1 + n + i] * d * math.sqrt(d) if d > 0.0 else 0.0) - c[1 + 3 * n + i]
        rate[n + i] = (behind - force) * c[1 + i]
        behind = force


def peer(scene, method, times):
    """Force of the scene's contact at some times, as a function of the tolerance."""
    from CyRK import nbsolve2_ivp
    from CyRK.nb.numba_solver import cyjit_sig

    compiled, motion, n = numba.cfunc(cyjit_sig)(move), Motion(scene), scene.size
    rows = np.zeros((4, n))  # of the contact ahead of each bead; 0 without one
    rows[0] = 1 / motion.masses
    rows[1:, : len(motion.rest)] = motion.stiffnesses, motion.rest, motion.load

    def solve(rtol):
        solution = nbsolve2_ivp(
            compiled.address, (0.0, float(times[-1])), motion.start[: 2 * n], method=method,
            args=np.append(float(n), rows), t_eval=times, rtol=rtol, atol=rtol,
        )  # fmt: skip
        assert solution.success, solution.message
        y = np.array(solution.y[:n])
        solution.free()
        return motion.force(motion.compression(y))[scene.contact_sensors[0]]

    return solve


@pytest.mark.parametrize("name", TASKS)
def test_cost(name):
    task = TASKS[name]()
    scene, finest = task.scene, simulate(task.scene, rtol=FINEST)
    pulse, sensor = task.read(finest), ("contact", scene.contact_sensors[0])
    times = pulse.arrival + pulse.fwhm * np.linspace(-4, 3, 300)
    times = times[times <= scene.duration]
    exact = finest.signal(*sensor)(times)
    methods = {
        f"CyRK {method}": (peer(scene, method, times), end)
        for method, end in PEERS.items()
    }
    for method in COMPILED:
        methods[method] = partial(simulate, scene, method=method), 1e-12
    print(f"\n{name}, CPU time (ms) for the force to {WANTED}")
    for method, (run, end) in methods.items():
        run(rtol=1e-3)  # compiles
        rows = []
        for rtol in 10.0 ** -np.arange(4, -np.log10(end) + 0.1, 0.5):
            found, seconds = timed(partial(run, rtol=rtol))
            if method in COMPILED and found.path is None:  # too many steps are not kept
                break
            force = found.signal(*sensor)(times) if method in COMPILED else found
            rows.append((np.abs(force - exact).max() / exact.max(), seconds))
        assert min(rows)[0] < 1e-3
        print(method, *(f"{1e3 * cost(rows, wanted):.3g}" for wanted in WANTED))
