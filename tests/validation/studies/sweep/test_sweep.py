"""Sweeps: any executor, nothing computed twice, nothing finished lost, the theory beside."""

import csv
import gc
import io
import json
import multiprocessing
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from concurrent.futures import ThreadPoolExecutor as Threads
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import InputError
from tests.commands import ended
from tests.validation.studies.sweep.inline import Inline
from validation import cli
from validation.lattice.threads import threads
from validation.pulses.pulse import Measured
from validation.pulses.steady import QUANTITIES, Point
from validation.studies.sweep import executors
from validation.studies.sweep.executors import SweepError, cluster
from validation.studies.sweep.sweep import axis, sweep, theory
from validation.waves.theory import Compacton, theory_at

R = sp.Rational
THREADS = "validation.studies.sweep.sweep.threads"
COMMAND = Path(sys.executable).with_name("lwa-validate")


with_dask = pytest.mark.optional("distributed")


def quick(k, omega, stretch):
    """In place of a chain."""
    value = float(k / omega)
    return Point(k, omega, (8, 16), {name: Measured(value, value + 1e-9) for name in QUANTITIES})


@pytest.fixture
def fake(monkeypatch):
    monkeypatch.setattr(executors, "point", quick)


KS, OMEGAS = ("3/2", 2, "5/2"), (1, "1/2", "1/4")
GRID = [(R(k), R(omega)) for k in KS for omega in ("1/4", "1/2", 1)]


# Executors


@pytest.fixture(scope="module")
def reference():
    return sweep(["3/2", 2], [1, "1/2"], executor=Inline())


def numbers(result):
    return [(p.k, p.omega, p.sites, p.missing, dict(p.numbers)) for p in result.points]


def test_threads_compute_the_same_bits(reference, tmp_path):
    found = sweep([2, 1.5], [0.5, 1], file=tmp_path / "s.jsonl")
    assert numbers(found) == numbers(reference)
    again = sweep(["3/2", 2], [1, "1/2"], file=tmp_path / "s.jsonl", executor=Inline(stop=0))
    assert numbers(again) == numbers(reference)


@with_dask
def test_a_dask_cluster_computes_the_same_bits(reference):
    import distributed

    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
        ) as local,
    ):
        found = sweep(["3/2", 2], [1, "1/2"], executor=cluster(local.scheduler_address))
    assert numbers(found) == numbers(reference)


def test_an_executor_is_left_running_and_a_context_is_left(fake):
    with Threads(1) as executor:
        sweep(KS, OMEGAS, executor=executor)
        assert executor.submit(pow, 2, 3).result() == 8
    log = []

    @contextmanager
    def context():
        log.append("entered")
        yield Inline()
        log.append("left")

    with tempfile.TemporaryDirectory() as folder:
        for _ in range(2):  # the second time there is nothing to do
            sweep(KS, OMEGAS, executor=context(), file=Path(folder, "s.jsonl"))
    assert log == ["entered", "left"]


def test_a_bounded_number_is_underway(fake, monkeypatch):
    class Counting(Threads):
        most = now = 0

        def submit(self, fn, /, *arguments):
            self.now += 1
            self.most = max(self.most, self.now)
            future = super().submit(fn, *arguments)
            future.add_done_callback(lambda *_: time.sleep(0.001))
            return future

    monkeypatch.setattr(executors, "_UNDERWAY", 3)
    journal_add = executors.Journal.add

    def add(journal, point):
        executor.now -= 1
        journal_add(journal, point)

    monkeypatch.setattr(executors.Journal, "add", add)
    with Counting(2) as executor:
        sweep([1.5, 2, 3, 4], [1, 2, 3, 4, 5], executor=executor)
    assert executor.most == 3


def test_what_is_no_executor_is_refused():
    with pytest.raises(InputError, match=r"^executor is 4: a concurrent\.futures\.Executor"):
        sweep([2], [1], executor=4)
    with pytest.raises(InputError, match=r"^workers is 0: one of 1 … 1024 is wanted$"):
        sweep([2], [1], executor=threads(0))


# The file


@pytest.mark.parametrize("stop", range(9))
def test_an_interrupted_sweep_goes_on_where_it_was(fake, tmp_path, stop):
    file = tmp_path / "s.jsonl"
    first, second, third = Inline(stop), Inline(), Inline()
    with pytest.raises(KeyboardInterrupt):
        sweep(KS, OMEGAS, executor=first, file=file)
    # all that was finished, though the interruption came before it was looked at
    assert file.exists() == (stop > 0)
    assert not stop or file.read_text().count("\n") == 1 + stop
    whole = sweep(KS, OMEGAS, executor=second, file=file)
    assert first.calls + second.calls == GRID
    assert numbers(whole) == numbers(sweep(KS, OMEGAS, executor=third, file=file))
    assert third.calls == []
    assert numbers(whole) == numbers(sweep(KS, OMEGAS, executor=Inline()))


