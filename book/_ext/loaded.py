"""What the kernels of the pages have loaded when they start (`executed.py`).

Loading costs four seconds of CPU, reading the compiled engine another one.
"""

from importlib import import_module
from pathlib import Path

import matplotlib.pyplot as plt

import lwa
import validation

for name in ("ipykernel.kernelapp", "matplotlib.backends.backend_svg", "sympy"):
    import_module(name)
# Packages load the modules of what they export at its first use.
for package in (lwa, validation):
    for name in package.__all__:
        getattr(package, name)

# The engine, which is compiled here if it is not yet: one serves every scene.
beads = validation.Scene(
    masses=(1, 1), stiffnesses=(1,), k=1.5, duration=1, bead_sensors=(0,)
)
validation.simulate(beads)
validation.exact_wave([1], 1.5)

# The look of all pictures
plt.style.use(Path(__file__).parents[1] / "style.mplstyle")
