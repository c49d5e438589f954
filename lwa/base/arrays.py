"""The type of an array of numbers, a reader of arrays, and compiled expressions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray
from sympy.core.function import AppliedUndef

from lwa.base.exact import InputError, shorten

Array = NDArray[np.float64]
"""An array of float64."""


def finite(values: ArrayLike, name: str) -> Array:
    """Read an array of finite real numbers.

    Raises `lwa.InputError` for anything else; ``name`` names the array in the message.
    """
    try:
        array = np.asarray(values)
        array = array.astype(
            float, casting="unsafe" if array.dtype.kind == "O" else "safe"
        )
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            f"{name} is {shorten(values)}: real numbers are wanted"
        ) from None
    if not np.all(np.isfinite(array)):
        raise InputError(
            f"{name} is {array[~np.isfinite(array)].flat[0]}: finite numbers are wanted"
        )
    return array


def function_of(x: sp.Symbol, value: sp.Expr) -> Callable[[Array], Array]:
    """Compile an expression in a symbol to a function of arrays.

    Raises `lwa.InputError` for a function without an expression, such as the law `general`.
    """
    if value.has(AppliedUndef):
        raise InputError(f"{shorten(value)} has no expression: floats need one")
    # NumPy has no integers of more than 63 bits.
    long = {
        q: sp.Float(q, 17) for q in value.atoms(sp.Rational) if q.p.bit_length() > 53
    }
    function = sp.lambdify(x, value.xreplace(long), "numpy")

    return lambda at: np.broadcast_to(np.asarray(function(at), np.float64), at.shape)
