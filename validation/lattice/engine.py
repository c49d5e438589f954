"""The compiled engine: embedded pairs in Nyström form and a symplectic splitting.

Numba compiles the loops once and keeps them on disk. A run is the same to the last bit every time.

Pair: two solutions of ``y'' = f(y)``, or of ``y'' = f(y, y')`` for damped contacts, with adaptive
steps h (`validation.lattice.schemes`). The error of a step is the root of the sum over all beads of
the squared errors, in the scene's scales of displacement and velocity; ``rtol`` bounds this error.
``F = A δ^k`` with ``k = 3/2`` has no second derivative at a kink, the time at which a contact opens
or closes, and a step across a kink would err by ``O(h^{k+1})``. So the force of such a contact is
integrated by a quadrature that knows the kink (`validation.lattice.kernel.kinks`).

Splitting: symplectic, with a fixed step. Every kink leaves an error of ``O(h^{k+1})``, which sets
the step.

Drive: a first bead of infinite mass with a given motion. Steps end at the end of a ramp and at the
knots of a file.

Front: beads ahead of the front have not moved yet and are left out.

Tiles: all stages of a step are computed for some hundred beads before the next beads are looked at,
so that what a stage reads is still in the processor's cache.
"""

from __future__ import annotations

import math
import sys
from functools import lru_cache
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.cost import (
    IntegrationError,
    RunProgress,
    check_memory,
    step_limit,
)
from validation.lattice.equations import Motion
from validation.lattice.kernel.advance import advance
from validation.lattice.kernel.arrays import (
    LAW,
    MARGIN,
    ROOM,
    SHORTEST,
    Beads,
    Chain,
    Forcing,
    Pair,
    Plan,
    Splitting,
    initial_progress,
    records,
)
from validation.lattice.kernel.kinks import EDGES
from validation.lattice.kernel.symplectic import advance_split
from validation.lattice.knots import Recorder
from validation.lattice.laws import Contact
from validation.lattice.result import Run
from validation.lattice.schemes import BLANES_MOAN, RK853, RKN86
from validation.scenes.forcing import Drive

# The response of a drive is guessed. Where its energy turns out less than _WEAK times the energy
# that sets the tolerance, the run is made again, no more than _GUESSES times in all; where it grows
# to more than _STRONG times, the run goes on with the tolerance of the greater energy.
_WEAK, _STRONG, _GUESSES = 0.1, 10.0, 8
_HIDDEN = 0.1  # rounding in units of the tolerance: more of it hides the motion
# A bead is still at the start if its |y| and |v| are less than this part of the greatest ones.
_NOISE = sys.float_info.epsilon
# Bead evaluations between two reports of progress: some tenths of a second.
_BETWEEN_REPORTS = 5e7
# The splitting's step per stage is (rtol/0.01)^0.4 in units of the scene's shortest time, measured
# on a Hertz dimer of 560 beads; at 0.2 it is still stable.
_KINKS, _COARSEST = 0.01, 0.2
# First step of a pair over rtol^(1/order), in units of the scene's shortest time: a step with about
# this error at the greatest compression.
_FIRST = 4.0
# Numbers of a sample that a run holds at a time: motion of a bead and its two neighbours, forces
# and compressions, and the copies that NumPy makes of them.
_NUMBERS = 16
# Beyond a free end nothing presses, but 0 times the force of another law, or of so high a power,
# may be no number.
_UNBOUNDED = 5.0
_STILL = Drive(velocity=0.0)  # numba knows no tuple without numbers
_LOOSER = 1e4  # factor of a tolerance that is proposed; a run for errors has 1/100 of the user's
_ANY_POWER = 0.25  # a general law may begin with δ^{1/4}
# From this power on δ^k is smooth enough for the correction's 25 points. In u, δ = u⁴, they err by
# 130 tolerances at k = 40.5, where a collision by u = δ errs by 0.2; at k = 3.3 both err alike.
_SMOOTH = 3.0


