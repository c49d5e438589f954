"""Types of NumPy arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""An array of float64."""

Extended = NDArray[np.longdouble]
"""An array of extended precision."""
