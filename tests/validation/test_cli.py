"""The command `lwa-validate`: exit status, standard error, JSON, pictures, help, progress."""

import json
import os
import re
import shlex
import tomllib
from pathlib import Path

import numpy as np
import pytest

from lwa.base import progress
from lwa.command import cli as theory
from tests.commands import ended, small_disk, terminal
from validation import cli
from validation.pulses.steady import Point
from validation.report import study
from validation.report.study import Report
from validation.report.table import Column, Finding, Table
from validation.studies import sweep
from validation.studies.run import EXAMPLES

ROOT = Path(__file__).parents[2]


def widest(text):
    return max(map(len, text.splitlines()))


def run(capsys, *arguments):
    return ended(capsys, cli.main, *arguments)


def shown(capsys, found, *arguments):
    """Status and outputs of a study with this result."""

    def made():
        return found

    return ended(capsys, study.study()(made).main, *arguments)


@pytest.mark.parametrize("most", [1.0, 0.1])
def test_a_study_prints_its_result(capsys, most):
    """A result that fails is printed too, and ends with 1; text has findings that fail alone."""
    rows = (Table((Column("n", "sites"),), [{"n": 8}], "rows"),)
    findings = (Finding("drift", 0.5, 0.0, 1.0), Finding("loss", 0.5, high=most))
    found = Report("one", rows, findings)
    ok = most > 0.5
    status, text, _ = shown(capsys, found)
    assert (status, text.count("FAILS"), "drift" in text) == (not ok, not ok, False)
    assert text.endswith(f"2 checks: {'all hold' if ok else '1 of 2 fail'}\n")
    assert shown(capsys, found, "--format", "csv") == (not ok, "n\n8\n", "")
    document = json.loads(shown(capsys, found, "--format", "json")[1])
    assert document["ok"] is ok
    assert document["rows"] == [{"n": 8}]
    assert [row["ok"] for row in document["findings"]] == [True, ok]


def test_text_is_as_wide_as_the_terminal_and_a_pipe_gets_100(monkeypatch):
    class Screen:
        def isatty(self):
            return True

    columns = tuple(Column("", f"a long label {i}") for i in range(9))
    row = {column.label: i for i, column in enumerate(columns)}
    wide = Report("wide", (Table(columns, [row]),), notes=("word " * 60,))
    texts = {100: study.printed_as("text", wide)}
    monkeypatch.setattr("sys.stdout", Screen())
    for width in (80, 60):
        monkeypatch.setenv("COLUMNS", str(width))
        texts[width] = study.printed_as("text", wide)
    for width, text in texts.items():
        assert width - 15 < widest(text) <= width
        assert all(column.label in text for column in columns)


SCENE = """
duration = 30
samples = 601
chain = {cell = [1, 0.5], repeat = 10, k = 1.5, spacings = 2}
striker = {velocity = 1}
sensors = {beads = [9], contacts = [4, 12]}
"""


def test_force_is_total_in_every_output_and_in_si_outside_of_texts(capsys, folder):
    """Pulses alone are measured on the dynamic force, and say so; one is cut by the end."""
    load = 0.25
    loaded = f'units = "SI"\nprecompression = {load}\n{SCENE}wall = {{stiffness = 1}}'
    # before the echo
    scene = loaded.replace("= 30", "= 12").replace("12]", "12, 19]")
    (folder / "scene.toml").write_text(scene)
    _, text, _ = run(capsys, "run", "scene.toml", "--out", "o.csv")
    assert "peak dynamic force (mN)" in text
    options = ("--out", "o.json", "--plot", "o.svg", "--format", "json")
    status, out, _ = run(capsys, "run", "scene.toml", *options)
    assert status == 0
    columns = np.genfromtxt("o.csv", delimiter=",", names=True, deletechars="")
    names = "time_(s) bead_9_force_(N) bead_9_displacement_(m) bead_9_velocity_(m/s)"
    assert " ".join(columns.dtype.names[:4]) == names
    stored = json.loads(Path("o.json").read_text())
    records = stored["records"]["contact_force_value"]
    for i, force in zip((4, 12, 19), records, strict=True):
        np.testing.assert_array_equal(columns[f"contact_{i}_force_(N)"], force)
        assert force[0] == pytest.approx(load, rel=1e-12)
    assert "force (mN)" in Path("o.svg").read_text()
    *sensors, cut = json.loads(out)["sensors"]
    for sensor in sensors:
        force = columns[f"{sensor['kind']}_{sensor['number']}_force_(N)"]
        assert sensor["static_force_value"] == load
        assert force.max() - load == pytest.approx(sensor["peak_value"], rel=1e-3)
    assert (stored["sensors"], cut["peak_value"]) == ([*sensors, cut], None)
    assert cut["missing"].startswith("the pulse is not wholly")
    assert f"contact 19: {cut['missing']}" in text
    assert "contact 12 → 19: one of the two has no pulse" in text


