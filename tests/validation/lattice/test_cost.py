"""Limits of steps and memory are checked before a run; every run ends, with finite numbers."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, strategies as st

from tests.validation.lattice.scenes import drawn
from validation.lattice import cost
from validation.pulses.sensors import record
from validation.scenes.scene import SceneError

sizes = st.builds(lambda m, e: m * 10.0**e, st.floats(1, 9.99), st.integers(-320, 307))
fields = st.sampled_from(("masses", "stiffnesses", "velocities", "displacements"))
values = st.sampled_from(("k", "duration", "wall", "gravity", "precompression"))


@pytest.mark.filterwarnings("ignore:lsoda")
@given(
    st.integers(0, 10**6),
    st.dictionaries(fields, sizes, max_size=2),
    st.dictionaries(values, sizes, max_size=2),
    st.sampled_from(["RKN86", "DOP853", "LSODA", "symplectic"]),
)
@example(16851, {"displacements": 6.6e302}, {"wall": 4.8e-194}, "symplectic")
def test_any_scene_gives_finite_numbers_or_one_line(seed, factors, changed, method):
    """Random scenes in which some values are of any size that floats have."""
    what = drawn(seed)
    rows = {name: np.multiply(getattr(what, name), x) for name, x in factors.items()}
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(cost, "MOST_STEPS", 1e4)
            made = record(replace(what, **rows, **changed), method=method, rtol=1e-6)
    except (SceneError, cost.IntegrationError) as error:
        line = str(error)
        assert re.fullmatch(
            ".{1,250}", line
        )  # a dot is any character but the end of a line
        return
    run = made.run
    numbers = [
        run.end,
        run.energy_drift,
        *run.columns().values(),
    ]
    for reading in (*made.sensors, *made.speeds):
        numbers += [number.value + number.error for number in reading.numbers.values()]
        assert reading.missing is None or "\n" not in reading.missing
    for values in numbers:
        assert np.isfinite(values).all()
