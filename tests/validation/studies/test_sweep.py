"""Sweeps: no point is computed twice or lost; the theory beside, pictures and tables."""

import json
import os
import signal
import socket
import sqlite3
import sys
from concurrent.futures import BrokenExecutor
from contextlib import closing
from itertools import product

import numpy as np
import pytest
import sympy as sp

from lwa import Dimer, Estimate, InputError, canonical_wave, homogenize
from lwa.base import INTERRUPTED
from tests.commands import ended
from validation import cli
from validation.lattice.threads import cluster, threads
from validation.pulses.steady import LABELS, Point, stored
from validation.report import study
from validation.scenes.checks import Failure
from validation.studies.sweep import MEMORY, measured, report, sweep, theory

R = sp.Rational
QUICK = {"jobs": 1}  # one after another
KS, OMEGAS = (R(3),), (R(1, 2), R(3, 4), R(1))


@pytest.fixture(scope="module")
def reference():
    """Three points."""
    return measured(KS, OMEGAS, MEMORY, threads(1), iter)


def numbers(found):
    return found.document()["points"]


def stopped(error):
    """Progress that ends with an error when one point is kept."""

    def progress(todo):
        yield todo[0]
        raise error

    return progress


@pytest.fixture
def file(reference, tmp_path):
    """A sweep's file of a point with numbers and one that has none."""
    path = tmp_path / "s.sqlite"
    with stored(path) as (_, keep):
        for point in (reference[0], Point(R(4), R(1), None, {}, "it “broke”\n")):
            keep(point)
    return path


def test_an_interrupted_sweep_resumes_and_grows(capsys, file, reference):
    """Finished points come back bit for bit; new ones alone are computed, each value once."""
    computed, wanted = [], numbers(report(reference))
    with pytest.raises(KeyboardInterrupt):
        sweep(KS, OMEGAS, file=file, progress=stopped(KeyboardInterrupt), **QUICK)

    def progress(todo):
        computed.extend(todo)
        return todo

    options = {"file": file, "progress": progress} | QUICK
    assert numbers(sweep(KS, OMEGAS, **options)) == wanted
    assert computed == [(3, 1)]
    assert numbers(sweep([4], [1], **options))[0]["missing"] == "it “broke”\n"
    line = f"sweep --k 3 --omega 0.5:1:3,1/2 --file {file} --format json"
    status, out, err = ended(capsys, cli.main, *line.split())
    assert (status, err) == (0, "")
    assert json.loads(out)["points"] == wanted


@pytest.fixture
def quick(monkeypatch):
    """Let points have no numbers."""
    made = "validation.studies.sweep.point"
    monkeypatch.setattr(made, lambda *key: Point(*key, None, {}))


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    ("options", "says"),
    [("", "--file points.sqlite keeps"), ("--file s.sqlite", "goes on from s.sqlite")],
)
def test_ctrl_c_says_how_points_are_kept(capsys, folder, monkeypatch, options, says):
    monkeypatch.setattr(study, "progress", stopped(KeyboardInterrupt))
    line = f"sweep --k 3 --omega 1,3/4 --jobs 1 {options}"
    status, out, err = ended(capsys, cli.main, *line.split())
    assert (status, out) == (INTERRUPTED, "")
    assert err.startswith("\nlwa-validate: interrupted: ")
    assert says in err


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("alter table points_5_4 rename to points_5_3", "other data than points"),
        ("update points_5_4 set point = replace(point, '\"4\"', '\"f(0)\"')", "k is"),
    ],
)
def test_another_database_is_refused_and_left_alone(file, change, words):
    with closing(sqlite3.connect(file, isolation_level=None)) as data:
        data.execute(change)
    refused(file, words)


def refused(file, words):
    before = file.read_bytes()
    with pytest.raises(InputError, match=words):
        sweep([2], [1], file=file, **QUICK)
    assert file.read_bytes() == before


def test_a_file_that_is_open_or_of_another_kind_is_refused(file):
    with stored(file):
        refused(file, r"s\.sqlite: .*locked")
    file.write_bytes(100 * b"a,b,c,d,e\n")
    refused(file, "not a database")


with_dask = pytest.mark.optional("distributed")


