"""Base classes of the package's results: LaTeX of all, equality and pickles of dataclasses."""

from __future__ import annotations

from dataclasses import Field, fields
from typing import Any, ClassVar

from lwa.base import latex


class Shown:
    """Base of results that notebooks and `sympy.latex` show by the rows of `latex_rows`."""

    def latex_rows(self) -> list[str]:
        """LaTeX of the value in rows such as ``I = …``; if empty, a notebook shows the repr."""
        return []

    def _repr_latex_(self) -> str | None:
        rows = self.latex_rows()
        return latex.display(rows) if rows else None

    def _latex(self, printer: Any) -> str:  # SymPy's name: `sympy.latex` calls it
        return (self._repr_latex_() or str(self)).strip("$")


class Value(Shown):
    """Base of frozen dataclasses: equality, hash and pickle go by the fields alone.

    Pickles and copies leave out cached properties.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}
