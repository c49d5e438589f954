"""Sweeps as text, JSON, CSV and maps."""

import csv
import io
import json

import numpy as np
import pytest
import sympy as sp

from tests.validation.studies.sweep.inline import Inline
from validation.pulses.pulse import Measured
from validation.pulses.steady import QUANTITIES, Point
from validation.report.text import percent
from validation.studies.sweep import executors
from validation.studies.sweep.sweep import sweep

R = sp.Rational


def quick(k, omega, stretch):
    """In place of a chain: exact functions, one point unsure and one missing."""
    if (k, omega) == (2, 1):
        return Point(k, omega, None, {}, "broke")
    error = 0.1 if (k, omega) == (2, R(1, 2)) else 1e-9
    values = (k + omega, k + 2 * omega, 1 / omega, (1 - omega) / 10)
    numbers = {
        name: Measured(float(value), float(value) + error)
        for name, value in zip(QUANTITIES, values, strict=True)
    }
    return Point(k, omega, (24, 32), numbers)


@pytest.fixture
def result(monkeypatch):
    monkeypatch.setattr(executors, "point", quick)
    # beyond ω = 6 the paper's closure has no wave at k = 6
    return sweep(["3/2", 2, 6], [1, "1/2", 50], executor=Inline())


def one(monkeypatch, ks, omegas):
    monkeypatch.setattr(executors, "point", quick)
    return sweep(ks, omegas, executor=Inline())


def test_the_maps_are_the_points(result):
    expected = [[k + omega for omega in (0.5, 1, 50)] for k in (1.5, 2, 6)]
    expected[1][1] = np.nan
    np.testing.assert_array_equal(result.map("width"), expected)
    assert result.map("width", "error")[1, 0] == pytest.approx(0.1)


def test_the_text_has_a_table_for_each_k_and_the_reasons(result):
    shown = result.report().text()
    title, *blocks = shown.split("\n\n")
    assert title == "The steady pulse of a struck dimer chain"
    assert [block.splitlines()[0] for block in blocks[:3]] == ["k = 3/2", "k = 2", "k = 6"]
    assert [line.split()[0] for line in blocks[0].splitlines()[2:]] == ["1/2", "1", "50"]
    assert blocks[3] == "k = 2, ω = 1: broke"
    missing = blocks[1].splitlines()[3].split()
    assert missing == ["1", *8 * "-"]
    width = float(result.theory["linear"]["width"][0, 1])
    assert percent(width / 2.5 - 1) in blocks[0].splitlines()[3]
    assert "nan" not in shown


def test_the_document_is_json_and_complete(result):
    found = json.loads(json.dumps(result.report().document(), allow_nan=False))
    assert (found["stretch"], found["missing"]) == (4, 1)
    assert [(p["k"], p["omega"]) for p in found["points"][:4]] == [
        ("3/2", "1/2"), ("3/2", "1"), ("3/2", "50"), ("2", "1/2"),
    ]  # fmt: skip
    for p, point in zip(found["points"], result.points, strict=True):
        for name in QUANTITIES:
            number = point.numbers.get(name)
            assert p[f"{name}_value"] == (None if number is None else number.value)
            assert p[f"{name}_error_value"] == (None if number is None else number.error)
        assert (p["missing"] is None) == (p["sites"] == [24, 32])
    last = found["points"][-1]["theory"]
    assert last["linear"] == {"width_value": None, "strain_width_value": None, "speed_value": None}
    assert last["canonical"]["width_value"] == result.theory["canonical"]["width"][2, 2]


def test_the_table_of_numbers_is_that_of_the_document(result):
    report = result.report()
    rows = list(csv.DictReader(io.StringIO(report.csv())))
    for row, p in zip(rows, report.document()["points"], strict=True):
        assert (row["k"], row["omega"], row["missing"]) == (p["k"], p["omega"], p["missing"] or "")
        theory = {
            f"theory.{closure}.{name}": value
            for closure, wave in p["theory"].items()
            for name, value in wave.items()
        }
        values = {name: value for name, value in p.items() if name.endswith("_value")} | theory
        assert len(values) == 14
        for name, value in values.items():
            assert row[name] == ("" if value is None else str(value))


def test_a_notebook_shows_the_tables_and_the_maps(result):
    shown = result.report()._repr_html_()
    assert shown.count("<table>") == 3
    assert "<svg" in shown
    assert "k = 2, ω = 1: broke" in shown


def test_maps(result, tmp_path):
    picture = result.report().figure()
    result.report().save(tmp_path / "maps.png")
    axes = [axes for axes in picture.axes if axes.get_xlabel() == "ω = m2/m1"]
    assert len(axes) == 4
    for plot in axes:
        assert (plot.get_ylabel(), plot.get_xscale(), plot.get_yscale()) == ("k", "log", "linear")
        cells = plot.collections[0].get_array()
        assert cells.shape == (3, 3)
        assert cells.mask[1, 1]
        assert plot.get_title() == "hatched: no value; red ×: width known to less than 1%"
        (unsure,) = plot.lines
        assert (list(unsure.get_xdata()), list(unsure.get_ydata())) == ([0.5], [2.0])
    assert axes[3].collections[0].get_array().mask[2, 2]  # no theory there
    decay = axes[2].collections[0].get_array()
    assert decay[0, 0] == 0.05
    assert 0 < decay[0, 2] < 1e-7  # below the lowest colour, and not hatched: it does not decay
    labels = {plot.get_ylabel() for plot in picture.axes} - {"k"}
    assert labels == {
        "FWHM of the contact force (sites)",
        "speed at contact force 1 (sites/time)",
        "decay of the peak force per site",
        "FWHM of force: paper's closure/lattice - 1 (%)",
    }


@pytest.mark.parametrize(
    ("ks", "omegas", "label", "title"),
    [
        (["3/2"], [1, "1/2", "1/4"], "ω = m2/m1", "k = 3/2"),
        (["3/2", 3], [1], "k", "ω = 1"),
        ([3], [1], "ω = m2/m1", "k = 3"),
        ([2], [1], "ω = m2/m1", "k = 2"),  # the point that is missing
    ],
)
def test_curves_where_one_axis_has_a_single_value(monkeypatch, ks, omegas, label, title):
    result = one(monkeypatch, ks, omegas)
    picture = result.report().figure()
    picture.draw_without_rendering()
    assert [plot.get_ylabel() for plot in picture.axes] == list(QUANTITIES.values())
    for plot in picture.axes:
        assert (plot.get_xlabel(), plot.get_title()) == (label, title)
    theory = [line.get_ydata() for line in picture.axes[0].lines[1:]]
    for found, wave in zip(theory, result.theory.values(), strict=True):
        np.testing.assert_array_equal(found, wave["width"].ravel())


def test_a_map_without_a_single_measured_point_is_drawn(monkeypatch, tmp_path):
    monkeypatch.setattr(executors, "point", lambda k, w, s: Point(k, w, None, {}, "broke"))
    sweep([2, 3], [1, 2], executor=Inline()).report().save(tmp_path / "maps.png")