@pytest.mark.slow
@with_dask
def test_a_cluster_that_loses_a_worker_loses_no_point(reference):
    """The numbers are those of threads, bit for bit."""
    from distributed import LocalCluster

    with LocalCluster(
        dashboard_address=None, n_workers=2, threads_per_worker=1
    ) as local:
        pids = [worker.pid for worker in local.workers.values()]

        def progress(todo):
            for i, key in enumerate(todo):
                if i == 1:
                    os.kill(pids[0], signal.SIGKILL)
                yield key

        found = sweep(KS, OMEGAS, address=local.scheduler_address, progress=progress)
    assert numbers(found) == numbers(report(reference))


@with_dask
def test_an_address_without_a_scheduler_is_refused():
    """A server that accepts a call and does not answer."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(InputError, match=rf"^cluster is '{address}'"):
            cluster(address, 0.4).__enter__()


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r"^cluster needs .*lwa\[cluster\]"):
        sweep([2], [1], address="tcp://127.0.0.1:8786")


AXES = (R(3, 2), R(2), R(6)), (R(1, 2), R(1), R(50))


@pytest.fixture(scope="module")
def points():
    """Exact functions in place of measurements, and one point without numbers."""
    found = []  # beyond ω = 6 the paper's closure has no wave at k = 6
    for k, omega in product(*AXES):
        values = map(float, (k + omega, k + 2 * omega, 1 / omega, (1 - omega) / 10))
        read = {n: Estimate(v, 1e-9) for n, v in zip(LABELS, values, strict=True)}
        found.append(Point(k, omega, (24, 32), read))
    found[4] = Point(R(2), R(1), None, {}, "broke")
    return found


def test_the_document_is_json_and_complete(points):
    found = json.loads(json.dumps(report(points).document(), allow_nan=False))
    assert found["missing"] == 1
    none, last = found["points"][4::4]
    assert {none[f"{name}_value"] for name in LABELS} == {none["sites"], None}
    assert (none["missing"], last["missing"], last["sites"]) == (
        "broke",
        None,
        [24, 32],
    )
    assert (last["k"], last["omega"]) == ("6", "50")
    assert (last["speed_value"], last["speed_error_value"]) == (0.02, 1e-9)
    assert last["theory"]["linear"]["width_value"] is None
    off = last["theory"]["canonical"]["width_value"] / last["width_value"] - 1
    assert last["error"]["canonical"]["width_value"] == pytest.approx(off)


def test_the_picture_has_a_curve_for_each_exponent(points):
    """A single curve, over either axis, has the theories beside it."""
    panels = report(points).panels
    assert [len(panel.curves) for panel in panels] == [3, 3, 3, 3]
    _, second, _ = panels[0].curves
    np.testing.assert_array_equal(second.y, [2.5, np.nan, 52])
    # A decay below 0 is drawn as its error.
    assert all((curve.y[1:] > 0).all() for curve in panels[3].curves[::2])
    for some in (points[:3], points[::3]):
        panels = report(some).panels
        assert [len(panel.curves) for panel in panels] == [3, 3, 3, 1]
        assert list(panels[0].curves[0].y) == [p.numbers["width"].value for p in some]


def test_the_theory_is_that_of_lwa():
    """G + H + I < 0 at the second point: no wave of the paper's closure."""
    found = theory([Point(R(3), omega, None, {}) for omega in (R(1, 5), R(7))])
    cell = Dimer(1, R(1, 5), spacing=1)
    for closure, wave in (
        ("linear", homogenize(cell, k=3).pde.traveling_wave()),
        ("canonical", canonical_wave(cell, 3)),
    ):
        expected = {
            "width": wave.fwhm("force"),
            "strain_width": wave.fwhm("strain"),
            "speed": wave.at_force(1).speed,
        }
        for name, value in expected.items():
            first, second = found[closure, name]
            assert first == pytest.approx(float(value), rel=1e-14)
            assert np.isnan(second) == (closure == "linear")


@pytest.mark.usefixtures("quick")
def test_lost_workers_are_reported():
    with pytest.raises(Failure, match="workers are gone"):
        sweep([2], [1], progress=stopped(BrokenExecutor("killed")), **QUICK)