def integrate(
    motion: Motion, method: str, rtol: float, longest: float, progress: RunProgress
) -> Run:
    """Integrate a scene by a compiled method, in steps of at most ``longest``.

    The method is one of `validation.lattice.simulate.COMPILED`. The steps of a splitting have the
    length ``longest``, unless it is infinite. A run whose tolerance is set by a drive, and whose
    response turns out far weaker, is made again.
    """
    for _ in range(_GUESSES):
        run = _Integration(motion, method, rtol, longest)
        run.advance(progress)
        if motion.scene.drive is None:
            return run.finished()
        energy = run.motion.scales.energy
        response = run.now["response"]
        # A response of no more than eight roundings of the energy is no scale of a new run.
        if not 8 * _NOISE * energy < response < _WEAK * energy:
            return run.finished()
        motion = Motion(motion.scene, response)
    raise IntegrationError(
        f"the drive's work, {response:.1g} at last, is no scale of the tolerance in "
        f"{_GUESSES} runs: choose another drive, or a shorter duration"
    )


class _Integration:
    """A run of the compiled loops: their records, and how far they have come."""

    def __init__(
        self, motion: Motion, method: str, rtol: float, longest: float
    ) -> None:
        self.motion = motion
        self.method = method
        check_memory(motion.scene, method, rows=_NUMBERS)
        self.steps = rtol, longest  # the tolerance, and the greatest step
        self._make_plan(motion)
        self.chain = _chain(motion)
        self.forcing = _forcing(motion)
        padded = len(self.chain.A)
        self.beads = _start(motion, padded, self.plan.scheme)
        self.recorder = Recorder(motion, self.chain)
        front = _front(motion)
        self.now = initial_progress(self.plan, front, motion.free_energy)

    def _make_plan(self, motion: Motion) -> None:
        """Plan the steps by the scales of a motion, and set their greatest number."""
        self.motion = motion
        planned = _splitting_plan if self.method == "symplectic" else _pair_plan
        self.plan, self.most_tries = planned(motion, *self.steps)

    def advance(self, progress: RunProgress) -> None:
        """Integrate to the end; a stronger response than was guessed loosens the tolerance."""
        now = self.now
        end = self.plan.end
        knots = self.recorder.knots
        # A step has some ten stages.
        size = max(self.plan.size, SHORTEST)
        # Steps that are tried between two reports of progress
        glance = 1 + int(_BETWEEN_REPORTS / (10 * size))
        go = advance if isinstance(self.plan.scheme, Pair) else advance_split
        t = 0.0
        with progress() as display:
            while t < end:
                display(t / end)
                t = go(
                    self.chain, self.forcing, self.beads, self.plan, knots, now, glance
                )
                # The new plan has a greater tolerance; steps go on from the present motion.
                if now["response"] > self.plan.most:
                    response = float(now["response"])
                    self._make_plan(Motion(self.motion.scene, response))
                # The engine has stored the motion at the ends of its steps, until its room is full.
                if t == end or now["stored"] == len(knots.time):
                    stored = int(now["stored"])
                    now["stored"] = self.recorder.take(stored)
                stuck = t + now["h"] == t
                # The proposal is the user's rtol, loosened; `steps` begins with it.
                if t < end and (now["tries"] > self.most_tries or stuck):
                    looser = f"{_LOOSER * self.steps[0]:.0e}"
                    raise IntegrationError(self._failure(), rtol=looser)

    def _failure(self) -> str:
        """Say why the run does not come to its end."""
        now = self.now
        where = f"t = {now['t']:g} of {self.plan.end:g}"
        # Row 1 of the forces is that of the stage computed last; row 0 belongs to the step's start.
        finite = np.isfinite(self.beads.force[1:])
        if not finite.all() or now["h"] == 0:
            return f"a force is not a number near {where}: no step is short enough for the law"
        if now["t"] + now["h"] == now["t"]:
            length = f"its length, {now['h']:.1g}, is rounding of the time"
            return f"no step is left at {where}: {length}"
        rounding = self.motion.scales.rounding
        hidden = rounding * self.motion.scales.displacement
        if hidden > _HIDDEN * self.plan.y:
            cause = (
                f"rounding of the static compression, {rounding:.1g} of the motion, hides the "
                "motion at this rtol"
            )
        else:
            cause = (
                "contacts open and close too often, or rtol is too small for the motion"
            )
        return f"{now['tries']} steps of {self.method} reach {where}: {cause}"

    def finished(self) -> Run:
        """Return the finished run."""
        motion = self.motion
        beads = self.beads
        now = self.now
        n = motion.size
        balance = now["lost"], now["work"]
        end = np.concatenate((beads.y[:n], beads.v[:n], balance))
        samples = self.recorder.samples
        steps = int(now["steps"])
        if samples:
            # Parts (2, beads, times), one after the other in time
            all_samples = np.concatenate(samples, axis=2)
            return Run(motion, end, steps, samples=all_samples)
        return Run(motion, end, steps, self.recorder.path())