def test_a_larger_sweep_computes_only_what_is_new(fake, tmp_path):
    file, executor = tmp_path / "s.jsonl", Inline()
    sweep(["3/2"], [1, "1/2"], executor=executor, file=file)
    whole = sweep(KS, OMEGAS, executor=executor, file=file)
    assert sorted(executor.calls) == GRID
    assert [(p.k, p.omega) for p in whole.points] == GRID


def test_a_torn_line_is_computed_again(fake, tmp_path):
    file, executor = tmp_path / "s.jsonl", Inline()
    sweep(KS, OMEGAS, executor=Inline(), file=file)
    whole = file.read_bytes()
    file.write_bytes(whole[:-30])
    sweep(KS, OMEGAS, executor=executor, file=file)
    assert executor.calls == GRID[-1:]
    assert file.read_bytes() == whole


def test_another_stretch_is_another_sweep(fake, tmp_path):
    file = tmp_path / "s.jsonl"
    sweep(KS, OMEGAS, executor=Inline(), file=file)
    with pytest.raises(InputError, match=r"s\.jsonl is another sweep's, with settings"):
        sweep(KS, OMEGAS, executor=Inline(stop=0), file=file, stretch=5)


def test_a_point_that_fails_is_recorded_and_loses_no_other(monkeypatch, tmp_path):
    def some(k, omega, stretch):
        return Point(k, omega, None, {}, "broke") if omega == 1 else quick(k, omega, stretch)

    monkeypatch.setattr(executors, "point", some)
    file, executor = tmp_path / "s.jsonl", Inline()
    found = sweep(KS, OMEGAS, executor=executor, file=file)
    assert [p.missing for p in found.points] == [None, None, "broke"] * 3
    np.testing.assert_array_equal(np.isnan(found.map("width")), [[False, False, True]] * 3)
    sweep(KS, OMEGAS, executor=executor, file=file)
    assert len(executor.calls) == 9


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (BrokenExecutor("gone"), "the workers are gone before the sweep is done"),
        (TypeError("a bug"), "k = 2, omega = 1/4 is not computed: TypeError: a bug"),
    ],
)
def test_an_executor_that_fails_loses_nothing_finished(monkeypatch, tmp_path, error, message):
    def some(k, omega, stretch):
        if k == 2:
            raise error
        return quick(k, omega, stretch)

    monkeypatch.setattr(executors, "point", some)
    file, executor = tmp_path / "s.jsonl", Inline()
    with pytest.raises(SweepError, match=message):
        sweep(["3/2", 2], ["1/4"], executor=executor, file=file)
    assert file.read_text().count("\n") == 2  # the other point, and the header
    monkeypatch.setattr(executors, "point", quick)
    sweep(["3/2", 2], ["1/4"], executor=executor, file=file)
    assert len(executor.calls) == 3


def test_progress_is_shown_what_is_computed(fake, tmp_path):
    seen = []

    def progress(todo):
        total = len(todo)
        for i, key in enumerate(todo):
            seen.append((i, total))
            yield key

    sweep(["3/2"], OMEGAS, executor=Inline(), file=tmp_path / "s.jsonl")
    sweep(KS, OMEGAS, executor=Inline(), file=tmp_path / "s.jsonl", progress=progress)
    assert seen == [(i, 6) for i in range(6)]


# The theory


def test_the_theory_is_that_of_lwa():
    ks, omegas = (R(3, 2), R(3)), (R(1, 5), R(1), R(7))
    found = theory(ks, omegas)
    for i, k in enumerate(ks):
        for j, omega in enumerate(omegas):
            if (k, omega) == (3, 7):
                continue
            wave = theory_at(k, omega)
            linear = {name: values[i, j] for name, values in found["linear"].items()}
            assert linear == pytest.approx(
                {
                    "width": float(wave.fwhm("force")),
                    "strain_width": float(wave.fwhm("strain")),
                    "speed": Compacton(wave, 1.0).speed,
                },
                rel=1e-14,
            )
    for name, values in found["linear"].items():
        assert np.isnan(values[1, 2]), name  # G + H + I < 0: no wave
        assert values[:, 1] == pytest.approx(found["canonical"][name][:, 1], rel=1e-14)
    # the canonical wave does not ask which mass is called m1
    swapped = theory(ks, [1 / omega for omega in omegas])["canonical"]
    for name, power in (("width", 0), ("strain_width", 0), ("speed", 0.5)):
        scale = np.array([float(omega) for omega in omegas]) ** power
        assert found["canonical"][name] * scale == pytest.approx(swapped[name], rel=1e-14)


