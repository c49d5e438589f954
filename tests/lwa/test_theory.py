"""One call from cell to theory, and what it refuses."""

import sympy as sp

from lwa import Dimer, homogenize
from tests.commands import terminal


def test_floats_enter_as_their_decimals():
    assert (
        homogenize(Dimer(0.45, 0.123), k=1.5).pde.I
        == homogenize(Dimer("9/20", "123/1000"), k="3/2").pde.I
    )
    assert not homogenize(Dimer(0.1, 0.7), k=1.1).pde.G.has(sp.Float)


def test_high_orders_show_their_progress_on_a_terminal(capsys):
    with terminal() as shown:
        homogenize(Dimer(1, 2), 11, k="3/2")
        assert shown() == ""
        homogenize(Dimer(1, 2), 12, k="3/2")
        assert "orders:" in shown()
    homogenize(Dimer(1, 2), 12, k="3/2")
    assert capsys.readouterr().err == ""
