"""LaTeX: long rows are broken where they may be."""

import sympy as sp

from lwa.base import latex

a, b = sp.symbols("a b", positive=True)
LONG = sp.Add(*(sp.Symbol(f"x{i}") * (a + b) ** (i + 2) for i in range(12)))


def lines(row):
    text = (
        latex.align([row])
        .removeprefix("\\begin{align}\n")
        .removesuffix("\n\\end{align}")
    )
    return text.split(" \\notag \\\\\n&\\quad ")


def test_long_rows_are_broken_and_nothing_is_lost():
    row = latex.row("y", LONG)
    found = lines(row)
    assert len(found) > 1
    assert " ".join(found).replace("&=", "=", 1) == row
    for line in found:
        assert latex.width(line) <= latex.WIDTH
        assert line.count("{") == line.count("}")
        assert line.count("\\left") == line.count("\\right")


def test_a_power_with_a_symbol_in_its_exponent_is_printed_without_a_search(monkeypatch):
    """SymPy's `is_constant` took 13 s of a dimer's series, once for each a^{-n/k}."""
    k = sp.Symbol("k", positive=True)
    value = 2 * a ** (-1 / k) * b ** (-2 / k) * (b + 1) ** 2 / 3
    known = sp.latex(value)
    monkeypatch.setattr(sp.Expr, "is_constant", None)
    assert latex.expression(value) == known
    assert latex.total([(value + b, "u")]) == rf"\left({known} + b\right) u"


def test_digits_in_a_sum_have_the_sign_of_the_number():
    long = sum(sp.sqrt(p) / p for p in (101, 103, 107)) - 1
    for value in (long, -long):
        sign = "+" if value > 0 else "-"
        found = latex.total([(sp.S.One, "u"), (value, "v")])
        assert found == f"u {sign} {sp.latex(sp.N(abs(long), 15))} v"


def test_powers_of_numbers_are_numbers_and_factors_of_1_are_left_out():
    half, one = latex.power(sp.S.Half, 3), latex.power(sp.S.One, 3)
    assert latex.total([(a, half), (b, one)]) == r"a \frac{1}{8} + b"
