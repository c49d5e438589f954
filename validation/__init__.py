"""Numerical validation: chains of beads, simulated and measured beside the theory of `lwa`.

>>> from validation import Scene, measure, simulate
>>> chain = Scene(masses=(1,) * 60, stiffnesses=(1,) * 59, k="3/2", duration=60,
...               velocities=(1,), contact_sensors=(20, 40))
>>> run = simulate(chain)
>>> first, second = (measure(run.signal("contact", i)) for i in (20, 40))
>>> speed = 20 / (second.arrival - first.arrival)
>>> round(second.fwhm * speed, 4)  # sites under the contact force of a Hertz chain's pulse
1.4119
"""

from typing import Any

from lwa.base import public_modules


def __getattr__(name: str) -> Any:
    """Load a public name on its first use (PEP 562): the command starts before NumPy does."""
    if name == "__version__":
        from lwa import __version__

        return __version__
    if name == "__all__":
        return sorted(public_modules(__file__))
    if name not in public_modules(__file__):
        raise AttributeError(f"module 'validation' has no attribute {name!r}")
    return getattr(__import__(public_modules(__file__)[name], fromlist=[name]), name)


def __dir__() -> list[str]:
    """Names that editors and shells complete, loaded or not."""
    return sorted([*public_modules(__file__), "__version__"])
