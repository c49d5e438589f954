"""Input from outside is read exactly, or refused in one line."""

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings, strategies as st

from lwa.base.exact import InputError, factored, read_exact


@given(st.floats(allow_nan=False, allow_infinity=False), st.fractions())
def test_a_float_is_the_decimal_it_prints_as_and_fractions_are_read_exactly(x, y):
    for value in (x, np.float64(x), str(x)):
        assert read_exact(value, "x") == sp.Rational(repr(x))
    for value in (y, f"{y.numerator}/{y.denominator}"):
        assert read_exact(value, "x") == sp.Rational(y.numerator, y.denominator)


def test_other_numbers():
    assert read_exact("1e-3", "x") == sp.Rational(1, 1000)
    assert read_exact(sp.Float("0.1") * sp.Symbol("y"), "x") == sp.Symbol("y") / 10
    assert read_exact(np.int64(3), "x") == 3


@pytest.mark.parametrize(
    "value",
    [
        "nan", "oo", "", "1/0", "3/2/1", "1.2/3", "2*m", "__import__('os')", "I", "pi", "lambda",
        "1_000", "0x10", "١", "m1 m2", "1e99999", float("nan"), float("inf"), 1j,
        None, True, [1], 10**400, 1 + Fraction(1, 10**400), np.array([1.0, 2.0]), sp.oo, sp.I,
        np.ma.masked, np.ma.array([1.0]),
    ],
)  # fmt: skip
def test_other_values_are_refused_in_one_line(value):
    with pytest.raises(InputError) as caught:
        read_exact(value, "mass 1")
    message = str(caught.value)
    assert message.startswith("mass 1 is")
    assert "\n" not in message
    assert len(message) < 200


@settings(max_examples=30)
@given(
    st.text("0189./-+eEnaimx_ ()'\"*²٣é\n\0")
)  # all of Unicode would take seconds to list
def test_text_is_read_or_refused_and_never_evaluated(text):
    try:
        result = read_exact(text, "x")
    except InputError:
        return
    assert result.is_Rational or result.is_Symbol


def test_polynomials_of_long_numbers_are_not_factored(monkeypatch):
    """SymPy took a minute for a mass of 1e300."""
    monkeypatch.setattr(sp, "factor", None)
    x = sp.Symbol("x", positive=True)
    assert factored((10**300 * x**2 - x) / x) == 10**300 * x - 1
