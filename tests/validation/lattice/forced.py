"""A reference for damped and driven chains, in NumPy and SciPy: every opening and closing located.

Within a piece of the motion every contact stays closed or open, so that the forces are smooth, and
SciPy's DOP853 integrates y, v, the dissipated energy and the drive's work. A piece ends where a
contact closes (δ = 0) or opens (its force, elastic and damping force together, vanishes), at a
sample, at the end of a ramp and at the knots of a file. The code shares the scene's numbers with
the engine, and nothing else.
"""

from dataclasses import dataclass

import numpy as np
import sympy as sp
from scipy.integrate import DOP853
from scipy.optimize import brentq

PLACES = np.linspace(0, 1, 13)[1:]  # in a step, at which the contacts are looked at


@dataclass
class Motion:
    """Motion of a scene at some times: y, v (times, n); dissipated energy and work, (times,)."""

    y: np.ndarray
    v: np.ndarray
    lost: np.ndarray
    work: np.ndarray
    energy: np.ndarray  # of contacts and free beads


class Reference:
    """The equations of motion of a scene; ``closed`` holds the state of its contacts."""

    def __init__(self, scene):
        self.scene, self.n = scene, len(scene.masses)
        self.m = np.array(scene.masses)
        wall = () if scene.wall is None else (scene.wall,)
        self.A = np.array(scene.stiffnesses + wall)
        self.load = np.array(scene.load)
        k, law, forces = scene.k, scene.law, self.load / self.A
        if law is None:
            self.F, self.U, self.pulls = (
                lambda d: d**k,
                lambda d: d ** (k + 1) / (k + 1),
                False,
            )
            self.rest = forces ** (1 / k)
        else:
            self.F, self.U = (
                sp.lambdify(law.delta, sp.N(e, 17)) for e in (law.F, law.energy)
            )
            self.pulls = bool(law.slope().subs(law.delta, 0).is_positive)
            self.rest = np.array(
                [brentq(lambda d, f=f: self.F(d) - f, 0, 50) for f in forces]
            )
        if self.load.any():
            self.load = self.A * self.F(self.rest)
        self.c, self.p = np.zeros(len(self.A)), 0.0
        if scene.damping is not None:
            inverse = np.append(1 / self.m, 0.0)
            reduced = 1 / (inverse[:-1] + inverse[1:])[: len(self.A)]
            self.p = scene.damping.power(scene.k)
            self.c = scene.damping.coefficients(scene.k, self.A, reduced)
        self.closed = np.zeros(len(self.A), bool)

    def gaps(self, y, v):
        """Compressions and their rates; the wall is a bead at 0."""
        y, v = (np.append(x, 0.0)[: len(self.A) + 1] for x in (y, v))
        return self.rest + y[:-1] - y[1:], v[:-1] - v[1:]

    def forces(self, d, rate):
        """Elastic and total forces of contacts that are all closed."""
        pressed = d if self.pulls else np.maximum(d, 0)
        elastic = self.A * self.F(pressed)
        return elastic, elastic + self.c * (pressed**self.p if self.p else 1.0) * rate

    def push(self, d, rate):
        """Forces over δ^p, which have no power less than 1."""
        pressed = np.maximum(d, 0)
        power = (
            pressed ** (self.scene.k - self.p)
            if self.scene.law is None
            else self.F(pressed)
        )
        return self.A * power + self.c * rate

    def active(self, d, rate):
        """True for contacts that push: whether they should be closed."""
        if self.pulls:
            return np.ones(len(d), bool)
        return (d > 0) & ((self.c == 0) | (self.push(d, rate) > 0))

    def __call__(self, t, state):
        n, drive = self.n, self.scene.drive
        y, v = state[:n].copy(), state[n : 2 * n].copy()
        if drive is not None:
            y[0], v[0], a = (float(x) for x in drive.at(t))
        d, rate = self.gaps(y, v)
        elastic, total = self.forces(d, rate)
        total = np.where(self.closed, total, 0.0)
        excess = np.zeros(n + 1)
        excess[1 : len(self.A) + 1] = total - self.load
        acceleration = (excess[:-1] - excess[1:]) / self.m
        work = 0.0
        if drive is not None:
            acceleration[0] = a
            work = v[0] * (self.m[0] * a + excess[1])
        return np.concatenate(
            (v, acceleration, (((total - elastic) * rate).sum(), work))
        )

    def energy(self, state):
        """Energy above equilibrium of the contacts and the free beads."""
        n = self.n
        d, _ = self.gaps(state[:n], state[n : 2 * n])
        kinetic = self.m * state[n : 2 * n] ** 2 / 2
        pressed = d if self.pulls else np.maximum(d, 0)
        stored = self.A * (self.U(pressed) - self.U(self.rest)) - self.load * (
            d - self.rest
        )
        return kinetic[self.scene.drive is not None :].sum() + stored.sum()

    def start(self):
        n, state = self.n, np.zeros(2 * self.n + 2)
        state[: len(self.scene.displacements)] = self.scene.displacements
        state[n : n + len(self.scene.velocities)] = self.scene.velocities
        if self.scene.drive is not None:
            state[0], state[n], _ = self.scene.drive.at(0.0)
        return state

    def settle(self, state, which=...):
        """Give the contacts their states at a time; touching contacts that approach are closed."""
        d, rate = self.gaps(state[: self.n], state[self.n : 2 * self.n])
        wanted = self.active(d, rate) | ((np.abs(d) < 1e-15) & (rate > 0))
        self.closed[which] = wanted[which]


