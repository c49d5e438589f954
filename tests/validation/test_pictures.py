"""Pictures: every format, complete files or none, and the contents of panels."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure

from lwa import InputError
from validation.lattice.simulate import simulate
from validation.pictures import SUFFIXES, Curve, Map, Panel, figure
from validation.report.result import Report
from validation.scenes.chains import struck

SIGNATURES = {".png": b"\x89PNG", ".pdf": b"%PDF", ".svg": b"<?xml"}
X = np.array([1.0, 2.0, 3.0])


@pytest.fixture
def report():
    return Report(
        "one", panels=(Panel("x", "y", (Curve("c", X, X**2),), "xy", "squares"),)
    )


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_every_format(report, tmp_path, suffix):
    file = tmp_path / f"picture{suffix}"
    report.save(file)
    assert file.read_bytes().startswith(SIGNATURES[suffix])
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize(
    ("most", "labels"),
    [
        (8.0, {"1", "1.5", "2", "3", "4", "6", "8"}),
        (200.0, {"1", "2", "5", "10", "50", "200"}),
    ],
)
def test_a_logarithmic_axis_of_few_decades_has_plain_numbers(most, labels):
    x = np.geomspace(1, most, 5)
    picture = figure([Panel("x", "y", (Curve("c", x, 1e6 * x),), "xy")])
    picture.canvas.draw()
    (axes,) = picture.axes
    assert {tick.get_text() for tick in axes.get_xticklabels()} >= labels
    assert not any(tick.get_text() for tick in axes.get_xticklabels(minor=True))
    assert any(
        "10^" in tick.get_text() for tick in axes.get_yticklabels()
    )  # too large for that


def test_a_map_has_a_colour_for_each_place():
    values = np.array([[1.0, 2.0, np.nan], [4.0, 5.0, 60.0]])
    found = Map("c", X, np.array([1.0, 2.0]), values)
    axes, bar = figure((Panel("x", "y", map=found),)).axes
    (mesh,) = axes.collections
    assert mesh.get_array().shape == (2, 3)
    assert mesh.get_array().mask.sum() == 1
    assert bar.get_ylabel() == "c"
    assert (
        axes.patch.get_hatch()
    )  # where nothing is: grey stands in the middle of some colours
    low, high = axes.get_xlim()
    assert low < X[0] < X[-1] < high


def test_a_panel_is_drawn_into_axes_that_are_given(report):
    given = Figure().subplots()
    assert report.plot(ax=given) is given
    assert (given.get_xlabel(), given.get_ylabel()) == ("x", "y")
    assert (given.get_xscale(), given.get_yscale()) == ("log", "log")
    (line,) = given.lines
    np.testing.assert_array_equal(line.get_xydata(), np.column_stack((X, X**2)))
    own = report.plot()
    assert own.get_title() == "squares"
    pyplot.close(own.figure)
    with pytest.raises(InputError, match="this result has no picture"):
        Report("none").plot()


def test_a_run_is_drawn_into_given_axes():
    three = struck((1,), 3, duration=3)
    run = simulate(replace(three, contact_sensors=(1,), bead_sensors=(0, 2)))
    ax = Figure().add_subplot()
    assert run.plot(ax) is ax
    assert [text.get_text() for text in ax.get_legend().get_texts()] == [
        "bead 1", "bead 3", "contact 2",
    ]  # fmt: skip
    for line, force in zip(
        ax.lines, (*run.bead_force, *run.contact_force), strict=True
    ):
        assert np.array_equal(line.get_xdata(), run.time)
        assert np.array_equal(line.get_ydata(), force)
    ax.figure.draw_without_rendering()
    assert ax.get_legend().get_window_extent().y0 >= ax.bbox.y1  # on no curve
    with pytest.raises(InputError, match="no picture"):
        simulate(three).plot()
