"""Types of NumPy arrays, a reader of arrays, and values that hold arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import Field, fields
from typing import Any, ClassVar

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
        array = array.astype(float, casting="unsafe" if array.dtype.kind == "O" else "safe")
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} is {shorten(values)}: real numbers are wanted") from None
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
    long = {q: sp.Float(q, 17) for q in value.atoms(sp.Rational) if q.p.bit_length() > 53}
    function = sp.lambdify(x, value.xreplace(long), "numpy")

    return lambda at: np.broadcast_to(np.asarray(function(at), np.float64), at.shape)


class ArrayValue:
    """Base of frozen dataclasses with array fields (``eq=False``): equal if all fields are equal.

    A copy and a pickle of such a value compare equal to it.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        names = (field.name for field in fields(self) if field.compare)
        return all(_same(getattr(self, name), getattr(other, name)) for name in names)

    def __hash__(self) -> int:
        values = (getattr(self, field.name) for field in fields(self))
        return hash(tuple(value for value in values if isinstance(value, int | float | str)))


def _same(a: Any, b: Any) -> bool:
    """Equality of arrays (NaN equals NaN), of mappings of arrays, or of anything else."""
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return a.keys() == b.keys() and all(_same(a[key], b[key]) for key in a)
    if isinstance(a, np.ndarray):
        return np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    return bool(a == b)
