"""LaTeX of results: what the text says, in a document that compiles."""

import subprocess

import pytest

from lwa import Cell, Dimer, homogenize
from lwa.base import latex
from lwa.law import named
from tests.lwa.command.answers import said
from tests.lwa.command.test_answers import ANSWERS
from tests.lwa.test_values import MADE


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
    paper = homogenize(Dimer("m1", "m2"), order=9)
    assert r"\lambda = 1" in paper.latex_rows()
    assert paper.latex_rows(3)[5].startswith("b_{4} = ")  # the ansatz of D^{k+3}
    assert paper._repr_latex_().count(r"\cdots") == 2
    optical = homogenize(Dimer("m1", "m2"), branch="optical").pde._repr_latex_()
    assert r"u_{\tau\tau} &= -u^{k} + D^{2} \Bigl(" in optical


@pytest.mark.slow
@pytest.mark.optional("pdflatex")
def test_a_document_of_all_results_and_answers_compiles(capsys, folder):
    results = [make() for name, make in MADE.items() if name != "numeric"]
    for cell in (Cell(["a", "b", "c"]), Cell(["a", "b"], ["A", "B"])):
        results.append(homogenize(cell, 5, closure="full"))
    results.append(homogenize(Cell([1, 2, 3]), 5, law=named("hertz2")))
    body = [latex.align(rows) for rows in (x.latex_rows() for x in results) if rows]
    for line in ANSWERS:
        body.append(said(capsys, *line.split(), "--format", "latex"))
    assert len(body) >= 40
    head = r"\documentclass{article}\usepackage{amsmath}\begin{document}"
    (folder / "results.tex").write_text("\n".join([head, *body, r"\end{document}"]))
    command = ["pdflatex", "-halt-on-error", "-interaction=batchmode", "results.tex"]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    assert "Undefined" not in (folder / "results.log").read_text(errors="replace")
    assert (folder / "results.pdf").stat().st_size > 40_000
