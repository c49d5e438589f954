"""The result of a run: its pictures."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from lwa import InputError
from validation.lattice.simulate import simulate
from validation.scenes.chains import struck

THREE = struck((1,), 3, duration=3)


def test_a_run_is_drawn_into_given_axes():
    watched = replace(THREE, contact_sensors=(1,), bead_sensors=(0, 2))
    run, ax = simulate(watched), Figure().add_subplot()
    assert run.plot(ax) is ax
    assert [text.get_text() for text in ax.get_legend().get_texts()] == [
        "bead 1", "bead 3", "contact 2",
    ]  # fmt: skip
    for line, force in zip(ax.lines, (*run.bead_force, *run.contact_force), strict=True):
        assert np.array_equal(line.get_xdata(), run.time)
        assert np.array_equal(line.get_ydata(), force)
    ax.figure.draw_without_rendering()
    assert ax.get_legend().get_window_extent().y0 >= ax.bbox.y1  # on no curve
    with pytest.raises(InputError, match="no picture"):
        simulate(THREE).plot()