def _plan(motion: Motion, scheme: Pair | Splitting, rtol: float, **steps: Any) -> Plan:
    """Build the integration plan of a scene.

    steps : the fields h, longest and stops of a `Plan`.
    """
    scales = motion.scales
    most = math.inf
    if motion.scene.drive is not None and scales.energy > 0:
        most = _STRONG * scales.energy
    return Plan(
        scheme=scheme,
        rtol=rtol,
        y=rtol * scales.displacement,
        v=rtol * scales.velocity,
        energy=rtol * (scales.energy or 1.0),
        end=motion.scene.duration,
        deepest=scales.compression,
        lightest=motion.masses.min(),
        size=motion.size,
        most=most,
        **steps,
    )


def _pair_plan(motion: Motion, rtol: float, longest: float) -> tuple[Plan, int]:
    """Return the plan of an embedded pair, and the greatest number of steps that are tried.

    Steps end at the duration, at the end of a drive's ramp and at the knots of its file. The first
    step is at most `_FIRST` times ``rtol^(1/order)`` of the scene's shortest time.
    """
    scene = motion.scene
    time = motion.scales.time
    end = scene.duration
    pair = RKN86 if scene.damping is None else RK853
    stops = {end}
    if scene.drive is not None:
        # At least two steps for the length in which a drive has one extremum or one cubic
        longest = min(longest, scene.drive.longest_step / 2)
        joints = (scene.drive.ramp, *scene.drive.time)
        stops |= {t for t in joints if 0 < t < end}
    typical = min(time, longest)
    most = step_limit(scene, "RKN86", end / typical)
    # Short scenes begin with a hundredth: a first step that is too short costs little.
    accurate = _FIRST * rtol ** (1 / pair.order) * time
    h = min(accurate, longest, end / 100)
    times = np.array(sorted(stops), float)
    plan = _plan(motion, pair, rtol, h=h, longest=longest, stops=times)
    return plan, most


def _splitting_plan(motion: Motion, rtol: float, step: float) -> tuple[Plan, int]:
    """Return the plan of the splitting, and the greatest number of steps."""
    end = motion.scene.duration
    if math.isinf(step):
        stage = min((rtol / _KINKS) ** 0.4, _COARSEST)
        stages = len(BLANES_MOAN.drifts)
        time = min(motion.scales.time, end)
        step = stage * stages * time
    most = step_limit(motion.scene, "symplectic", end / step)
    h = end / math.ceil(end / step)
    stops = np.array([end])
    plan = _plan(motion, BLANES_MOAN, rtol, h=h, longest=h, stops=stops)
    return plan, most


@lru_cache(maxsize=1)
def _chain(motion: Motion) -> Chain:
    """Build the kernel's chain, padded by beads of infinite mass; the first of them is the wall."""
    n = motion.size
    contacts = len(motion.rest)
    # Room for the loops, which move `SHORTEST` beads or more, in whole blocks.
    padded = n + 2 * SHORTEST
    inverse, A, r, rest, load, opens = _lines(6, padded)
    inverse[:n] = 1 / motion.masses
    if motion.scene.drive is not None:
        inverse[0] = 0.0
    A[:contacts] = motion.stiffnesses
    r[:contacts] = motion.damping / motion.stiffnesses
    rest[:contacts] = motion.rest
    load[:contacts] = motion.load
    laws = [*motion.laws] or [Contact(1.0)]  # of a single bead: the padding's
    # The padding, of stiffness 0, has the last contact's law, so that one loop takes both; but a
    # linear one where the last contact's force may overflow as a free end moves on (`_UNBOUNDED`).
    beyond = motion.law_of[-1] if contacts else 0
    last = laws[beyond]
    if last.law is not None or last.k >= _UNBOUNDED:
        beyond = len(laws)
        laws.append(Contact(1.0))
    law_of = np.full(padded, beyond)
    law_of[:contacts] = motion.law_of
    # Contacts at which another law begins: for each contact the first of them ahead of it, up to
    # which a loop may take the contacts together
    changes = np.flatnonzero(np.diff(law_of))
    places = np.append(changes + 1, padded)
    following = np.searchsorted(places, np.arange(padded), side="right")
    # A contact that pulls holds at every δ, and has no kink.
    pulls = np.array([law.pulls for law in laws])
    opens[:contacts] = ~pulls[motion.law_of]
    rows = [_record(law) for law in laws]
    return Chain(
        inverse=inverse,
        A=A,
        r=r,
        rest=rest,
        load=load,
        opens=opens,
        laws=records(np.array(rows, LAW)),
        law=law_of,
        alike=places[following],
    )


