"""LaTeX: long rows are broken where they may be."""

import sympy as sp

from lwa.base import latex

a, b = sp.symbols("a b", positive=True)
LONG = sp.Add(*(sp.Symbol(f"x{i}") * (a + b) ** (i + 2) for i in range(12)))


def lines(row):
    text = latex.align([row]).removeprefix("\\begin{align}\n").removesuffix("\n\\end{align}")
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
