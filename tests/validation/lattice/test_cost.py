"""Limits of steps and memory are checked before a run; every run ends, with finite numbers."""

import math
from contextlib import nullcontext

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from validation.lattice import cost
from validation.lattice.simulate import METHODS, simulate
from validation.pulses.sensors import record
from validation.scenes.scene import Scene, SceneError
from validation.scenes.scenefile import scene


def struck(n, omega=1.0, k=1.5, **rest):
    return Scene(
        masses=(1.0, omega) * (n // 2), stiffnesses=(1.0,) * (n - 1), k=k,
        **({"velocities": (1.0,), "duration": 25.0} | rest),
    )  # fmt: skip


PRESSED = Scene(
    masses=(1, 0.3, 2), stiffnesses=(1, 2), wall=1, k=1.5, precompression=1, duration=50,
    velocities=(0, 0.8, -0.6),
)  # fmt: skip


def watched(what, **options):
    """A run, and the shares of its duration reported on the way."""
    shares = []
    return simulate(what, progress=lambda: nullcontext(shares.append), **options), shares


@pytest.mark.parametrize(("method", "rtol"), [("RKN86", 1e-13), *((m, 1e-7) for m in METHODS)])
@pytest.mark.parametrize("what", [struck(20, 0.5, 1.0), struck(20, 0.01), PRESSED])
def test_adaptive_methods_stay_far_below_the_limit_of_their_steps(method, what, rtol, monkeypatch):
    """A limit of a fifth is kept as well."""
    monkeypatch.setattr(cost, "_DENSEST", cost._DENSEST // 5)
    _, shares = watched(what, method=method, rtol=rtol, atol=rtol)
    assert shares == sorted(shares)
    assert shares[-1] == (1 if method in METHODS else 0)  # compiled runs are over before a glance


def test_a_compiled_run_looks_up_on_the_way(monkeypatch):
    """A run in parts gives the same bits as a run in one go."""
    scene = struck(200, 0.3, duration=190.0, contact_sensors=(50,))
    whole = watched(scene, method="SRKN14")
    monkeypatch.setattr("validation.lattice.engine._BETWEEN_REPORTS", 1e4)
    parts = watched(scene, method="SRKN14")
    assert len(whole[1]) <= 5
    assert len(parts[1]) > 20
    assert parts[1] == sorted(parts[1])
    for name in ("contact_force", "displacements", "velocities"):
        np.testing.assert_array_equal(getattr(whole[0], name), getattr(parts[0], name))
    assert whole[0].bead_evaluations == parts[0].bead_evaluations


@pytest.mark.parametrize("method", ["DOP853", "RKN86", "SRKN14"])
def test_a_run_can_be_interrupted(method):
    def interrupt(share):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulate(struck(20), method=method, progress=lambda: nullcontext(interrupt))


# --- whatever a file holds ------------------------------------------------------------------

powers = st.builds(lambda m, e: m * 10.0**e, st.floats(1, 9.99), st.integers(-320, 307))
sizes = st.sampled_from([1.0, 1.0, 0.5, 2]) | st.floats(1e-3, 1e3) | powers
reals = sizes | st.builds(lambda x: -x, sizes) | st.just(0.0)
wrong = st.sampled_from([None, True, "1", [], {}, float("nan"), float("inf"), 10**400, 10**5000])


def row(numbers, most):
    return st.lists(numbers, min_size=1, max_size=most)


def table(**entries):
    return st.fixed_dictionaries({}, optional=entries)


files = st.fixed_dictionaries(
    {
        "duration": sizes,
        "chain": st.fixed_dictionaries(
            {"cell": row(sizes, 4), "k": st.sampled_from([1.5, 1, 1.3, 3]) | sizes},
            optional={"repeat": st.integers(1, 4), "stiffnesses": sizes, "spacings": sizes},
        ),
    },
    optional={
        "samples": st.integers(2, 300),
        "gravity": reals,
        "precompression": reals,
        "wall": table(stiffness=sizes),
        "start": table(velocities=row(reals, 4), displacements=row(reals, 4)),
        "defects": st.lists(
            st.fixed_dictionaries({"bead": st.integers(1, 4), "mass": sizes})
            | st.fixed_dictionaries({"contact": st.integers(1, 4), "stiffness": sizes}),
            max_size=3,
        ),
        "sensors": table(beads=row(st.integers(1, 4), 3), contacts=row(st.integers(1, 4), 3)),
    },
)


@st.composite
def spoiled(draw):
    """A file, and sometimes something else in one place of it."""
    content = at = draw(files)
    if draw(st.integers(0, 3)) == 0:
        while True:
            key = draw(st.sampled_from(sorted(at) if isinstance(at, dict) else range(len(at))))
            if not isinstance(at[key], dict | list) or not at[key]:
                break
            at = at[key]
        at[key] = draw(wrong)
    return content


@given(spoiled(), st.sampled_from(["RKN86", "DOP853", "LSODA", "SRKN14"]))
@settings(max_examples=50)
def test_any_file_gives_finite_numbers_or_one_line(content, method):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cost, "MOST_STEPS", 1e4)
        try:
            what = scene(content)
            made = record(what, method=method, rtol=1e-6)
        except (SceneError, cost.IntegrationError) as error:
            message = str(error)
            assert message
            assert "\n" not in message
            assert len(message) < 250
            return
    run = made.run
    for name in ("contact_force", "compression", "bead_force", "bead_velocity", "velocities"):
        assert np.isfinite(getattr(run, name)).all(), name
    assert np.isfinite(run.displacements).all()
    assert math.isfinite(run.energy_drift)
    assert run.momentum_drift is None or math.isfinite(run.momentum_drift)
    for sensor in (*made.sensors, *made.speeds):
        for number in sensor.numbers.values():
            assert math.isfinite(number.value)
            assert math.isfinite(number.error)
        assert sensor.missing is None or "\n" not in sensor.missing
