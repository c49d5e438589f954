"""A reference for any scene, in NumPy and SciPy: every opening and closing of a contact is located.

Within a piece of the motion every contact stays closed or open, so that the forces are smooth, and
SciPy's DOP853 integrates y, v, the dissipated energy and the drive's work. A piece ends where a
contact closes (δ = 0) or opens (its force, elastic and damping force together, vanishes, or δ = 0
if its law attracts), at a sample, at the end of a ramp and at the knots of a file. The code shares
the scene's numbers with the engine, and nothing else.
"""

from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
import sympy as sp
from scipy.integrate import DOP853
from scipy.optimize import brentq

PLACES = np.linspace(0, 1, 13)[1:]  # in a step, at which the contacts are looked at


@dataclass
class Found:
    """Motion of a scene at some times: y, v (times, n); dissipated energy and work, (times,)."""

    y: np.ndarray
    v: np.ndarray
    lost: np.ndarray
    work: np.ndarray
    energy: np.ndarray  # of contacts and free beads


@lru_cache
def functions(k, law):
    """Force, energy, and whether the law pulls at δ < 0 and attracts where it opens."""
    if law is None:
        return lambda d: d**k, lambda d: d ** (k + 1) / (k + 1), False, False
    F, U = (sp.lambdify(law.delta, sp.N(e, 17)) for e in (law.F, law.energy))
    zero = float(sp.limit(law.energy, law.delta, 0, "+"))
    pulls = bool(sp.limit(law.slope(), law.delta, 0, "+") > 0)
    attracts = bool(sp.limit(law.F, law.delta, 0, "+") < 0)
    return F, lambda d: U(d) - zero, pulls, attracts


def _excess(F, force, d):
    """Force of a law at a compression d less a given force."""
    return F(d) - force


