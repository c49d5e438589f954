"""Many chains: the same motion by every method, and what threads gain is told as defined."""

import numpy as np
import pytest

from validation.lattice.simulate import simulate
from validation.studies.accuracy import many as module
from validation.studies.accuracy.many import ERROR, Many, chains, many, together
from validation.studies.accuracy.peers import PEERS


def test_chains_differ_in_their_masses_only():
    one, two = chains(2)
    assert one.scene.masses != two.scene.masses
    assert one.scene.stiffnesses == two.scene.stiffnesses
    assert chains(2)[1].scene.masses == two.scene.masses
    spread = np.log(np.array([task.scene.masses for task in chains(60)])).std(axis=0)
    assert spread.mean() == pytest.approx(0.1, rel=0.03)  # 60 chains of 38 beads: 1.5 %


def test_the_engine_is_good_to_the_error_that_is_wanted(monkeypatch):
    monkeypatch.setattr(module, "chains", lambda: chains(3))
    monkeypatch.setattr(module, "prepared", lambda task: ())
    (found,) = many()
    assert 0 < found.error <= ERROR
    assert found.seconds > 0
    assert found.share == found.alone / found.seconds / module.cores()


def numbers(method, seconds, error=1e-7):
    return Many(method, 1e-6, error, seconds, 1.9 * seconds)


def test_findings_compare_good_peers_only():
    engine, *others = (
        numbers("ours", 1.0), numbers("a", 1.2), numbers("b", 0.5, 1e-5)
    )  # fmt: skip
    share, peer = together([engine, *others])
    assert share.value == pytest.approx(1.9 / module.cores())
    assert peer.value == pytest.approx(1.2)
    assert "a, over ours" in peer.quantity
    assert [f.key for f in together([engine, others[1]])] == ["many_share"]
    assert list(together([])) == []


@pytest.mark.slow
@pytest.mark.parametrize("peer", PEERS, ids=lambda p: p.name)
def test_a_peer_runs_other_chains_than_it_was_prepared_for(peer):
    """To 1e-5 of the peak, at a tolerance of 1e-9."""
    pytest.importorskip(peer.package)
    first, other = chains(2)
    (force,) = module._threaded(peer.prepare(first, peer.method), [other])(1e-9, 1)
    expected = other.force(simulate(other.scene, rtol=1e-9))
    np.testing.assert_allclose(force, expected, atol=1e-5 * expected.max())
