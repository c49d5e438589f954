"""Values: frozen dataclasses that are known by what they were made from.

Two that were made from the same are equal and hash alike. What one has computed and kept (its
cached properties) neither counts nor travels when it is pickled or copied.
"""

from __future__ import annotations

from dataclasses import Field, fields
from typing import Any, ClassVar


class Value:
    """Base of the frozen dataclasses of this package."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}