# Input


@given(
    st.fractions(0, 9, max_denominator=50),
    st.fractions(0, 9, max_denominator=50),
    st.integers(2, 40),
)
def test_a_range_is_exact_and_equidistant(start, stop, count):
    values = axis(f"{start}:{stop}:{count},7", "k")
    assert (values[0], values[-2], values[-1]) == (R(start), R(stop), 7)
    assert len(values) == count + 1
    step = (R(stop) - R(start)) / (count - 1)
    assert {b - a for a, b in pairwise(values[:-1])} == {step}


BAD_AXES = [
    ("", "k is '': an integer"),
    ("1.5,,2", "k is '': an integer"),
    ("m", "k is 'm': an integer, a decimal or a fraction is wanted"),
    ("nan", "k is 'nan': "),
    ("1/0", "k is 1/0: the denominator"),
    ("2:3", "k is '2:3': a range is start:stop:count"),
    ("2:3:4:5", "k is '2:3:4:5': a range is start:stop:count"),
    ("2:3:x", "k is '2:3:x': a range is start:stop:count"),
    ("2:3:-4", "k is '2:3:-4': a range is start:stop:count"),
    ("2:3:1", "the count of k is 1: one of 2 … 1000 is wanted"),
    ("2:3:1000000000", "k is '2:3:1000000000': a range"),
    ("2:m:4", "k is 'm': an integer"),
    ("__import__('os')", "k is "),
]


@pytest.mark.parametrize(("text", "message"), BAD_AXES)
def test_a_bad_axis_is_told_by_its_name(text, message):
    with pytest.raises(InputError) as refused:
        axis(text, "k")
    assert str(refused.value).startswith(message)


BAD_GRIDS = [
    (([1], [1]), "k is 1: one from 21/20 to 6 is wanted"),
    (([2, 7], [1]), "k is 7: one from"),
    (([2], [0]), "omega is 0: one from 1/100 to 100 is wanted"),
    (([2], [-1]), "omega is -1: one from"),
    (([], [1]), "k has 0 values: 1 … 1000 are wanted"),
    (([2], [1 + R(i, 10**6) for i in range(1001)]), "omega has 1001 values"),
    ((2, [1]), "k is 2: a sequence is wanted"),
    (("2", [1]), "k is '2': a sequence is wanted"),
    (([float("nan")], [1]), "k is nan: "),
    (([sp.sqrt(2)], [1]), "k is sqrt(2): an integer, a decimal or a fraction is wanted"),
    (([True], [1]), "k is True: "),
]


@pytest.mark.parametrize(("grid", "message"), BAD_GRIDS)
def test_a_bad_grid_computes_and_writes_nothing(tmp_path, grid, message):
    executor = Inline()
    with pytest.raises(InputError) as refused:
        sweep(*grid, executor=executor, file=tmp_path / "s.jsonl")
    assert str(refused.value).startswith(message)
    assert executor.calls == list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("stretch", [1, 101, 2.5, "4"])
def test_a_bad_stretch_is_refused(stretch):
    with pytest.raises(InputError, match=r"^stretch is .*: one of 2 … 100 is wanted$"):
        sweep([2], [1], stretch=stretch)


@contextmanager
def nothing_is_left(capfd):
    """No thread and no message, now or when the garbage is collected."""
    before = set(threading.enumerate())
    yield
    gc.collect()
    assert set(threading.enumerate()) <= before
    assert capfd.readouterr() == ("", "")


def refused_cluster(address):
    with pytest.raises(InputError) as refused, cluster(address):
        pass
    said = str(refused.value)
    assert said.startswith(f"cluster is {address!r}: no Dask scheduler with workers answers there ")
    assert said.endswith("within 0.4 s; an address such as tcp://127.0.0.1:8786 is wanted")


@with_dask
@pytest.mark.parametrize(
    "address",
    ["nonsense", "", "tcp://127.0.0.1", "foo://x:1", 5, "tcp://127.0.0.1:9"],  # 9: discard
)
def test_a_cluster_that_cannot_be_is_refused(capfd, monkeypatch, address):
    with nothing_is_left(capfd):
        monkeypatch.setattr(executors, "PATIENCE", 0.4)
        refused_cluster(address)


