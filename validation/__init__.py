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

from lwa.base import public_names

__getattr__, __dir__ = public_names(__name__, __file__)
