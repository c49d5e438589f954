"""A reference for any scene, in NumPy and SciPy: every opening and closing of a contact is located.

The compiled loops integrate across the kinks of the forces. Here each contact is closed or open, so
that within a piece of the motion the forces are smooth, and SciPy's DOP853 integrates `Motion` from
one change of a contact to the next.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from validation.lattice.equations import Motion

PLACES = np.linspace(0, 1, 13)  # in a step, at which the contacts are looked at


@dataclass
class Found:
    """Displacements and velocities of a scene at some times, (times, 2, n), and its energies.

    A driven bead's energy is left out.
    """

    motion: np.ndarray
    energy: np.ndarray


class Pieces(Motion):
    """The equations of motion; ``closed`` holds the state of the contacts."""

    def __init__(self, scene):
        super().__init__(scene)
        laws = [self.laws[number] for number in self.law_of]
        self.p = np.array([law.damping_power or 0.0 for law in laws])
        self.pulls = np.array([law.pulls for law in laws], bool)
        self.holds = np.array([law.sticks for law in laws], bool) | (self.damping == 0)
        y, v = self.start[:-2].reshape(2, -1)
        margins = self.margins(y, v)
        # Contacts that touch, and approach, are closed.
        touching = (np.abs(margins) < 1e-15) & (self.rate(v) > 0)
        self.closed = (margins > 0) | touching

    def damped_force(self, elastic, compression, rate, contacts=...):
        """The forces of the contacts that are closed."""
        drag = np.where(self.p > 0, np.maximum(compression, 0) ** self.p, 1.0)
        return np.where(self.closed, elastic + self.damping * drag * rate, 0.0)

    def margins(self, y, v):
        """Positive numbers for contacts that should be closed: δ or, where damping may not pull,
        also the force over δ^p, which has no power below 1."""
        d = self.compression(y)
        # A contact that only just touches has δ^p = 0: of no force, as of 1e-100.
        push = self.force(d) / np.maximum(d, 1e-100) ** self.p
        push += self.damping * self.rate(v)
        margins = np.where(self.holds, d, np.minimum(d, push))
        return np.where(self.pulls, np.inf, margins)

    def first_change(self, solver):
        """The first time in a step at which a contact changes, and its number; None without one."""
        dense = solver.dense_output()

        def wrongs(time):
            """Positive numbers for contacts that are closed and should be open, or the reverse."""
            y, v = dense(time)[:-2].reshape(2, -1)
            if self.scene.drive is not None:
                y[0], v[0], _ = self.scene.drive.at(time)
            return np.where(self.closed, -1, 1) * self.margins(y, v)

        times = solver.t_old + PLACES * solver.step_size
        rows = np.array([wrongs(time) for time in times])
        changes = []
        for i in np.flatnonzero((rows[1:] > 0).any(axis=0)):
            n = int(np.argmax(rows[1:, i] > 0))
            at = times[n]
            if rows[n, i] < 0:
                at = brentq(lambda t, i=i: wrongs(t)[i], at, times[n + 1], xtol=1e-16)
            changes.append((at, i))
        return min(changes, default=None)


def follow(scene, times, rtol, scale):
    """The motion at increasing times by DOP853 at ``rtol``; scale: of y, v and energy."""
    motion, drive = Pieces(scene), scene.drive
    n, t, state = motion.size, 0.0, motion.start
    options = {"rtol": rtol, "atol": rtol * np.repeat(scale, (n, n, 2))}
    stops = {*times}
    if drive is not None:
        stops |= {stop for stop in (drive.ramp, *drive.time) if 0 < stop < times[-1]}
        options["max_step"] = drive.longest_step
    step = 1e-6
    rows = []
    for stop in sorted(stops):
        while t < stop:
            first = min(step, stop - t)
            solver = DOP853(motion, t, state, stop, first_step=first, **options)
            change = None
            while solver.status == "running" and change is None:
                t, state = solver.t, solver.y
                assert solver.step() is None
                change = motion.first_change(solver)
            if change is None:
                t, state, step = solver.t, solver.y, min(1e-3, solver.h_abs)
                continue
            # The step again, up to the change: the motion is known best at the end of a step.
            at, contact = change
            if at > t:
                solver = DOP853(motion, t, state, at, first_step=at - t, **options)
                while solver.status == "running":
                    assert solver.step() is None
                state = solver.y
            step = max(1e-8 * (solver.t - t), 1e-13 * at)
            t = at
            motion.closed[contact] ^= True
        if stop in times:
            if drive is not None:
                state[0], state[n], _ = drive.at(stop)
            kinetic, stored = motion.energies(state)
            energy = kinetic[drive is not None :].sum() + stored.sum()
            rows.append((state[:-2].reshape(2, n).copy(), energy))
    return Found(*map(np.array, zip(*rows, strict=True)))
