"""Random scenes of every kind, and the engine's errors on them against `reference`.

A scene amplifies errors, as its contacts open and close: by how much is the difference of the
reference at 1e-11 and at 1e-13, in units of 1e-11 and of the scales of the response.
"""

from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from lwa.law import Law, Power, named
from tests.validation.lattice.reference import follow
from validation.lattice.equations import Motion
from validation.lattice.simulate import simulate
from validation.scenes.forcing import Damping, Drive
from validation.scenes.scene import Scene

SAMPLES = 13
TOLERANCES = 1e-6, 1e-8, 1e-10
X = sp.Symbol("x", positive=True)
POWERS = 1, 1.1, 1.25, 1.5, 1.5, 1.5, 2, 3, 4
LAWS = (
    named("exponential", 1),
    named("hertz2", 1, 2),
    named("magnetic", 4, 2),
    Law(X ** sp.Rational(3, 2) - sp.Rational(1, 20), X),  # attracts where it opens
    Law(X**2 * sp.log(1 + 1 / X), X),  # no number at 0
    Law(sp.Rational(1, 10) + X ** sp.Rational(3, 2), X),  # jumps
)


def law_of(random, damped):
    """An exponent or a law; one for all contacts, or one for each."""
    other = damped not in ("kuwabara_kono", "restitution")

    def one():
        if other and random.random() < 0.3:
            return LAWS[random.integers(len(LAWS))]
        k = random.choice([*POWERS, random.uniform(1, 3)])
        return Power(sp.nsimplify(round(float(k), 3)))

    return one


def drive_of(random, kind, size, T):
    if kind == "piston":
        return Drive(velocity=size * random.choice([-1, 1]))
    if kind == "file":
        t = np.linspace(0, 1.1 * T, random.integers(6, 40))
        return Drive(time=t, displacement=size * np.cumsum(random.normal(size=len(t))))
    ramp = T / 3 if kind == "ramp" else 0.0
    return Drive(amplitude=size, frequency=random.uniform(0.05, 0.3), ramp=ramp)


def drawn(seed, most=40):
    """1 to ``most`` beads; one law or several; walls, gravity, load, gaps; any damping, any drive;
    mass ratios to 100, stiffness ratios to 30."""
    random = np.random.default_rng((54, seed))
    n = int(np.exp(random.uniform(0, np.log(most + 1))))
    kind = random.choice(["none", "none", "contact", "kuwabara_kono", "restitution"])
    masses = 10.0 ** (-random.choice([0, 1, 2]) * random.random(n))
    stiffnesses = 10.0 ** (-random.choice([0, 1.5]) * random.random(n))
    rest = {}
    if n == 1 or random.random() < 0.6:
        rest["wall"] = stiffnesses[-1]
        for name, share in (("gravity", 0.4), ("precompression", 0.3)):
            if random.random() < share:
                rest[name] = 10 ** random.uniform(-2, 0)
    contacts = n - 1 + ("wall" in rest)
    one = law_of(random, kind)
    unlike = contacts > 1 and random.random() < 0.3
    law = [one() for _ in range(contacts)] if unlike else one()
    damping = None
    if kind != "none":
        values = random.uniform(0.05, 0.99, contacts)
        if kind != "restitution":
            values = 10 ** random.uniform(-3, 0, contacts)
        several = unlike and random.random() < 0.5
        damping = Damping(kind, values if several else values[:1].sum() or 0.5)
    y, v = np.zeros((2, n))
    if random.random() < 0.6:
        v[random.integers(0, n, 2)] = random.uniform(-1, 1, 2)
    if random.random() < 0.2:
        y = random.uniform(-0.1, 0.1, n)
    if random.random() < 0.3:  # gaps
        y += np.cumsum((random.random(n) < 0.2) * random.uniform(0, 0.3, n))
        y -= max(0, y[-1]) if "wall" in rest else y[0]
    # A contact that touches at the start, with a force that jumps there, is neither open nor
    # closed.
    y += np.cumsum(random.uniform(0, 1e-3, n)) - 1e-3 * n
    driven = random.choice(["none", "none", "piston", "harmonic", "ramp", "file"])
    if driven != "none":
        v[0] = y[0] = 0
    elif not (y.any() or v.any()):
        v[0] = 1
    scene = Scene(
        masses=masses, stiffnesses=stiffnesses[: n - 1], law=law, damping=damping,
        displacements=y, velocities=v, samples=SAMPLES, duration=1, bead_sensors=range(n),
        contact_sensors=range(contacts), **rest,
    )  # fmt: skip
    size = 10 ** random.uniform(-1.5, 0)
    if driven != "none":
        scene = replace(scene, drive=Drive(velocity=size))
    time = Motion(scene).scales.time
    end = 10 ** random.uniform(0.5, 1.5) * (time if np.isfinite(time) else 1)
    made = None if driven == "none" else drive_of(random, driven, size, end)
    return replace(scene, duration=end, drive=made)


def units(scene, found):
    """Scales of length, velocity and energy of the response."""
    energy = found.energy.max()
    scales = Motion(scene, energy if energy > 0 else None).scales
    free = slice(scene.drive is not None, None)
    speed = max(scales.velocity, np.abs(found.v[:, free]).max(initial=0))
    length = max(scales.displacement, scales.compression)
    return length, speed, energy if energy > 0 else 1.0


def difference(y, v, found, unit, free):
    moved, faster = np.abs(y - found.y)[:, free], np.abs(v - found.v)[:, free]
    return max(moved.max(initial=0) / unit[0], faster.max(initial=0) / unit[1])


@dataclass
class Errors:
    """Errors of motion, of heat and work, and of the ledger, over the tolerance; all but the last
    over the amplification, too."""

    amplification: float
    motion: np.ndarray
    paid: np.ndarray
    drift: np.ndarray


def errors(scene, tolerances=TOLERANCES):
    times = np.arange(SAMPLES) / (SAMPLES - 1) * scene.duration
    scale = units(scene, follow(scene, times, 1e-6, (1.0, 1.0, 1.0)))
    exact, near = (follow(scene, times, rtol, scale) for rtol in (1e-13, 1e-11))
    unit, free = units(scene, exact), slice(scene.drive is not None, None)
    amplification = max(1, difference(near.y, near.v, exact, unit, free) / 1e-11)
    rows = []
    for rtol in tolerances:
        run = simulate(scene, rtol=rtol)
        moved = run.bead_displacement.T, run.bead_velocity.T
        lost, work = run.dissipated - exact.lost[-1], run.work - exact.work[-1]
        paid = max(abs(lost), abs(work)) / unit[2] / amplification
        error = difference(*moved, exact, unit, free) / amplification
        rows.append(np.array([error, paid, abs(run.energy_drift)]) / rtol)
    return Errors(amplification, *np.transpose(rows))
