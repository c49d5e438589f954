"""Long-wave theory of granular chains and nonlinear lattices, exact and symbolic.

>>> import sympy as sp
>>> from lwa import Dimer, homogenize
>>> m1, m2 = sp.symbols("m1 m2", positive=True)
>>> theory = homogenize(Dimer(m1, m2), order=4)
>>> theory.pde.I
D**2*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)
"""

from typing import Any

from lwa.base import public_modules


def __getattr__(name: str) -> Any:
    """Load a public name on its first use (PEP 562): the command starts before SymPy does."""
    if name == "__version__":
        from importlib.metadata import version  # here: it takes as long as all the rest

        return version("lwa")
    if name == "__all__":
        return sorted(
            public_modules(__file__).keys() - {"D", "k"}
        )  # bound by name only
    if name not in public_modules(__file__):
        raise AttributeError(f"module 'lwa' has no attribute {name!r}")
    return getattr(__import__(public_modules(__file__)[name], fromlist=[name]), name)


def __dir__() -> list[str]:
    return sorted([*public_modules(__file__), "__version__"])
