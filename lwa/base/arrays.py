"""The type of an array of numbers, a reader of arrays, and compiled expressions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray
from sympy.core.function import AppliedUndef

from lwa.base.exact import InputError, shorten

Array = NDArray[np.float64]
"""An array of float64."""


def finite(values: ArrayLike, name: str) -> Array:
    """Read an array of finite real numbers.

    Parameters
    ----------
    values : array_like
        Numbers of any kind that a float holds.
    name : str
        Name of the array in messages.

    Raises
    ------
    InputError
        For other values, NaN and infinities, and masked arrays, whose masks NumPy would drop.
    """
    if isinstance(values, np.ma.MaskedArray):
        raise InputError(
            f"{name} is a masked array: give its numbers without the masked ones, "
            f"{name}.compressed()"
        )
    try:
        array = np.asarray(values)
        # Objects such as SymPy's numbers become floats one by one; a complex number must not.
        casting: Literal["unsafe", "safe"] = "safe"
        if array.dtype.kind == "O":
            casting = "unsafe"
        array = array.astype(float, casting=casting)
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            f"{name} is {shorten(values)}: real numbers are wanted"
        ) from None
    infinite = array[~np.isfinite(array)]
    if infinite.size:
        raise InputError(f"{name} is {infinite.flat[0]}: finite numbers are wanted")
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
