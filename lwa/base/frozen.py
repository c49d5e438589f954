"""Base class of the package's frozen dataclasses: equality, pickles and notebooks."""

from __future__ import annotations

from dataclasses import Field, fields
from typing import Any, ClassVar

from lwa.base import latex


class Value:
    """Base of frozen dataclasses: equality, hash and pickle go by the fields alone.

    Pickles and copies leave out cached properties. A notebook shows the rows of `latex_rows`.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def latex_rows(self) -> list[str]:
        """LaTeX of the value in rows such as ``I = …``; if empty, a notebook shows the repr."""
        return []

    def _repr_latex_(self) -> str | None:
        rows = self.latex_rows()
        return latex.display(rows) if rows else None
