"""Numbers of any kind: read as floats, or refused in one line."""

from decimal import Decimal
from fractions import Fraction

import pytest

from validation.lattice.simulate import simulate
from validation.pulses.sensors import record
from validation.scenes.chains import struck
from validation.scenes.scene import Scene, SceneError

CHAIN = struck((1,), 4, duration=3)


@pytest.mark.parametrize("method", ["DOP853", "SRKN14"])
@pytest.mark.parametrize("call", [simulate, record])
def test_a_tolerance_of_any_kind_is_a_float(call, method):
    for value, message in (
        (Fraction(1, 2), "rtol is 0.5: it lies between 1e-13 and "),
        (Decimal(1), "rtol is 1: it lies"),
        (0.1000000001, "rtol is 0.1000000001: it lies"),
        (Decimal("sNaN"), r"rtol is Decimal\('sNaN'\): a number is wanted"),
        (Decimal("NaN"), "rtol is nan: a finite number"),
        ([1e-9], r"rtol is \[1e-09\]: a number is wanted"),
    ):
        with pytest.raises(SceneError, match=f"^{message}"):
            call(CHAIN, rtol=value, method=method)
    for value in (Fraction(1, 10**6), Decimal("1e-6")):
        found, plain = (call(CHAIN, rtol=rtol, method=method) for rtol in (value, 1e-6))
        found, plain = (getattr(run, "run", run).velocities for run in (found, plain))
        assert (found == plain).all()


@pytest.mark.parametrize("name", ["masses", "k", "duration", "velocities", "gravity", "samples"])
def test_a_signalling_nan_is_refused(name):
    bad = Decimal("sNaN")
    given = {"masses": (1,), "stiffnesses": (), "k": 1.5, "duration": 1, "wall": 1}
    many = name in ("masses", "velocities")
    with pytest.raises(SceneError, match=rf"^{name}\S* is Decimal\('sNaN'\): "):
        Scene(**given | {name: (bad,) if many else bad})
