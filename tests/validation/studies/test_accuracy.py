"""Speed against error: errors fall, costs are as defined, and the contract is kept."""

import json
import math
from itertools import product

import numpy as np
import pytest

from lwa import InputError
from tests.commands import ended
from validation import cli
from validation.lattice.simulate import COMPILED, simulate
from validation.studies.accuracy import (
    FINEST,
    METHODS,
    READINGS,
    TASKS,
    accuracy,
    cost,
    relative_errors,
    solitary_wave,
    struck_chain,
    timings,
)

# The tasks


def test_a_record_without_a_pulse_is_infinitely_wrong():
    task = struck_chain(1.0, 30, 20, 5.0)  # too short a time
    ((rtol, errors, seconds),) = timings(task, solitary_wave(20).truth, COMPILED[0], (1e-6,))
    assert errors == dict.fromkeys(READINGS, math.inf)
    assert (rtol, seconds > 0) == (1e-6, True)


@pytest.mark.parametrize("name", TASKS)
def test_every_task_has_its_pulse_at_its_contact(name):
    task = TASKS[name]()
    assert task.read(simulate(task.scene, rtol=1e-6)).fall < task.scene.duration


@pytest.mark.parametrize("method", METHODS)
def test_the_error_falls_with_the_tolerance(method):
    """The error falls a hundredfold at least where the tolerance falls by 1e4, to below 1e-6."""
    task = solitary_wave(20)
    found = [max(e.values()) for _, e, _ in timings(task, task.truth, method, (1e-5, 1e-9))]
    assert found[0] < 1e-2
    assert found[1] < min(1e-2 * found[0], 1e-6)


@pytest.mark.parametrize("name", TASKS)
@pytest.mark.slow
def test_rtol_is_the_error_of_the_peak_force(name):
    """The error is at most 1.5 rtol, in the median 0.005 rtol at least where contacts open: errors
    vary tenfold from one tolerance to the next, as steps meet the kinks elsewhere. On closed
    contacts the higher order is better than the lower one's estimate."""
    task = TASKS[name]()
    exact = task.read(simulate(task.scene, rtol=FINEST))
    shares = [
        relative_errors(task.read(simulate(task.scene, rtol=rtol)), exact)["peak"] / rtol
        for rtol in 10.0 ** np.arange(-11, -3, 0.4)
    ]
    assert max(shares) < 1.5
    assert (0 if name == "precompressed" else 1 / 200) < np.median(shares) < 1


# Costs


def test_a_cost_counts_only_if_all_longer_runs_are_as_accurate():
    """The lucky run at 1 s does not count, as the one at 2 s is worse; that at 3 s does."""
    runs = [(1e-7, 1), (1e-9, 4), (2e-6, 2), (9e-7, 3)]
    assert cost(runs, 1e-6) == 3
    assert cost(runs, 1e-8) == 4
    assert cost(runs, 1e-5) == 1
    assert cost(runs, 1e-10) == math.inf


# The command


def test_the_document_holds_the_contract():
    tasks, names = ["exact", "experiment"], [COMPILED[0], "SciPy DOP853"]
    report = accuracy(tasks, dict.fromkeys(names, (1e-6, 1e-8)))
    result = json.loads(json.dumps(report.document(), allow_nan=False))
    assert max(map(len, report.text().splitlines())) <= 100
    for row in result["rows"]:
        assert row["error"] == max(row[f"{name}_error"] for name in READINGS) < 0.1
        assert row["seconds"] > 0
    methods = {(row["task"], row["method"]) for row in result["rows"]}
    assert methods == set(product(tasks, names))
    assert {cost["task"] for cost in result["costs"]} == set(tasks)
    exact, experiment = result["references"]
    assert (exact["task"], exact["peak"], experiment["task"]) == ("exact", 1.0, "experiment")


def test_a_task_that_does_not_exist_is_named():
    with pytest.raises(InputError, match=r"^task is 'tea'"):
        accuracy(["dimer", "tea"])


@pytest.mark.slow
def test_the_command_with_every_method(capsys):
    options = "--task", "exact", "--task", "theory", "--format", "json"
    status, out, _ = ended(capsys, cli.main, "accuracy", *options)
    result = json.loads(out)
    assert status == 0
    assert {row["method"] for row in result["rows"]} == set(METHODS)
    assert result["theories"]