def follow(scene, times, rtol, scale):
    """The motion at increasing times by DOP853 at ``rtol``; scale: of y, v and energy."""
    ref = Reference(scene)
    n, drive = ref.n, scene.drive
    state, t = ref.start(), 0.0
    atol = rtol * np.concatenate(
        (np.full(n, scale[0]), np.full(n, scale[1]), (scale[2],) * 2)
    )
    stops = {*times.tolist(), *((drive.ramp, *drive.time) if drive is not None else ())}
    found = Motion(*np.zeros((2, len(times), n)), *np.zeros((3, len(times))))
    ref.settle(state)
    first, longest = 1e-6, np.inf if drive is None else drive.longest_step
    options = dict(rtol=rtol, atol=atol, max_step=longest)
    least = 1e-2 * rtol * scale[1] * ref.m.min() if len(ref.A) else 0.0
    for stop in sorted(s for s in stops if 0 <= s <= times[-1]):
        while t < stop:
            stepper = DOP853(
                ref, t, state, stop, first_step=min(first, stop - t), **options
            )
            before = t, state
            while stepper.status == "running":
                before = stepper.t, stepper.y
                assert stepper.step() is None
                change = first_change(ref, stepper, *before, least)
                if change is not None:
                    break
            if change is None:
                t, state = stepper.t, stepper.y
                first = min(1e-3, stepper.h_abs)
                ref.settle(state)
                continue
            # Again up to the change, which is found more exactly at the end of a step of its own.
            which, at, closes = change
            for _ in range(3):
                state, t = before[1], before[0]
                if at > t:
                    again = DOP853(ref, t, state, at, first_step=at - t, **options)
                    while again.status == "running":
                        assert again.step() is None
                    t, state = at, again.y
                late = lateness(ref, state, t, which)
                if abs(late) < 1e-15 * max(t, 1) or at - late <= before[0]:
                    break
                at -= late
            ref.settle(state)
            ref.closed[which] = closes
            first = max(1e-8 * (stepper.t - before[0]), 1e-13 * t)
        if stop in times:
            row = int(np.searchsorted(times, stop))
            found.y[row], found.v[row] = state[:n], state[n : 2 * n]
            if drive is not None:
                found.y[row, 0], found.v[row, 0], _ = drive.at(stop)
            found.lost[row], found.work[row] = state[2 * n :]
            found.energy[row] = ref.energy(state)
    return found


def first_change(ref, stepper, t, state, least):
    """The contact that first changes in a step, if its force matters, when, and if it closes."""
    n, h = ref.n, stepper.t - t
    dense = stepper.dense_output()

    def gaps(time):
        moved = dense(time)
        if ref.scene.drive is not None:
            moved[0], moved[n], _ = ref.scene.drive.at(time)
        return ref.gaps(moved[:n], moved[n : 2 * n])

    most = np.zeros(len(ref.A))
    wrong = np.zeros((len(PLACES), len(ref.A)), bool)
    for row, x in enumerate(PLACES):
        d, rate = gaps(t + x * h)
        _, total = ref.forces(d, rate)
        most = np.maximum(most, np.where(ref.closed | (d > 0), np.abs(total), 0.0))
        wrong[row] = ref.active(d, rate) != ref.closed
    matters = np.flatnonzero(wrong.any(axis=0) & (most * h > least))
    best = None
    for i in matters:
        high = t + PLACES[wrong[:, i].argmax()] * h
        low = high - h / len(PLACES)
        for _ in range(60):
            middle = (low + high) / 2
            if (ref.active(*gaps(middle)) != ref.closed)[i]:
                high = middle
            else:
                low = middle
        if best is None or high < best[1]:
            best = i, high, not ref.closed[i]
    return best


def lateness(ref, state, t, i):
    """How long ago a contact's change was, to first order; negative before the change."""
    n, rates = ref.n, ref(t, state)
    d, rate = ref.gaps(state[:n], state[n : 2 * n])
    _, second = ref.gaps(rates[:n], rates[n : 2 * n])
    if ref.c[i] == 0 or (not ref.closed[i] and d[i] <= 1e-9):
        return d[i] / rate[i]
    e = 1e-7 * max(abs(d[i] / rate[i]), 1e-9)  # of time
    push, later = ref.push(d, rate)[i], ref.push(d + e * rate, rate + e * second)[i]
    return e * push / (later - push)
