"""LaTeX: long rows are broken where they may be."""

import re

import pytest
import sympy as sp

from lwa import Dimer, homogenize
from lwa.base import latex

a, b, c = sp.symbols("a b c", positive=True)
LONG = sp.Add(*(sp.Symbol(f"x{i}") * (a + b) ** (i + 2) for i in range(12)))


def lines(row):
    text = latex.align([row]).removeprefix("\\begin{align}\n").removesuffix("\n\\end{align}")
    return text.split(" \\notag \\\\\n&\\quad ")


@pytest.mark.parametrize("value", [LONG, LONG / (a - b) ** 2, (a + LONG) * b / c, LONG**2 / a])
def test_long_rows_are_broken_and_nothing_is_lost(value):
    row = latex.row("y", value)
    found = lines(row)
    assert len(found) > 1
    assert " ".join(found).replace("&=", "=", 1) == row
    for line in found:
        assert latex.width(line) <= latex.WIDTH
        assert line.count("{") == line.count("}")
        assert line.count("\\left") == line.count("\\right")


@pytest.mark.parametrize("order", [5, 6])
def test_an_equation_of_high_order_fits_a_page(order):
    theory = homogenize(Dimer("m1", "m2"), order, closure="full")
    text = latex.align(theory.pde.latex_rows())
    rows = [line.removesuffix(" \\\\").removesuffix(" \\notag") for line in text.split("\n")[1:-1]]
    assert max(map(latex.width, rows)) <= 1.2 * latex.WIDTH
    assert not re.search(r"\\left\([^)]*$", rows[0])
