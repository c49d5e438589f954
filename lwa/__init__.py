"""Long-wave theory of granular chains and nonlinear lattices, exact and symbolic.

>>> import sympy as sp
>>> from lwa import Dimer, homogenize
>>> m1, m2 = sp.symbols("m1 m2", positive=True)
>>> theory = homogenize(Dimer(m1, m2), order=4)
>>> theory.pde.I
D**2*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)
"""

from functools import cache
from typing import Any


@cache
def _modules() -> dict[str, str]:
    """Modules of the public names, which the stub beside this file lists."""
    import ast
    from pathlib import Path

    stub = Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8")
    modules = {}
    for node in ast.parse(stub).body:
        if isinstance(node, ast.ImportFrom) and node.module:
            for name in node.names:
                modules[name.name] = node.module
    return modules


def __getattr__(name: str) -> Any:
    """Load a public name on its first use (PEP 562): the command starts before SymPy does."""
    if name == "__version__":
        from importlib.metadata import version  # here: it takes as long as all the rest

        return version("lwa")
    if name == "__all__":
        return sorted(_modules().keys() - {"D", "k"})  # bound by name only
    if name not in _modules():
        raise AttributeError(f"module 'lwa' has no attribute {name!r}")
    return getattr(__import__(_modules()[name], fromlist=[name]), name)


def __dir__() -> list[str]:
    return sorted([*_modules(), "__version__"])