def _record(law: Contact) -> tuple[Any, ...]:
    """Return a law as a record, a tuple in the order of the fields of `LAW`."""
    kinds = law.law is not None, law.pulls, law.sticks
    numbers = law.k, law.damping_power or 0.0, _exponent(law)
    return (*numbers, *kinds, *law.addresses.values())


@lru_cache(maxsize=1)
def _forcing(motion: Motion) -> Forcing | None:
    """Return damping and drive for the kernel; None for a chain with neither."""
    scene = motion.scene
    damped = scene.damping is not None
    if scene.drive is None and not damped:
        return None
    drive = scene.drive or _STILL
    # The drive's cubics are two fields: when they begin, and their coefficients.
    amplitude, w = drive.oscillation
    return Forcing(
        *drive.cubics,
        float(amplitude),
        w,
        float(drive.ramp),
        driven=scene.drive is not None,
        damped=damped,
    )


def _exponent(law: Contact) -> float:
    """Return q such that the forces are smooth in u, δ = u^q, where a contact opens or closes.

    F is a series in powers of δ^k, δ^p and δ. For q = 4 weak singularities may be left.
    """
    k = law.k if law.law is None else _ANY_POWER
    for power in (k, law.damping_power or 0.0):
        if power < _SMOOTH and not power.is_integer():
            return 4.0
    return 1.0


@lru_cache(maxsize=1)
def _front(motion: Motion) -> int:
    """Return the number of the first bead ahead of all motion at the start, plus a margin."""
    # Rows |y| and |v| of the state, without its last two entries, heat and work
    motions = np.abs(motion.start[:-2].reshape(2, -1))
    moves = _NOISE * motions.max(axis=1) < motions.T
    moving, _ = moves.nonzero()
    first = 0 if motion.scene.drive is None else 1
    if len(moving):
        first = max(first, moving[-1] + 1)
    return min(motion.size, MARGIN + first)


def _start(motion: Motion, padded: int, scheme: Pair | Splitting) -> Beads:
    """Build the kernel's initial state, arrays with room for ``padded`` + 1 beads."""
    n = motion.size
    estimates = 0
    if isinstance(scheme, Pair):
        estimates = len(scheme.errors)
    # Five rows that have names below, the errors, room for the stages, and two rows of forces
    rows = _lines(7 + estimates + ROOM, padded + 2)
    # Two rows, one place ahead of the others: lines begin at column 1, the force of contact 0.
    columns = rows.shape[1]
    ahead = rows.reshape(-1)[-2 * columns - 1 : -1]
    y, v, next_y, next_v, marks = rows[:5]
    y[:n] = next_y[:n] = motion.start[:n]
    v[:n] = next_v[:n] = motion.start[n : 2 * n]
    given = np.zeros(2)
    if motion.scene.drive is not None:
        # The bead's acceleration, after its displacement and velocity
        given[:] = motion.scene.drive.at(0.0)[2]
    return Beads(
        y=y,
        v=v,
        next_y=next_y,
        next_v=next_v,
        force=ahead.reshape(2, -1),
        push=rows[5 + estimates : -2],
        errors=rows[5 : 5 + estimates],
        marks=marks,
        power=np.zeros((2, ROOM)),
        given=given,
        books=np.zeros(6),
        points=np.zeros((3, ROOM)),
        edges=np.zeros(EDGES),
    )


def _lines(rows: int, columns: int) -> Array:
    """Return an array of zeros whose rows begin at lines of the cache.

    A line is 64 bytes, eight numbers. A row has an odd number of lines, so that rows do not compete
    for the same places in the cache.
    """
    # -(-a // 8) rounds up to whole lines, and | 1 makes their number odd. ``start`` counts the
    # numbers from the memory's first byte to the next line.
    width = 8 * (-(-columns // 8) | 1)
    memory = np.zeros(8 + rows * width)
    start = -memory.ctypes.data // 8 % 8
    return memory[start : start + rows * width].reshape(rows, width)
