"""Types of NumPy arrays, and arrays that enter from outside."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lwa.base.exact import InputError, shorten

Array = NDArray[np.float64]
"""An array of float64."""

Extended = NDArray[np.longdouble]
"""An array of extended precision."""


def finite(values: ArrayLike, name: str) -> Array:
    """Read an array of finite real numbers.

    Raises `lwa.InputError` for anything else; ``name`` is what the message calls it.
    """
    try:
        array = np.asarray(values)
        array = array.astype(float, casting="unsafe" if array.dtype.kind == "O" else "safe")
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} is {shorten(values)}: real numbers are wanted") from None
    if not np.all(np.isfinite(array)):
        raise InputError(
            f"{name} is {array[~np.isfinite(array)].flat[0]}: finite numbers are wanted"
        )
    return array
