"""Random scenes of every kind, against a reference that locates every event."""

import pytest

from tests.validation.lattice.scenes import drawn, errors
from validation.lattice.kernel.advance import advance
from validation.lattice.kernel.samples import interpolate
from validation.lattice.simulate import simulate

# All dampings, chains with a drive and without, laws that pull and jump, contacts of their own;
# contacts that amplify errors little, so that the reference tells.
FEW = 2, 5, 6, 24, 29, 39, 42
MANY = sorted({*range(60)} - {*FEW})


@pytest.mark.parametrize(
    "seed", [*FEW, *(pytest.param(seed, marks=pytest.mark.slow) for seed in MANY)]
)
def test_random_scenes(seed):
    motion, energy = errors(seed, (1e-6, 1e-8, 1e-10))
    # Of 180 runs one is at 5.5: damping δ^p with p = 0.05 almost jumps.
    assert motion.max() < 10
    # At 1e-10 one is at 20, by such an almost jump beside a driven bead, and one at 16.
    assert energy.max() < 30


def test_numba_compiles_for_two_kinds_of_scenes_only():
    """Chains with damping or a drive, and all others; samples and signals have one program."""
    for seed in FEW:
        run = simulate(drawn(seed), rtol=1e-6)
        assert len(run.bead_force) == run.scene.size  # samples
        run.signal("bead", 0)  # finds when the bead's contacts open
    assert len(advance.signatures) == 2
    assert len(interpolate.signatures) == 1
