"""LaTeX of results: what the text says, in a document that compiles."""

import subprocess

import pytest
import sympy as sp

from lwa import Cell, Dimer, homogenize
from lwa.base import latex
from lwa.law import named
from tests.lwa.test_values import MADE

HEAD = r"\documentclass{article}\usepackage{amsmath}\begin{document}"


def test_a_theory_has_its_time_its_exponents_and_all_its_fields():
    theory = homogenize(Cell(["m1", "m2", "m3"]), k="5/2")
    rows = theory.latex_rows()
    names = [row.split(" = ")[0] for row in rows]
    fields = ["w_{1}", "w_{2}", "w_{3}"]
    assert names == [*fields, r"u_{\tau\tau}", r"\tau", "G", "H", "I"]
    equation = (
        r"u_{x}^{3/2} u_{xx} + G u_{x}^{-1/2} u_{xx}^{3} + H u_{x}^{1/2} u_{xx} u_{xxx}"
    )
    assert equation in rows[3]
    for i, row in enumerate(rows[:3]):
        for terms in theory.slaved[i].values():
            for jet, coefficient in terms.items():
                if coefficient.could_extract_minus_sign():
                    coefficient = -coefficient
                assert coefficient == 1 or sp.latex(coefficient) in row
                assert terms.latex(jet) in row
    first = homogenize(Dimer("m1", "m2"), k="3/2").latex_rows()
    assert r"\lambda = 1" in first
    assert homogenize(Dimer("m1", "m2"), order=9)._repr_latex_().count(r"\cdots") == 2


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
