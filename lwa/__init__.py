"""Long-wave theory of granular chains and nonlinear lattices, exact and symbolic.

>>> import sympy as sp
>>> from lwa import Dimer, homogenize
>>> m1, m2 = sp.symbols("m1 m2", positive=True)
>>> theory = homogenize(Dimer(m1, m2), order=4)
>>> theory.pde.I
D**2*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)
"""

from typing import TYPE_CHECKING, Any

from lwa.cell import Cell, D, Dimer, k
from lwa.closure.consistency import Closure
from lwa.closure.motion import Solution
from lwa.coefficients import Coefficients, Partition
from lwa.compact import CompactWave
from lwa.exact import InputError, Quantity
from lwa.expansion.approximants import Resummed
from lwa.expansion.expand import Expansion, expand
from lwa.expansion.radiation import Radiation
from lwa.expansion.series import EpsilonSeries
from lwa.jets import JetAlgebra, Ladder, Monomial, Term
from lwa.linear.dispersion import Dispersion
from lwa.pde import PDE
from lwa.physical import PhysicalWave
from lwa.quantities import NoSolitaryWave
from lwa.reduction import Reduction
from lwa.spheres import hertz
from lwa.spheres.hertz import Material, Sphere
from lwa.terms import Jet, Powers, Terms
from lwa.theory import Theory, homogenize
from lwa.wave import TravelingWave, canonical_wave

if TYPE_CHECKING:
    from lwa.numeric import Array, NumericWave

__all__ = [
    "PDE",
    "Array",
    "Cell",
    "Closure",
    "Coefficients",
    "CompactWave",
    "D",
    "Dimer",
    "Dispersion",
    "EpsilonSeries",
    "Expansion",
    "InputError",
    "Jet",
    "JetAlgebra",
    "Ladder",
    "Material",
    "Monomial",
    "NoSolitaryWave",
    "NumericWave",
    "Partition",
    "PhysicalWave",
    "Powers",
    "Quantity",
    "Radiation",
    "Reduction",
    "Resummed",
    "Solution",
    "Sphere",
    "Term",
    "Terms",
    "Theory",
    "TravelingWave",
    "canonical_wave",
    "expand",
    "hertz",
    "homogenize",
    "k",
]


def __getattr__(name: str) -> Any:
    """What needs NumPy is loaded when it is asked for."""
    if name in ("Array", "NumericWave"):
        from lwa import numeric

        return getattr(numeric, name)
    raise AttributeError(f"module 'lwa' has no attribute {name!r}")
