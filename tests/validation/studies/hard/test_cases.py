"""The command `hard`: verdicts follow from the numbers, and the whole of it holds."""

import json
import math

import pytest

from lwa import InputError
from validation import cli
from validation.report.result import Curve, Finding, Outcome, Panel, Statement
from validation.report.text import document, text
from validation.studies.hard import cases as module
from validation.studies.hard.cases import CASES, hard


def outcome(*findings):
    panel = Panel("t", "error", (Curve.of("it", [1, 2], [3, 4]),), "y")
    return Outcome("does it hold?", findings, "It does.", panel)


HOLDS = outcome(
    Finding("order", 2.4, 2.0, 3.0, error=0.1, key="order"),
    Finding("loss", 7.0, high=8.0),
    Finding("cost", 1e3, key="cost"),
    Statement("refusal", "there is no wave", True),
)
FAILS = outcome(Finding("drift", 1e-3, 0.0, 1e-4, key="drift"))


@pytest.mark.parametrize(
    ("finding", "ok"),
    [
        (Finding("x", 1.0, 1.0, 1.0), True),
        (Finding("x", 1.0, 1.1), False),
        (Finding("x", 1.0, high=0.9), False),
        (Finding("x", 1.0, 0.9, 1.1, error=0.05), True),
        (Finding("x", 1.0, 0.9, 2.0, error=0.2), False),
        (Finding("x", 1.0, 0.0, 1.1, error=0.2), False),
        (Finding("x", 1.0), True),
        (Finding("x", math.nan), False),
        (Finding("x", math.nan, 0.0, 1.0), False),
        (Finding("x", math.inf, 0.0, 1.0), False),
    ],
)
def test_a_number_is_held_to_its_bounds_with_its_error(finding, ok):
    assert finding.ok is ok
    assert outcome(Finding("y", 0.0), finding).ok is ok


def test_a_statement_that_does_not_hold_fails_its_case():
    assert not outcome(Statement("refusal", "has a wave", False)).ok


def run(capsys, monkeypatch, cases, *arguments):
    monkeypatch.setattr(module, "CASES", cases)
    with pytest.raises(SystemExit) as ended:
        cli.main(("hard", *arguments))
    captured = capsys.readouterr()
    return ended.value.code, captured.out, captured.err


TWO = {"good": lambda: HOLDS, "bad": lambda: FAILS}


def test_the_status_tells_whether_all_cases_hold(capsys, monkeypatch):
    status, out, err = run(capsys, monkeypatch, TWO)
    assert (status, err) == (1, "")
    assert out.endswith("2 cases: 1 fail\n")
    assert "1 not as expected, which was: It does." in out
    (line,) = (line for line in out.splitlines() if line.startswith("drift"))
    assert line.split() == ["drift", "0.001", "0", "…", "0.0001", "FAILS"]
    status, out, _ = run(capsys, monkeypatch, TWO, "--case", "good")
    assert status == 0
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
    assert picture.read_text().startswith("<?xml")


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
    monkeypatch.setattr(module, "CASES", {"long": lambda: outcome(Statement("a", "b " * 99, True))})
    assert max(map(len, text(hard()).splitlines())) <= 100


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
    whole = document(result)
    assert whole["ok"]
    assert [case["case"] for case in whole["cases"]] == list(CASES)
    for case in whole["cases"]:
        assert any(key.endswith("_value") for key in case), case["case"]
        bounded = [
            f for f in case["findings"] if (f["least_value"], f["most_value"]) != (None,) * 2
        ]
        assert bounded, case["case"]
    json.dumps(whole, allow_nan=False)
