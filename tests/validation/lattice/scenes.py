"""Random scenes of every kind, and the engine's errors on them against `reference`.

A scene amplifies errors, as its contacts open and close: by how much is the difference of the
reference at 1e-11 and at 1e-13, in units of 1e-11 and of the scales of the response.
"""

from dataclasses import replace

import numpy as np
import sympy as sp
from scipy.linalg import expm

from lwa.law import Law, Power, named
from tests.validation.lattice.reference import follow
from validation.lattice.equations import Motion
from validation.lattice.simulate import simulate
from validation.scenes.forcing import DAMPINGS, Damping, Drive
from validation.scenes.scene import Scene

SAMPLES = 13
X = sp.Symbol("x", positive=True)
POWERS = 1, 1.1, 1.25, 1.5, 1.5, 1.5, 2, 3, 4
HERTZ = X ** sp.Rational(3, 2)
TODA = named("exponential", 1)
MAGNETS = named("magnetic", 4, 2)
NO_NUMBER_AT_0 = Law(X**2 * sp.log(1 + 1 / X), X)
JUMPS = Law(HERTZ + sp.Rational(1, 10), X)
LAWS = (
    TODA,
    named("hertz2", 1, 2),
    MAGNETS,
    Law(HERTZ - sp.Rational(1, 20), X),  # attracts where it opens
    NO_NUMBER_AT_0,
    JUMPS,
)


def chain(masses, **fields):
    """A scene of beads, a number of equal ones or their masses, with unit contacts; Hertz's, unless
    k or a law is given."""
    if isinstance(masses, int):
        masses = (1,) * masses
    if "law" not in fields:
        fields = {"k": 1.5} | fields
    return Scene(masses=masses, **{"stiffnesses": (1,) * (len(masses) - 1)} | fields)


def on_springs(masses, stiffnesses, y, v, t):
    """Displacements and velocities after a time t of masses on springs, the last one at a wall."""
    n = len(masses)
    strain = np.eye(n) - np.eye(n, k=1)  # δ = strain @ y, the wall at rest
    pull = -(strain.T * stiffnesses) @ strain / np.reshape(masses, (n, 1))
    rates = np.block([[np.zeros((n, n)), np.eye(n)], [pull, np.zeros((n, n))]])
    return np.split(expm(t * rates) @ [*y, *v], 2)


def law_of(random, kind, loaded):
    """A law of a contact that allows a damping, and carries any load."""
    if kind in ("none", "contact") and random.random() < 0.3:
        return LAWS[random.integers(len(LAWS) - loaded)]
    k = random.choice([*POWERS, random.uniform(1, 3)])
    return Power(sp.nsimplify(round(float(k), 3)))


def drive_of(random, kind, size, T):
    if kind == "none":
        return None
    if kind == "piston":
        return Drive(velocity=size * random.choice([-1, 1]))
    if kind == "file":
        t = np.linspace(0, 1.1 * T, random.integers(6, 40))
        return Drive(time=t, displacement=size * np.cumsum(random.normal(size=len(t))))
    ramp = T / 3 if kind == "ramp" else 0.0
    return Drive(amplitude=size, frequency=random.uniform(0.05, 0.3), ramp=ramp)


def drawn(seed, most=40):
    """1 to ``most`` beads; one law or several; walls, gravity, load, gaps; any damping, any drive;
    mass ratios to 1e4, stiffness ratios to 30."""
    random = np.random.default_rng((54, seed))
    n = int(np.exp(random.uniform(0, np.log(most + 1))))
    stiffnesses = 10.0 ** (-random.choice([0, 1.5]) * random.random(n))
    fields = {
        "masses": 10.0 ** (-random.choice([0, 1, 2, 4]) * random.random(n)),
        "stiffnesses": stiffnesses[:-1],
    }
    if n == 1 or random.random() < 0.6:
        fields["wall"] = stiffnesses[-1]
        for name, share in (("gravity", 0.4), ("precompression", 0.3)):
            if random.random() < share:
                fields[name] = 10 ** random.uniform(-2, 0)
    contacts = n - 1 + ("wall" in fields)
    kind = random.choice(["none", "none", *DAMPINGS])
    count = contacts if random.random() < 0.3 else 1
    loaded = bool({"gravity", "precompression"} & {*fields})
    laws = [law_of(random, kind, loaded) for _ in range(count)]
    fields["law"] = laws
    if kind != "none":
        values = 10 ** random.uniform(-3, 0, count)
        if kind == "restitution":
            values = random.uniform(0.05, 0.99, count)
        fields["damping"] = Damping(kind, values)
    y, v = np.zeros((2, n))
    if random.random() < 0.6:
        v[random.integers(0, n, 2)] = random.uniform(-1, 1, 2)
    if random.random() < 0.2:
        y = random.uniform(-0.1, 0.1, n)
    if random.random() < 0.3:  # gaps
        y += np.cumsum((random.random(n) < 0.2) * random.uniform(0, 0.3, n))
    # A contact that touches at the start, with a force that jumps there, is neither open nor
    # closed: no two beads touch, and the last one touches a wall with a power's force alone.
    y += np.cumsum(random.uniform(0, 1e-3, n))
    y -= y[-1] + 1e-3 * (laws[-1] in LAWS) if "wall" in fields else y[0]
    kind = random.choice(["none", "none", "piston", "harmonic", "ramp", "file"])
    size = 10 ** random.uniform(-1.5, 0)
    if kind != "none":
        v[0] = y[0] = 0
        fields["drive"] = Drive(velocity=size)
    elif not v.any():
        v[0] = 1
    scene = Scene(
        **fields, displacements=y, velocities=v, samples=SAMPLES, duration=1,
        bead_sensors=range(n), contact_sensors=range(contacts),
    )  # fmt: skip
    time = Motion(scene).scales.time
    end = 10 ** random.uniform(0.5, 1.5) * (time if np.isfinite(time) else 1)
    return replace(scene, duration=end, drive=drive_of(random, kind, size, end))


def scales_of(scene, found):
    """Scales of length, velocity and energy of the response."""
    energy = found.energy.max()
    scales = Motion(scene, energy if energy > 0 else None).scales
    free = found.motion[:, 1, scene.drive is not None :]
    speed = max(scales.velocity, np.abs(free).max(initial=0))
    length = max(scales.displacement, scales.compression)
    return length, speed, energy if energy > 0 else 1.0


def errors(seed, tolerances):
    """Errors of the motion over the tolerance and the amplification, (tolerances,), and those of
    the energy over the tolerance."""
    scene = drawn(seed)
    times = np.arange(SAMPLES) / (SAMPLES - 1) * scene.duration
    scale = scales_of(scene, follow(scene, times, 1e-6, (1.0, 1.0, 1.0)))
    exact, near = (follow(scene, times, rtol, scale).motion for rtol in (1e-13, 1e-11))

    def off(motion):
        return (np.abs(motion - exact).max(axis=(0, 2)) / scale[:2]).max()

    amplification = max(1, off(near) / 1e-11)
    rows = []
    for rtol in tolerances:
        run = simulate(scene, rtol=rtol)
        motion = np.transpose((run.bead_displacement, run.bead_velocity), (2, 0, 1))
        error = off(motion) / amplification
        rows.append((error / rtol, abs(run.energy_drift) / rtol))
    return np.transpose(rows)
