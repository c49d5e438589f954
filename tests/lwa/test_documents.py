"""LaTeX of results: what the text says, in a document that compiles."""

import subprocess

import pytest

from lwa import Cell, Dimer, homogenize
from lwa.base import latex
from lwa.law import named
from tests.lwa.test_values import MADE

HEAD = r"\documentclass{article}\usepackage{amsmath}\begin{document}"


def test_a_theory_has_its_time_its_exponents_and_all_its_fields():
    theory = homogenize(Cell(["m1", "m2", "m3"]), k="5/2")
    *fields, equation, time, G, _, _ = theory.latex_rows()
    leading = (
        r"u_{\tau\tau} = u_{x}^{3/2} u_{xx} + G u_{x}^{-1/2} u_{xx}^{3} + H u_{x}^{1/2}"
    )
    assert equation.startswith(leading)
    assert time.startswith(r"\tau = ")
    assert G.startswith("G = ")
    for i, row in enumerate(fields):
        assert row.startswith(f"w_{{{i + 1}}} = u ")
        for terms in theory.slaved[i].values():
            for jet, coefficient in terms.items():
                if coefficient.could_extract_minus_sign():
                    coefficient = -coefficient
                assert coefficient == 1 or latex.expression(coefficient) in row
                assert terms.latex(jet) in row
    (quadratic,) = theory.slaved[1][3].nonlinear
    assert quadratic.x == ((2, 2),)
    paper = homogenize(Dimer("m1", "m2"), order=9)
    assert r"\lambda = 1" in paper.latex_rows()
    assert paper.latex_rows(3)[5].startswith("b_{4} = ")  # the ansatz of D^{k+3}
    assert paper._repr_latex_().count(r"\cdots") == 2


@pytest.mark.slow
@pytest.mark.optional("pdflatex")
def test_a_document_of_all_results_compiles(folder):
    results = [make() for name, make in MADE.items() if name != "numeric"]
    for cell in (Cell(["a", "b", "c"]), Cell(["a", "b"], ["A", "B"])):
        results.append(homogenize(cell, 5, closure="full"))
    results.append(homogenize(Cell([1, 2, 3]), 5, law=named("hertz2")))
    rows = [result.latex_rows() for result in results]
    body = [latex.align(lines) for lines in rows if lines]
    assert len(body) >= 20
    text = "\n".join([HEAD, *body, r"\end{document}"])
    (folder / "results.tex").write_text(text)
    command = ["pdflatex", "-halt-on-error", "-interaction=batchmode", "results.tex"]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    log = (folder / "results.log").read_text(errors="replace")
    assert "Undefined" not in log
    assert (folder / "results.pdf").stat().st_size > 20_000