def test_the_scenes_own_file_is_not_overwritten(capsys, folder):
    """By any spelling of its name, and by links."""
    file, text = Path("same.json"), json.dumps(tomllib.loads(SCENE))
    file.write_text(text)
    Path("hard.json").hardlink_to(file)
    for out in (f"{folder}/same.json", "hard.json"):
        status, printed, err = run(capsys, "run", "--out", out, "same.json")
        assert (status, printed) == (2, "")
        assert err.startswith(f"lwa-validate: out is {out}: it is the scene's own file")
    assert file.read_text() == text


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_of_a_scene_runs_and_names_its_units(capsys, folder, name):
    status, text, err = run(capsys, "run", "--example", name)
    # ASCII whatever a shell writes it in
    assert (status, err, text.isascii()) == (0, "", True)
    assert widest(text) < 80
    Path("scene.toml").write_text(text)
    line = "run scene.toml --rtol 1e-7 --out record.csv"
    status, out, err = run(capsys, *line.split())
    assert (status, err) == (0, "")
    # The scene names no number of samples: enough for its pulses, more than are the default.
    assert Path("record.csv").read_text().count("\n") > 1500
    columns = r"sensor +arrival \([mµ]s\) +peak (dynamic )?force \(N\) +FWHM \(µs\)"
    assert re.search(columns, out)
    assert re.search(r"between +sites/s +m/s", out)
    sensors, _, _ = out.partition("between")
    assert " - " not in sensors  # each sensor has its pulse


@pytest.mark.parametrize("name", ["out.json", "out.csv"])
def test_a_result_that_cannot_be_written_leaves_the_old_one(capsys, folder, name):
    (folder / "scene.toml").write_text(SCENE)
    (folder / name).write_text("old")
    with small_disk(1000):
        status, out, err = run(capsys, "run", "scene.toml", "--out", name)
    assert (status, out) == (2, "")
    assert err.startswith(f"lwa-validate: {name} is not written: File too large")
    assert (folder / name).read_text() == "old"
    assert {file.name for file in folder.iterdir()} == {"scene.toml", name}


NO_FILE = "it cannot be written, No such file or directory; try: lwa-validate"
BAD = [
    ("pulses forces.csv --distance 4.76e-3", "forces.csv: No such file or"),
    ("run s.toml --out o.csv", "out is o.csv, but the scene names no s"),
    ("paper --velocity __import__('os')", "velocity is "),
    ("paper --velocity 0", "velocity is 0: "),
    (
        "paper --format jsn",
        "format is 'jsn': did you mean json?; try: lwa-validate paper",
    ),
    ("exact --plot x/y.pdf", f"plot is x/y.pdf: {NO_FILE} exact --plot y.pdf"),
    ("exact --plot .", "plot is .: a file ending in .pdf, .png, .svg is wanted"),
    ("materials --plot m.svg", "plot is asked for: this result has no picture; try: "),
    ("exact --masses 1,0.2733", "no solitary wave"),
    ("exact --masses 1,x", "masses is x: a number is wanted"),
    ("resonances --k 1", "k is 1: special mass ratios are found for k from 1.1"),
    ("resonances --k 1.14 --count 3", "count is 3: at k = 1.14 the 2 largest"),
    (
        "resonances --count x",
        "count is x: an integer from 1 on is wanted; try: lwa-validate res",
    ),
    ("sweep --k 1", "k is 1:"),
    ("sweep --k 1:2", "k is '1:2':"),
    ("sweep --k 1:2:1001", "k is '1:2:1001': the count of a range is an integer"),
    ("sweep --k 1.1:1.9:600,2:3:600", "k is '1.1:1.9:600,2:3:600': it has 1200 values"),
    (
        "sweep --k 3 --omega 1 --file x/y.sqlite",
        f"file is x/y.sqlite: {NO_FILE} sweep --k 3 --omega 1 --file y.sqlite",
    ),
    (
        "sweep --file s.toml --k 3 --omega 1",
        "file is s.toml: a file ending in .sqlite is wanted",
    ),
    # without Dask the refusal says how to install it
    ("sweep --cluster a", "cluster "),
    (
        "sweep --k 3 --omega 1 --jobs 2000 --file s.sqlite",
        "jobs is 2000: an integer from 1 to 1024 is wanted; try: lwa-validate sweep --k",
    ),
    ("sweep --jobs 2 --cluster a", "jobs is 2:"),
]


