"""End states, peaks and samples of random scenes, against SciPy's DOP853 at 1e-13.

A scene amplifies errors, as its contacts open and close: by how much is the difference of DOP853
at 1e-11 and 1e-13, in units of 1e-11 and of the scene's own scales. At default settings the engine
is within 10 rtol times that.
"""

import numpy as np
import pytest

from validation.lattice.cost import IntegrationError
from validation.lattice.equations import Motion
from validation.lattice.simulate import simulate
from validation.scenes.scene import Scene


def drawn(seed):
    """1 to 260 beads; k from 1 to 4; gaps, walls, gravity, load; several strikers or none; mass
    ratios to 1e4, stiffness ratios to 1e3."""
    random = np.random.default_rng((22, seed))
    n = int(np.exp(random.uniform(0, np.log(261))))
    k = random.choice(
        [1, 1.1, 1.25, 1.5, 2, 3, 4, random.uniform(1, 1.6), random.uniform(1, 4)]
    )
    period = n if random.random() < 0.5 else random.integers(1, 4)
    spread, stiffer = random.choice([0, 1, 4]), random.choice([0, 1, 3])
    masses = np.resize(10.0 ** (-spread * random.random(period)), n)
    stiffnesses = np.resize(10.0 ** (-stiffer * random.random(period)), n)
    rest = {}
    if n == 1 or random.random() < 0.5:
        rest["wall"] = stiffnesses[-1]
        for name, share in (("gravity", 0.5), ("precompression", 0.3)):
            if random.random() < share:
                rest[name] = 10 ** random.uniform(-3, 0)
    y, v = np.zeros((2, n))
    start = random.choice(["one", "some", "all", "none"])
    if start == "one":
        v[0] = 1
    elif start == "some":
        v[random.integers(0, n, 3)] = random.uniform(-1, 1, 3)
    elif start == "all":
        v = random.uniform(-1, 1, n)
    if start == "none" or random.random() < 0.2:
        y = random.uniform(-0.1, 0.1, n)
    if random.random() < 0.3:  # gaps
        y += np.cumsum((random.random(n) < 0.2) * random.uniform(0, 0.5, n))
    if "wall" in rest:
        y -= max(0, y[-1])
    if not (y.any() or v.any()):
        v[0] = 1
    scene = dict(
        masses=masses, stiffnesses=stiffnesses[:-1], k=k, displacements=y, velocities=v,
        samples=301, **rest,
    )  # fmt: skip
    time = Motion(Scene(**scene, duration=1)).scales.time
    cycles = 10 ** random.uniform(0.5, 2.1 if n < 12 else 1.5)
    reached = min(n, int(3 + cycles))
    contacts = min(reached, n - 1 + ("wall" in rest))
    return Scene(
        **scene, duration=cycles * (time if np.isfinite(time) else 1),
        bead_sensors=random.permutation(reached)[:5].tolist(),
        contact_sensors=random.permutation(contacts)[:5].tolist(),
    )  # fmt: skip


def units(scene, exact):
    """The scene's own scales, or the greatest value in the exact motion if that is more."""
    scales, motion = Motion(scene).scales, Motion(scene)

    def most(name):
        return np.abs(getattr(exact, name)).max(initial=0)

    force = motion.stiffnesses.max(initial=0) * scales.compression**scene.k
    force = max(force, most("contact_force"), most("bead_force")) or 1
    length = max(scales.displacement, scales.compression)
    speed = max(scales.velocity, most("velocities"), most("bead_velocity"))
    return dict(
        contact_force=force, bead_force=force, compression=length, bead_displacement=length,
        displacements=length, bead_velocity=speed, velocities=speed,
    )  # fmt: skip


def difference(run, exact, unit):
    """Greatest difference in all records and the final state."""
    return max(
        np.abs(getattr(run, name) - getattr(exact, name)).max(initial=0) / size
        for name, size in unit.items()
    )


def check(seed):
    scene = drawn(seed)
    try:
        exact, near = (
            simulate(scene, method="DOP853", rtol=rtol) for rtol in (1e-13, 1e-11)
        )
    except IntegrationError:  # rounding hides the motion at 1e-13: nothing is known
        return
    unit = units(scene, exact)
    amplification = max(1, difference(near, exact, unit) / 1e-11)
    for rtol in (1e-5, 1e-7, 1e-9):
        error = difference(simulate(scene, rtol=rtol), exact, unit)
        assert error < 10 * rtol * amplification, (seed, rtol)


@pytest.mark.parametrize("seed", range(900, 908))
def test_a_few_random_scenes(seed):
    check(seed)


@pytest.mark.slow
@pytest.mark.parametrize("batch", range(4))
def test_many_random_scenes(batch):
    for seed in range(batch, 40, 4):
        check(seed)