@with_dask
@pytest.mark.parametrize("answer", [b"", b"HTTP/1.0 400 Bad Request\r\n\r\n" * 9])
def test_what_is_no_scheduler_is_refused(capfd, monkeypatch, answer):
    """One that is silent was waited for without end."""
    monkeypatch.setattr(executors, "PATIENCE", 0.4)
    with socket.create_server(("127.0.0.1", 0)) as server, Threads(1) as threads:

        def serve():
            server.settimeout(10)
            caller, _ = server.accept()
            caller.settimeout(10)
            with caller:
                caller.sendall(answer)
                while not answer and caller.recv(1000):
                    pass

        serving = threads.submit(serve)
        with nothing_is_left(capfd):
            refused_cluster(f"tcp://127.0.0.1:{server.getsockname()[1]}")
        serving.result()


@pytest.mark.slow
@with_dask
def test_a_scheduler_that_is_killed_is_one_line(tmp_path):
    file = tmp_path / "s.jsonl"
    code = """if True:
        from distributed import LocalCluster
        with LocalCluster(n_workers=1, processes=False, protocol="tcp://",
                          dashboard_address=None) as local:
            print(local.scheduler_address, flush=True)
            input()
    """
    with (
        subprocess.Popen(
            [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        ) as local,
        subprocess.Popen(
            [COMMAND, "sweep", "--k", "5/4:3:20", "--cluster", local.stdout.readline().strip(),
             "--file", file],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        ) as running,
    ):  # fmt: skip
        while not file.exists() and running.poll() is None:
            time.sleep(0.1)
        local.kill()
        out, err = running.communicate(timeout=60)
    said = "the workers are gone before the sweep is done: killed, or out of memory?"
    assert (running.returncode, out, err) == (2, "", f"lwa-validate: {said}\n")


@with_dask
def test_a_cluster_without_workers_is_refused(capfd, monkeypatch):
    import distributed

    with distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None) as local:
        monkeypatch.setattr(executors, "PATIENCE", 0.4)
        with nothing_is_left(capfd):
            refused_cluster(local.scheduler_address)


# The command


def run(capsys, *arguments):
    return ended(capsys, cli.main, "sweep", *arguments)


@pytest.fixture
def inline(monkeypatch):
    executor = Inline()
    monkeypatch.setattr(THREADS, lambda jobs, name: executor)
    return executor


def test_the_command(capsys, inline, tmp_path):
    file, picture = tmp_path / "s.jsonl", tmp_path / "s.svg"
    status, out, err = run(
        capsys, "--k", "3/2", "--omega", "0.5:1:2", "--file", str(file), "--plot", str(picture),
        "--format", "json",
    )  # fmt: skip
    assert (status, err) == (0, "")
    half, one = json.loads(out)["points"]
    assert (half["k"], half["omega"], one["omega"]) == ("3/2", "1/2", "1")
    assert abs(one["width_value"] - 1.411928) <= one["width_error_value"] + 5e-7
    assert half["decay_value"] > 1000 * abs(one["decay_value"])
    assert picture.read_text().startswith("<?xml")
    status, out, err = run(
        capsys, "--k", "3/2", "--omega", "1/2,1", "--file", str(file), "--format", "csv"
    )
    assert (status, err) == (0, "")
    widths = [float(row["width_value"]) for row in csv.DictReader(io.StringIO(out))]
    assert widths == [half["width_value"], one["width_value"]]
    status, out, err = run(capsys, "--k", "3/2", "--omega", "1", "--file", str(file))
    assert (status, err) == (0, "")
    assert "\n\nk = 3/2\nω = m2/m1 " in out
    assert len(inline.calls) == 2


BAD = [
    (("--k", "1"), "k is 1: one from 21/20 to 6 is wanted"),
    (("--k", "1:2"), "k is '1:2': a range is start:stop:count"),
    (("--omega", "w"), "omega is 'w': an integer"),
    (("--stretch", "0"), "stretch is 0: one of 2 … 100 is wanted"),
    (("--file", "s.txt"), "file is s.txt: a file ending in .jsonl is wanted"),
    (("--file", "no/s.jsonl"), "file is no/s.jsonl: the folder no does not exist"),
    (("--jobs", "0", "--file", "s.jsonl"), "jobs is 0: one of 1 … 1024 is wanted"),
    (("--jobs", "2", "--cluster", "tcp://a:1"), "jobs is 2: a cluster has workers of its own"),
    pytest.param(
        ("--cluster", "a", "--file", "s.jsonl"),
        "cluster is 'a': no Dask scheduler with workers answers there",
        marks=with_dask,
    ),
    (("--plot", "s.txt"), "plot is s.txt: a file ending in"),
]


