"""One call from cell to theory, and what it refuses."""

import pytest
import sympy as sp

from lwa import Dimer, InputError, homogenize
from tests.commands import terminal


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (dict(order=0), "order is 0"),
        (dict(order=2.5), "order is 2.5"),
        (dict(order=200), "beyond memory"),
        (dict(order=20, closure="full"), "beyond memory"),
        (dict(k=0), "k is 0"),
        (dict(k="m1"), "names both"),
        (dict(closure="quadratic"), "closure is 'quadratic'"),
        (dict(branch="transverse"), "branch is 'transverse'"),
    ],
)
def test_senseless_arguments_are_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        homogenize(Dimer("m1", "m2"), **arguments)


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
