"""Public names of a package, each loaded on its first use."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pkgutil import get_data
from typing import Any


def public(package: str) -> tuple[Callable[[str], Any], list[str]]:
    """Return the function ``__getattr__`` of a package and its public names, sorted.

    Public are the names that the package's source imports for type checkers, by lines
    ``from MODULE import NAME as NAME``. A name may be a module, too.
    """
    modules = {}
    source = (get_data(package, "__init__.py") or b"").decode()  # of an installed file or a zip
    for words in map(str.split, source.splitlines()):
        if words[:1] == ["from"] and words[-2:-1] == ["as"]:
            modules[words[-1]] = words[1]

    def load(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        home = import_module(modules[name])
        defined = hasattr(home, name)
        return getattr(home, name) if defined else import_module(f"{modules[name]}.{name}")

    return load, sorted(modules)