@pytest.mark.parametrize(("line", "message"), BAD)
def test_bad_input_prints_one_line_to_paste_with_status_2_and_leaves_no_file(
    capsys, folder, monkeypatch, line, message
):
    """The line to paste gives a result, or is refused for another reason."""
    monkeypatch.setattr(sweep, "point", lambda *key: Point(*key, None, {}))
    Path("s.toml").write_text(SCENE.replace("sensors", "#"))
    status, out, err = run(capsys, *line.split())
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert err.startswith(f"lwa-validate: {message}")
    assert len(err) <= 301
    assert [file.name for file in folder.iterdir()] == ["s.toml"]
    refusal, _, proposed = err.partition("; try: lwa-validate ")
    _, _, again = run(capsys, *shlex.split(proposed))
    assert not again.startswith(refusal)


def test_a_fault_in_a_file_ends_in_the_users_own_line(capsys, folder):
    """Or, if the file is a scene, in the list of its keys."""
    Path("r.csv").write_text("time,force\n1,2\n2,3\n")
    Path("s.toml").write_text(SCENE.replace("30", "1e12"))
    for line, proposed in (
        ("pulses r.csv --of bead",) * 2,
        ("law r.csv --spheres s.toml",) * 2,
        ("pulses r.csv none.csv", "pulses forces.csv --distance 4.76e-3"),
        ("run s.toml", "run --keys"),
    ):
        status, _, err = run(capsys, *line.split())
        assert status == 2
        assert err.endswith(f"; try: lwa-validate {proposed}\n")


def test_without_arguments_the_commands_are_listed(capsys):
    status, out, err = run(capsys)
    assert (status, out, "Commands:" in err) == (2, "", True)


LONG_ONES = ("figures", "sweep")  # a few seconds each
PROGRAMS = {
    "lwa": (theory.main, theory.COMMANDS),
    "lwa-validate": (cli.main, sorted(cli.STUDIES)),
}
HELPS = [
    pytest.param(program, name, marks=[pytest.mark.slow] * (name in LONG_ONES))
    for program, (_, names) in PROGRAMS.items()
    for name in ["", *names]
]


@pytest.mark.parametrize(("program", "name"), HELPS)
def test_the_examples_of_a_help_run_and_its_page_is_in_the_book(
    capsys, folder, program, name
):
    """One after another in an empty folder."""
    _, text, _ = ended(capsys, PROGRAMS[program][0], *name.split(), "--help")
    assert widest(text) <= 80
    _, _, end = text.partition("Examples:\n")
    examples = re.findall(r"^ +(lwa\S*) (.*)$", end, re.MULTILINE)
    assert len(examples) >= 1
    for of, line in examples:
        arguments, _, file = line.partition(" > ")
        status, out, err = ended(capsys, PROGRAMS[of][0], *shlex.split(arguments))
        assert (status, err) == (0, ""), line
        if file:
            Path(file).write_text(out)
    (page,) = re.findall(r"In the book: (\w+)\.html", text)
    assert (ROOT / "book" / f"{page}.md").exists()


def test_a_command_draws_without_a_display_and_takes_no_threads_of_numba(
    capsys, folder, monkeypatch
):
    monkeypatch.setenv("MPLBACKEND", "module://of.a.notebook")
    monkeypatch.setenv("NUMBA_NUM_THREADS", "0")
    assert run(capsys, "exact", "--plot", "wave.png")[0] == 0
    assert (os.environ["MPLBACKEND"], os.environ["NUMBA_NUM_THREADS"]) == ("agg", "1")


def test_without_a_terminal_only_long_runs_show_their_progress(capsys, monkeypatch):
    with study.run_progress() as tell:
        tell(0.75)
    assert list(study.progress(range(3))) == [0, 1, 2]
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(progress, "EVERY", 0.0)
    with study.run_progress() as tell:
        tell(0.25)
    assert "lattice run: 25.0 %" in capsys.readouterr().err


def test_the_progress_bar_appears_before_the_first_case_ends():
    """The bar stands on a terminal before the second case begins."""
    with terminal() as written:
        each = iter(study.progress([1, 2, 3]))
        assert next(each) == 1
        bar = written()
    assert "cases:   0%|" in bar
    assert " 0/3 " in bar