@pytest.mark.parametrize(("arguments", "message"), BAD, ids=str)
def test_bad_input_is_one_line_and_leaves_nothing(
    capsys, monkeypatch, tmp_path, arguments, message
):
    monkeypatch.chdir(tmp_path)
    status, out, err = run(capsys, *arguments)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert err.startswith(f"lwa-validate: {message}")
    assert list(tmp_path.iterdir()) == []


def test_without_dask_the_extra_is_named(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    status, out, err = run(capsys, "--cluster", "tcp://127.0.0.1:8786")
    assert (status, out) == (2, "")
    assert err == "lwa-validate: cluster needs Dask: pip install 'lwa[cluster]'\n"


def test_an_interrupted_command_says_where_the_points_are(capsys, fake, monkeypatch, tmp_path):
    file = tmp_path / "s.jsonl"
    monkeypatch.setattr(THREADS, lambda jobs, name: Inline(stop=3))
    status, out, err = run(capsys, "--file", str(file))
    assert (status, out) == (130, "")
    assert f"finished points are in {file}: the same command goes on" in err
    assert err.endswith("lwa-validate: interrupted\n")
    assert "Traceback" not in err
    assert file.read_text().count("\n") == 4


def test_an_executor_that_fails_is_one_line(capsys, fake, monkeypatch):
    monkeypatch.setattr(THREADS, lambda jobs, name: Inline(3, SweepError("gone")))
    assert run(capsys) == (2, "", "lwa-validate: gone\n")


@pytest.mark.slow
@pytest.mark.parametrize("blow", [signal.SIGINT, signal.SIGKILL])
def test_a_process_that_is_stopped_goes_on(tmp_path, blow):
    file = tmp_path / "s.jsonl"
    command = [COMMAND, "sweep", "--k", "3/2", "--omega", "1/2:1:30", "--jobs", "2", "--file", file]
    stopped = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    while not file.exists() or file.read_text().count("\n") < 4:
        assert stopped.poll() is None
        time.sleep(0.02)
    stopped.send_signal(blow)
    out, err = stopped.communicate(timeout=60)
    if blow == signal.SIGINT:
        assert (stopped.returncode, out) == (130, "")
        assert err.endswith("lwa-validate: interrupted\n")
        assert "Traceback" not in err
    before = file.read_bytes()
    before = before[: before.rfind(b"\n") + 1]
    again = subprocess.run(
        [*command, "--format", "json"], capture_output=True, text=True, check=True, timeout=120
    )
    assert len(json.loads(again.stdout)["points"]) == 30
    content = file.read_bytes()
    assert content.startswith(before)
    assert content.count(b"\n") == 31


@pytest.mark.parametrize("place", ["fsync", "add"])
def test_an_interrupt_while_a_point_is_kept_does_not_keep_it_twice(
    fake, monkeypatch, tmp_path, place
):
    """Ctrl-C is heard as soon as the disk has answered, or when the point is in the file."""
    file = tmp_path / "s.jsonl"
    owner = os if place == "fsync" else executors.Journal
    done, calls = getattr(owner, place), []

    def interrupted(*arguments):
        done(*arguments)
        calls.append(arguments)
        if len(calls) == 3:
            raise KeyboardInterrupt

    monkeypatch.setattr(owner, place, interrupted)
    with pytest.raises(KeyboardInterrupt):
        sweep(KS, OMEGAS, executor=Inline(), file=file)
    sweep(KS, OMEGAS, executor=Inline(), file=file)
    lines = file.read_text().splitlines()
    assert len(lines) == len(set(lines)) == 1 + len(GRID)


def test_workers_that_are_gone_when_more_is_submitted_are_told(fake, tmp_path):
    file = tmp_path / "s.jsonl"
    with pytest.raises(SweepError, match="the workers are gone before the sweep is done"):
        sweep(KS, OMEGAS, executor=Inline(3, BrokenExecutor), file=file)
    assert file.read_text().count("\n") == 4


@pytest.mark.slow
def test_a_worker_that_is_killed_is_told(tmp_path):
    def progress(todo):
        os.kill(pid, signal.SIGKILL)
        yield from todo

    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        pid = pool.submit(os.getpid).result()
        with pytest.raises(SweepError, match="the workers are gone before the sweep is done"):
            sweep([2], [1, "1/2"], executor=pool, file=tmp_path / "s.jsonl", progress=progress)