class Reference:
    """The equations of motion of a scene; ``closed`` holds the state of its contacts."""

    def __init__(self, scene):
        self.scene, self.n = scene, len(scene.masses)
        self.m = np.array(scene.masses)
        wall = () if scene.wall is None else (scene.wall,)
        self.A = np.array(scene.stiffnesses + wall)
        count = len(self.A)
        laws = [functions(*law) for law in scene.contact_laws]
        kinds = list(dict.fromkeys(laws))
        kind_of = np.array([kinds.index(law) for law in laws], int)
        self.groups = [(law, kind_of == i) for i, law in enumerate(kinds)]
        self.pulls = np.array([law[2] for law in laws], bool)
        self.sticks = self.pulls | np.array([law[3] for law in laws], bool)
        self.k = np.array([k for k, _ in scene.contact_laws])
        self.load, self.rest = np.array(scene.load), np.zeros(count)
        if self.load.any():
            for i, (F, *_) in enumerate(laws):
                force = self.load[i] / self.A[i]
                self.rest[i] = force ** (1 / self.k[i])
                if scene.contact_laws[i][1] is not None:
                    excess = partial(_excess, F, force)
                    self.rest[i] = brentq(excess, 1e-12, 50, xtol=1e-16)
            self.load = self.A * self.law("F", self.rest)
        self.c, self.p = np.zeros(count), np.zeros(count)
        if scene.damping is not None:
            inverse = np.append(1 / self.m, 0.0)
            reduced = 1 / (inverse[:-1] + inverse[1:])[:count]
            self.p = scene.damping.power(self.k)
            self.c = scene.damping.coefficients(self.k, self.A, reduced)
        self.closed = np.zeros(count, bool)

    def law(self, name, d):
        """Force or energy for unit stiffness of contacts that are all closed."""
        values = np.zeros(len(d))
        for (F, U, pulls, _), own in self.groups:
            x, function = d[own], F if name == "F" else U
            some = np.ones(len(x), bool) if pulls else x > 0
            values[np.flatnonzero(own)[some]] = function(x[some])
        return values

    def gaps(self, y, v):
        """Compressions and their rates; the wall is a bead at 0."""
        y, v = (np.append(x, 0.0)[: len(self.A) + 1] for x in (y, v))
        return self.rest + y[:-1] - y[1:], v[:-1] - v[1:]

    def forces(self, d, rate):
        """Elastic and total forces of contacts that are all closed."""
        elastic = self.A * self.law("F", d)
        slowed = np.where(self.p > 0, np.maximum(d, 0) ** self.p, 1.0)
        return elastic, elastic + self.c * slowed * rate

    def push(self, d, rate):
        """Forces over δ^p, which have no power less than 1."""
        pressed = np.maximum(d, 1e-300)
        return self.A * self.law("F", d) / pressed**self.p + self.c * rate

    def active(self, d, rate):
        """True for contacts that push: whether they should be closed."""
        pushes = self.sticks | (self.c == 0) | (self.push(d, rate) > 0)
        return self.pulls | ((d > 0) & pushes)

    def given(self, state, t):
        """Set the motion of a driven bead in a state; returns its acceleration."""
        if self.scene.drive is None:
            return None
        state[0], state[self.n], a = (float(x) for x in self.scene.drive.at(t))
        return a

    def __call__(self, t, state):
        n, state = self.n, state.copy()
        given = self.given(state, t)
        v = state[n : 2 * n]
        d, rate = self.gaps(state[:n], v)
        elastic, total = self.forces(d, rate)
        total = np.where(self.closed, total, 0.0)
        excess = np.zeros(n + 1)
        excess[1 : len(self.A) + 1] = total - self.load
        acceleration = (excess[:-1] - excess[1:]) / self.m
        work = 0.0
        if given is not None:
            acceleration[0] = given
            work = v[0] * (self.m[0] * given + excess[1])
        lost = ((total - elastic) * rate).sum()
        return np.concatenate((v, acceleration, (lost, work)))

    def energy(self, state):
        """Energy above equilibrium of the contacts and the free beads."""
        n = self.n
        d, _ = self.gaps(state[:n], state[n : 2 * n])
        kinetic = self.m * state[n : 2 * n] ** 2 / 2
        stored = self.A * (self.law("U", d) - self.law("U", self.rest))
        stored -= self.load * (d - self.rest)
        return kinetic[self.scene.drive is not None :].sum() + stored.sum()

    def start(self):
        n, state = self.n, np.zeros(2 * self.n + 2)
        state[: len(self.scene.displacements)] = self.scene.displacements
        state[n : n + len(self.scene.velocities)] = self.scene.velocities
        self.given(state, 0.0)
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
    atol = rtol * np.repeat(scale, (n, n, 2))
    stops = {*times.tolist(), *((drive.ramp, *drive.time) if drive is not None else ())}
    found = Found(*np.zeros((2, len(times), n)), *np.zeros((3, len(times))))
    ref.settle(state)
    first, longest = 1e-6, np.inf if drive is None else drive.longest_step
    options = dict(rtol=rtol, atol=atol, max_step=longest)
    least = 1e-2 * rtol * scale[1] * ref.m.min() if len(ref.A) else 0.0
    for stop in sorted(s for s in stops if 0 <= s <= times[-1]):
        while t < stop:
            stepper = DOP853(
                ref, t, state, stop, first_step=min(first, stop - t), **options
            )
            before, change = (t, state), None
            while stepper.status == "running" and change is None:
                before = stepper.t, stepper.y
                assert stepper.step() is None
                change = first_change(ref, stepper, *before, least)
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
            ref.given(state, stop)
            found.y[row], found.v[row] = state[:n], state[n : 2 * n]
            found.lost[row], found.work[row] = state[2 * n :]
            found.energy[row] = ref.energy(state)
    return found


def first_change(ref, stepper, t, state, least):
    """The contact that first changes in a step, if its force matters, when, and if it closes."""
    n, h = ref.n, stepper.t - t
    dense = stepper.dense_output()

    def gaps(time):
        moved = dense(time)
        ref.given(moved, time)
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
    if ref.c[i] == 0 or ref.sticks[i] or (not ref.closed[i] and d[i] <= 1e-9):
        return d[i] / rate[i]
    e = 1e-7 * max(abs(d[i] / rate[i]), 1e-9)  # of time
    push, later = ref.push(d, rate)[i], ref.push(d + e * rate, rate + e * second)[i]
    return e * push / (later - push)
