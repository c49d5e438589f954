"""The peers integrate the same motion; a missing one is told, or refused in CI."""

import sys

import numpy as np
import pytest
from scipy import integrate as scipy

from validation.scenes.scene import Scene, SceneError
from validation.studies.accuracy import peers
from validation.studies.accuracy.peers import PEERS, PeerError, missing, prepared
from validation.studies.accuracy.reference import integrate
from validation.studies.accuracy.tasks import Task, errors, struck


def loaded():
    """A light chain under weight and a wall, to see that rest, load and wall are passed on."""
    scene = Scene(
        masses=(1.0, 0.3, 2.0, 0.7), stiffnesses=(1.0, 2.0, 0.5), wall=1.5, gravity=0.1, k=1.5,
        velocities=(0.3,), duration=8.0, samples=161, contact_sensors=(2,),
    )  # fmt: skip
    return Task(scene, 1.0)


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
@pytest.mark.filterwarnings("default::DeprecationWarning")
def test_a_peer_agrees_with_scipy(peer):
    """To 1e-6, what kinks leave of tolerances of 1e-10."""
    pytest.importorskip(peer.package)
    for task in (struck(0.2733, 16, 10, 5.0, 17.0), loaded()):
        y = peer.prepare(task, peer.method)(1e-10, task)
        assert y.shape == (task.scene.size, len(task.times))
        force = task.force_at(y)
        expected = integrate(task, scipy.DOP853, 1e-11)
        np.testing.assert_allclose(force, expected, atol=3e-6 * expected.max())
        if task.scene.wall is None:
            assert max(errors(task.read(force), task.read(expected)).values()) < 1e-6


@pytest.mark.parametrize("package", ["CyRK", "numbalsoda"])
def test_a_missing_package_is_left_out(monkeypatch, package):
    monkeypatch.delenv("CI", raising=False)
    its = tuple(peer for peer in PEERS if peer.package == package)
    monkeypatch.setattr(peers, "PEERS", its)
    monkeypatch.setitem(sys.modules, package, None)
    assert missing() == (package,)
    assert list(prepared(struck(1.0, 16, 10, 5.0, 20.0))) == []
    monkeypatch.setenv("CI", "true")
    with pytest.raises(PeerError, match=rf"^{package} is missing where CI is set"):
        missing()


def test_other_exponents_are_refused():
    scene = Scene(
        masses=(1, 1), stiffnesses=(1,), k=2, duration=1, velocities=(1,), contact_sensors=(0,)
    )
    with pytest.raises(SceneError, match=r"^k is 2: "):
        peers._constants(Task(scene, 0.0))
