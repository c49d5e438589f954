"""Speed against error: errors fall, costs are told as defined, and the contract is kept."""

import csv
import io
import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate as scipy

from lwa import InputError
from tests.commands import ended
from validation import cli
from validation.lattice.schemes import SCHEMES
from validation.lattice.simulate import COMPILED, simulate
from validation.report.table import Finding
from validation.scenes.scene import Scene
from validation.studies.accuracy import costs as spent
from validation.studies.accuracy import integrators as module
from validation.studies.accuracy import peers, tasks
from validation.studies.accuracy.costs import Row, cheapest, cost
from validation.studies.accuracy.integrators import accuracy
from validation.studies.accuracy.reference import integrate
from validation.studies.accuracy.tasks import NUMBERS, Task, errors, exact, struck


def precompressed(duration=6.0):
    """A dimer under such load that a weak blow opens no contact: a smooth problem at k = 3/2."""
    n = 12
    return Scene(
        masses=(1.0, 0.4) * (n // 2), stiffnesses=(1.0,) * (n - 1), wall=1.0, precompression=1.0,
        k=1.5, velocities=(0.2,), duration=duration, samples=121, contact_sensors=range(n),
    )  # fmt: skip


@pytest.mark.parametrize("method", COMPILED)
def test_the_order_of_every_scheme_on_a_precompressed_chain(method):
    """The error of the last state against the step: slopes 8 and 6 at fixed steps."""
    scene, order = precompressed(), SCHEMES[method].order
    truth = simulate(scene, method="DOP853", rtol=1e-13, atol=1e-13)
    assert truth.compression.min() > 0.9
    steps, found = [], []
    for count in (50, 40, 30) if method == "RKN86" else (28, 21, 14):
        run = simulate(scene, method=method, step=6.0 / count, rtol=1e-2)
        steps.append(run.step)  # a whole number of them fills the duration
        found.append(np.abs(run.velocities - truth.velocities).max())
    assert found[0] > 1e-12  # above rounding
    assert np.polyfit(np.log(steps), np.log(found), 1)[0] == pytest.approx(order, abs=0.6)


@pytest.mark.parametrize("window", [False, True])
@pytest.mark.parametrize("method", ["DOP853", "RK45", "LSODA", "RKN86", "SRKN14"])
def test_the_error_falls_with_the_tolerance(method, window):
    """By a hundred at least where the tolerance falls by 1e4, and to what it promises."""
    task = exact(20)
    found = []
    for rtol in (1e-5, 1e-9):
        if method in COMPILED:
            run = simulate(task.scene, method=method, rtol=rtol, window=window)
            force = task.force(run)
        else:
            force = integrate(task, getattr(scipy, method), rtol, window=window)
        found.append(max(errors(task.read(force), task.truth).values()))
    assert found[0] < 1e-2
    assert found[1] < 1e-2 * found[0]
    assert found[1] < 1e-6


def row(seconds, peak, method="a", window=False, family="peer", setting=1e-8, **rest):
    off = {"arrival": 1e-9, "peak": peak, "fwhm": 1e-8}
    return Row("dimer", family, method, window, setting, off, seconds, **rest)


def test_a_cost_holds_from_there_on():
    """The lucky run at 1 s does not count, as the one at 2 s is worse; that at 3 s does."""
    rows = [row(1, 1e-7), row(4, 1e-9), row(2, 2e-6), row(3, 9e-7)]
    assert cost(rows, 1e-6) == 3
    assert cost(rows, 1e-8) == 4
    assert cost(rows, 1e-5) == 1
    assert cost(rows, 1e-10) == math.inf
    assert cheapest([*rows, row(1, 1e-7, window=True)], "peer", 1e-6) == ("a, window", 1)
    assert cheapest([*rows, row(5, 1e-7, window=True)], "peer", 1e-6) == ("a", 3)
    assert cheapest(rows, "compiled", 1e-6) == ("none", math.inf)


def test_the_table_of_costs_has_the_finest_first_and_gaps_where_nothing_is_attained():
    rows = [row(1, 3e-5, "a"), row(4, 1e-9, "a"), row(2, 5e-7, "b"), row(0.5, 1e-3, "c")]
    assert module._costs(rows) == [
        ("a", 1, 4, 4, None), ("b", 2, 2, None, None), ("c", None, None, None, None),
    ]  # fmt: skip


def test_goals_compare_equal_errors(monkeypatch):
    monkeypatch.setattr(spent, "square_root", lambda: 0.5)
    ours = dict(method="ours", window=True, family="compiled")
    rows = [
        row(0.001, 2e-6, setting=1e-5, **ours), row(0.004, 5e-7, setting=1e-6, **ours),
        row(0.02, 1e-10, ns=1.5, **ours),
        row(1.0, 2e-6, "SciPy DOP853", family="SciPy"),
        row(3.0, 9e-7, "SciPy DOP853", family="SciPy"),
        row(0.05, 2e-6, "CyRK"), row(0.09, 5e-7, "CyRK"), row(0.2, 1e-8, "slow"),
    ]  # fmt: skip
    goals = {goal.key: goal for goal in spent.goals(rows)}
    values = {
        "dimer_peer_1e-04": 50, "dimer_ms_1e-06": 4, "dimer_peer_1e-06": 22.5,
        "dimer_peer_1e-08": 10, "dimer_ms_1e-10": 20,
        "scipy_ratio": 750, "evaluation_ns": 1.5, "evaluation_over_root": 3,
    }  # fmt: skip
    assert {key: goal.value for key, goal in goals.items()} == pytest.approx(values)
    assert "CyRK, over ours" in goals["dimer_peer_1e-06"].quantity
    failing = {"dimer_ms_1e-06", "dimer_peer_1e-06", "dimer_ms_1e-10"}
    assert {key for key, goal in goals.items() if not goal.ok} == failing
    others = [r for r in rows if r.family != "peer"]
    assert not any("peer" in goal.key for goal in spent.goals(others))
    uniform = list(spent.goals([replace(r, task="uniform") for r in rows]))
    assert [goal.low for goal in uniform] == [1.0] * 3


def test_the_time_of_a_square_root_is_that_of_a_force_at_least():
    """A bead's force takes one, and some additions."""
    assert 0.05 < spent.square_root() < 20


def small():
    return struck(0.2733, 24, 16, 8.0, 24.0)


def walled():
    """As the experiment: behind a wall there is no window."""
    task = small()
    scene = replace(task.scene, wall=1.0)
    return Task(scene, task.listen)


def reduce(monkeypatch, the_peers=()):
    monkeypatch.setattr(peers, "PEERS", the_peers)
    for name, factory in (("dimer", small), ("experiment", walled)):
        monkeypatch.setitem(tasks.TASKS, name, factory)
    tables = dict(
        _SCIPY={("DOP853", False): (1e-6, 1e-8), ("DOP853", True): (1e-8,)},
        _COMPILED={COMPILED[0]: (1e-6, 1e-8)},
    )
    for name, value in tables.items():
        monkeypatch.setattr(module, name, value)
    monkeypatch.setattr(spent, "_ENOUGH", 0.0)


def command(capsys, *arguments):
    return ended(capsys, cli.main, "accuracy", *arguments)


def held(result, names):
    """The contract, and what each number means."""
    assert {row["task"] for row in result["rows"]} == set(names)
    for row in result["rows"]:
        assert row["error"] == max(row[f"{name}_error"] for name in NUMBERS) < 0.1  # at 1e-3
        assert row["seconds"] > 0
        if row["task"] == "experiment":
            assert "window" not in row["method"]
    for reference in result["references"]:
        assert reference["agreement"] < 5e-12
        assert all(reference[name] > 0 for name in NUMBERS)
    assert len(result["references"]) == len(names)


def test_the_command_prints_the_contract(capsys, monkeypatch, tmp_path):
    reduce(monkeypatch)
    picture = tmp_path / "diagram.svg"
    arguments = ("--task", "dimer", "--task", "experiment", "--plot", str(picture))
    status, out, err = command(capsys, *arguments, "--format", "json")
    result = json.loads(out)
    assert (status, err) == (0 if result["ok"] else 1, "")
    held(result, ("dimer", "experiment"))
    methods = [row["method"] for row in result["rows"] if row["task"] == "dimer"]
    assert sorted(methods) == [
        *(name for name in (COMPILED[0], f"{COMPILED[0]}, window") for _ in range(2)),
        "SciPy DOP853", "SciPy DOP853", "SciPy DOP853, window",
    ]  # fmt: skip
    assert [goal["key"] for goal in result["goals"]] == [
        "dimer_ms_1e-06", "dimer_ms_1e-10", "scipy_ratio", "evaluation_ns", "evaluation_over_root",
    ]  # fmt: skip
    assert {cost["task"] for cost in result["costs"]} == {"dimer", "experiment"}
    drawn = picture.read_text()
    assert drawn.startswith("<?xml")


def test_the_text_names_tasks_methods_and_what_is_missing(monkeypatch):
    monkeypatch.delenv("CI", raising=False)
    reduce(monkeypatch, (peers.Peer("absent", "RK4", pytest.fail),))
    report = accuracy(["experiment"])
    assert report.ok
    document = report.document()
    assert document["absent"] == ["absent"]
    assert document["goals"] == []
    printed = report.text()
    assert printed.startswith("Speed against error\n\nexperiment: arrival ")
    assert "\nCPU time (ms) for the peak force to  1e-04  1e-06  1e-08  1e-10\n" in printed
    assert f"\n{COMPILED[0]}  " in printed
    assert f"{COMPILED[0]}, window" not in printed
    assert printed.endswith(
        "Left out, as not installed: absent (pip install 'lwa[peers]' brings them)."
    )


def test_a_missing_peer_ends_the_command_where_ci_is_set(capsys, monkeypatch):
    monkeypatch.setenv("CI", "1")
    reduce(monkeypatch, (peers.Peer("absent", "RK4", pytest.fail),))
    status, out, err = command(capsys, "--task", "experiment")
    assert (status, out) == (2, "")
    (line,) = err.splitlines()
    assert "absent is missing where CI is set" in line


def test_progress_is_shown_before_peers_are_loaded(monkeypatch):
    """6 s passed before the bar was there."""
    shown = []

    def progress(names):
        shown.extend(names)
        yield from names

    def missing():
        assert shown
        return ()

    reduce(monkeypatch)
    monkeypatch.setattr(module, "missing", missing)
    accuracy(["experiment"], progress)
    assert shown == ["experiment"]


def test_a_task_that_does_not_exist_is_named_and_nothing_is_run(capsys, monkeypatch):
    for name in tasks.TASKS:
        monkeypatch.setitem(tasks.TASKS, name, pytest.fail)
    status, out, err = command(capsys, "--task", "dimer", "--task", "tea")
    assert (status, out) == (2, "")
    names = "uniform, dimer, exact, experiment, precompressed, many, theory"
    assert err == f"lwa-validate: task is 'tea': one of {names} is wanted\n"
    with pytest.raises(InputError, match=r"^task is 'tea'"):
        accuracy(["tea"])


def test_a_missed_goal_is_told_once_and_ends_with_1(capsys, monkeypatch):
    """No run of these chains is 1000 times as fast as another; ``--help`` has always said 1."""
    reduce(monkeypatch)
    status, out, err = command(capsys, "--task", "dimer")
    assert (status, err) == (1, "")
    (line,) = [line for line in out.splitlines() if "SciPy's DOP853 on the whole" in line]
    assert line.endswith("≥ 500  FAILS")
    assert re.search(r"\n5 checks: \d of 5 fail\n$", out)


@pytest.mark.parametrize("met", [True, False])
def test_goals_are_findings(monkeypatch, met):
    goals = tuple(Finding(f"g{i}", 1.0, high=2.0 if met or i else 0.5) for i in range(3))
    monkeypatch.setattr(module, "goals", lambda rows: goals)
    report = module._report({"dimer": [row(1, 1e-7)]}, (), (), (), ())
    assert report.ok is met
    assert report.document()["ok"] is met
    assert [goal["ok"] for goal in report.document()["goals"]] == [met, True, True]
    text = report.text()
    assert [text.count(f"g{i}") for i in range(3)] == [1, 1, 1]


def test_csv_and_notebook_tell_what_json_does(monkeypatch):
    reduce(monkeypatch)
    report = accuracy(["dimer"])
    rows = report.document()["rows"]
    for line, row in zip(csv.DictReader(io.StringIO(report.csv())), rows, strict=True):
        assert (line["task"], line["method"], line["family"]) == (
            row["task"], row["method"], row["family"],
        )  # fmt: skip
        for name in set(row) - {"task", "method", "family"}:
            assert (float(line[name]) if line[name] else None) == row[name], name
    page = report._repr_html_()
    assert page.count("<tr>") == 1 + len(report.document()["costs"])
    assert page.count("SciPy&#x27;s DOP853 on the whole") == 1  # the goals are findings
    assert "<svg" in page


def test_a_panel_tells_windows_from_whole_chains():
    rows = [row(2.0, 1e-7), row(1.0, 1e-5), row(0.5, 1e-6, window=True), row(0.1, 1e-6, "b")]
    curves = {curve.label: curve for curve in module._panel("dimer", rows).curves}
    assert {name: curve.style for name, curve in curves.items()} == {
        "a": "C2o:", "a, window": "C2o-", "b": "C2s:",
    }  # fmt: skip
    assert (curves["a"].x.tolist(), curves["a"].y.tolist()) == ([1e-7, 1e-5], [2.0, 1.0])


def test_a_run_without_a_pulse_is_told_and_drawn_nowhere(monkeypatch):
    reduce(monkeypatch)
    task = small()
    monkeypatch.setattr(module, "integrate", lambda task, *rest, **options: 0 * task.times)
    monkeypatch.setattr(module, "_COMPILED", {})
    truth = task.read(task.force(simulate(task.scene)))
    rows = list(module._compared("dimer", task, truth))
    assert {row.error for row in rows} == {math.inf}
    assert module._costs(rows)[0][1:] == (None,) * 4
    assert all(len(curve.x) == 0 for curve in module._panel("dimer", rows).curves)


@pytest.mark.slow
@pytest.mark.filterwarnings("default::DeprecationWarning")
def test_the_command_with_every_method(capsys, monkeypatch):
    """All methods and peers, on short chains."""
    for name, factory in (("dimer", small), ("experiment", walled)):
        monkeypatch.setitem(tasks.TASKS, name, factory)
    names = ("dimer", "experiment")
    chosen = [argument for name in names for argument in ("--task", name)]
    status, out, _ = command(capsys, *chosen, "--format", "json")
    result = json.loads(out)
    assert status == (0 if result["ok"] else 1)  # by the goals
    held(result, names)
    attained = {row["method"].removesuffix(", window") for row in result["rows"]}
    assert attained >= set(COMPILED) | {"SciPy DOP853", "SciPy RK45", "SciPy LSODA"}
    found = {peer.name for peer in peers.PEERS if peer.package not in result["absent"]}
    assert attained >= found
