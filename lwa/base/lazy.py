"""Public names of a package, each loaded on its first use."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any


def public(package: str, file: str) -> tuple[Callable[[str], Any], list[str]]:
    """Return the function ``__getattr__`` of a package and its public names, sorted.

    file : source of the package. Public are the names that it imports for type checkers, by lines
    ``from MODULE import NAME as NAME``. A name may be a module, too.
    """
    modules = {}
    with open(file, encoding="utf-8") as source:
        for words in map(str.split, source):
            if words[:1] == ["from"] and words[-2:-1] == ["as"]:
                modules[words[-1]] = words[1]

    def load(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        home = import_module(modules[name])
        defined = hasattr(home, name)
        return getattr(home, name) if defined else import_module(f"{modules[name]}.{name}")

    return load, sorted(modules)
