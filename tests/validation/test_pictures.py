"""Pictures: the contents of panels."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure

from lwa import InputError
from validation.lattice.simulate import simulate
from validation.pictures import Curve, Map, Panel, figure
from validation.scenes.chains import struck

X = np.array([1.0, 2.0, 3.0])


def ticks(axis):
    return {tick.get_text() for tick in axis.get_ticklabels()}


@pytest.mark.parametrize(
    ("most", "labels"),
    [
        (8.0, {"1", "1.5", "2", "3", "4", "6", "8"}),
        (200.0, {"1", "2", "5", "10", "50", "200"}),
    ],
)
def test_a_logarithmic_axis_of_few_decades_has_plain_numbers(most, labels):
    x = np.geomspace(1, most, 5)
    (axes,) = figure([Panel("x", "y", (Curve("c", x, 1e6 * x),), "xy", "line")]).axes
    assert axes.get_title() == "line"
    axes.figure.draw_without_rendering()
    assert ticks(axes.xaxis) >= labels
    assert not any(tick.get_text() for tick in axes.get_xticklabels(minor=True))
    assert any("10^" in tick for tick in ticks(axes.yaxis))  # too large for that


def test_axes_in_si_have_prefixes_and_their_data_have_none():
    """A time far from 0 keeps Matplotlib's offset, whose digits a prefix would not have."""
    y = 1200 * X
    curves = {x[0]: (Curve("c", x, y),) for x in (1e-5 * X, 58 + 1e-5 * X)}
    panels = [Panel("time (s)", "force (N)", curve) for curve in curves.values()]
    near, far = figure(panels).axes
    near.figure.draw_without_rendering()
    assert (near.get_xlabel(), near.get_ylabel()) == ("time (µs)", "force (kN)")
    assert {"10", "20", "30"} <= ticks(near.xaxis)
    assert {"2", "3"} <= ticks(near.yaxis)
    np.testing.assert_array_equal(near.lines[0].get_ydata(), y)
    assert far.get_xlabel() == "time (s)"


def test_a_map_has_a_colour_for_each_place():
    values = np.array([[1.0, 2.0, np.nan], [4.0, 5.0, 60.0]])
    found = Map("c", X, np.array([1.0, 2.0]), values)
    axes, bar = figure((Panel("x", "y", map=found),)).axes
    (mesh,) = axes.collections
    assert mesh.get_array().shape == (2, 3)
    assert mesh.get_array().mask.sum() == 1
    assert bar.get_ylabel() == "c"
    # where nothing is: grey stands in the middle of some colours
    assert axes.patch.get_hatch()


def test_a_run_is_drawn_into_given_axes():
    three = struck((1,), 3, duration=3)
    run = simulate(replace(three, contact_sensors=(1,), bead_sensors=(0, 2)))
    given = Figure().add_subplot()
    ax = run.plot(given)
    assert ax is given
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names == ["bead 1", "bead 3", "contact 2"]
    forces = (*run.bead_force, *run.contact_force)
    for line, force in zip(ax.lines, forces, strict=True):
        assert np.array_equal(line.get_xdata(), run.time)
        assert np.array_equal(line.get_ydata(), force)
    ax.figure.draw_without_rendering()
    assert ax.get_legend().get_window_extent().y0 >= ax.bbox.y1  # on no curve
    own = run.plot()
    assert (own.get_xlabel(), own.get_ylabel()) == ("time", "force")
    pyplot.close(own.figure)
    with pytest.raises(InputError, match="no picture"):
        simulate(three).plot()
