"""The command `hard`: verdicts follow from the numbers, and the whole of it holds."""

import csv
import json

import pytest

from lwa import InputError
from tests.commands import ended
from validation import cli
from validation.report.panel import Curve, Panel
from validation.report.result import Report
from validation.report.table import Finding, Statement
from validation.studies.hard import cases as module
from validation.studies.hard.case import case
from validation.studies.hard.cases import CASES, hard


def outcome(*findings):
    @case("It does.", Panel("t", "error", scale="y"))
    def told():
        """does it hold?"""
        yield from findings
        yield Curve.of("it", [1, 2], [3, 4])

    return told()


HOLDS = outcome(
    Finding("order", 2.4, 2.0, 3.0, error=0.1, key="order"),
    Finding("loss", 7.0, high=8.0),
    Finding("cost", 1e3, key="cost"),
    Statement("refusal", "there is no wave", True),
)
FAILS = outcome(Finding("drift", 1e-3, 0.0, 1e-4, key="drift"))


def test_a_number_or_a_statement_that_does_not_hold_fails_its_case():
    assert not outcome(Finding("x", 1.0, 1.1), Finding("y", 0.0)).ok
    assert not outcome(Statement("refusal", "has a wave", False)).ok


def run(capsys, monkeypatch, cases, *arguments):
    monkeypatch.setattr(module, "CASES", cases)
    return ended(capsys, cli.main, "hard", *arguments)


TWO = {"good": lambda: HOLDS, "bad": lambda: FAILS}


def test_the_status_tells_whether_all_cases_hold(capsys, monkeypatch):
    status, out, err = run(capsys, monkeypatch, TWO)
    assert (status, err) == (1, "")
    assert out.startswith("2 cases: 1 fail\n\ngood\ndoes it hold?\n")
    assert out.endswith("5 checks: 1 of 5 fail\n")
    assert "1 not as expected, which was: It does." in out
    (line,) = (line for line in out.splitlines() if line.startswith("drift"))
    assert line.split() == ["drift", "0.001", "0", "…", "0.0001", "FAILS"]
    status, out, _ = run(capsys, monkeypatch, TWO, "--case", "good")
    assert status == 0
    assert out.startswith("1 case: all hold\n")
    (line,) = (line for line in out.splitlines() if line.startswith("order"))
    assert line.split() == ["order", "2.4", "±", "1e-01", "2", "…", "3", "ok"]
    assert "refusal: there is no wave\n" in out


def test_the_document_holds_the_contract(capsys, monkeypatch, tmp_path):
    picture = tmp_path / "hard.svg"
    status, out, _ = run(capsys, monkeypatch, TWO, "--format", "json", "--plot", str(picture))
    assert status == 1
    good, bad = json.loads(out)["cases"]
    assert (good["case"], good["outcome"], good["ok"]) == ("good", "It does.", True)
    assert (good["order_value"], good["cost_value"]) == (2.4, 1e3)
    assert (bad["case"], bad["ok"], bad["drift_value"]) == ("bad", False, 1e-3)
    loss = good["findings"][1]
    assert (loss["measured_value"], loss["least_value"], loss["most_value"]) == (7.0, None, 8.0)
    assert good["question"] == "does it hold?"
    assert bad["outcome"] == "1 not as expected, which was: It does."
    (statement,) = good["statements"]
    assert statement == {"quantity": "refusal", "says": "there is no wave", "ok": True}
    curve = {"label": "it", "x_value": [1.0, 2.0], "y_value": [3.0, 4.0]}
    assert good["panel"] == {"x": "t", "y": "error", "scale": "y", "curves": [curve]}
    drawn = picture.read_text()
    assert drawn.startswith("<?xml")
    assert "<!-- good -->" in drawn
    assert "<!-- bad -->" in drawn


def test_the_csv_has_the_numbers_of_the_document(capsys, monkeypatch):
    _, out, _ = run(capsys, monkeypatch, TWO, "--format", "json")
    whole = [(case["case"], finding) for case in json.loads(out)["cases"]
             for finding in case["findings"]]  # fmt: skip
    status, out, _ = run(capsys, monkeypatch, TWO, "--format", "csv")
    assert status == 1
    rows = list(csv.DictReader(out.splitlines()))
    for row, (name, finding) in zip(rows, whole, strict=True):
        found = {key: value if key == "quantity" else value == "True" if key == "ok"
                 else float(value) if value else None for key, value in row.items()
                 if key != "case"}  # fmt: skip
        assert (row["case"], found) == (name, finding)


def test_a_notebook_shows_questions_answers_and_picture(monkeypatch):
    monkeypatch.setattr(module, "CASES", TWO)
    html = hard().report()._repr_html_()
    assert "<svg" in html
    for part in ("good\ndoes it hold?", "1 not as expected, which was: It does.", "5 checks"):
        assert part in html


def test_a_case_that_does_not_exist_is_named_and_nothing_is_run(capsys, monkeypatch):
    status, out, err = run(capsys, monkeypatch, {"good": pytest.fail}, "--case", "tea")
    assert (status, out) == (2, "")
    assert err == "lwa-validate: case is 'tea': one of good is wanted\n"
    with pytest.raises(InputError, match=r"^case is 'tea'"):
        hard(["tea"])


def test_cases_run_once_and_in_their_order(monkeypatch):
    ran = []
    cases = {name: lambda name=name: ran.append(name) or HOLDS for name in "abc"}
    monkeypatch.setattr(module, "CASES", cases)
    assert list(hard(["c", "a", "c"]).outcomes) == ran == ["a", "c"]
    ran.clear()
    assert list(hard().outcomes) == ran == ["a", "b", "c"]


def test_the_text_fits_a_terminal_of_a_book(monkeypatch):
    words = "b " * 99
    long = Report(words, (), (Statement("a", words, True),), outcome().panels, (words,))
    monkeypatch.setattr(module, "CASES", {"long": lambda: long})
    assert max(map(len, hard().report().text().splitlines())) <= 100


@pytest.mark.slow
def test_all_cases_hold_and_are_told_by_number():
    result = hard()
    failed = [
        (name, finding)
        for name, found in result.outcomes.items()
        for finding in found.findings
        if not finding.ok
    ]
    assert failed == []
    whole = result.report().document()
    assert whole["ok"]
    assert [told["case"] for told in whole["cases"]] == list(CASES)
    for told in whole["cases"]:
        assert any(key.endswith("_value") for key in told), told["case"]
        bounded = [
            f for f in told["findings"] if (f["least_value"], f["most_value"]) != (None,) * 2
        ]
        assert bounded, told["case"]
    json.dumps(whole, allow_nan=False)
