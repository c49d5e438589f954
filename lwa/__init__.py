"""Long-wave theory of granular chains and nonlinear lattices, exact and symbolic.

>>> import sympy as sp
>>> from lwa import Dimer, homogenize
>>> m1, m2 = sp.symbols("m1 m2", positive=True)
>>> theory = homogenize(Dimer(m1, m2), order=4)
>>> theory.pde.I
D**2*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)
"""

from lwa.cell import Cell, D, Dimer, k
from lwa.closure import Closure
from lwa.dispersion import Dispersion
from lwa.exact import InputError
from lwa.expansion import Expansion, expand
from lwa.pde import PDE
from lwa.quantities import NoSolitaryWave
from lwa.terms import Jet, Terms
from lwa.theory import Theory, homogenize
from lwa.wave import TravelingWave, canonical_wave

__all__ = [
    "PDE",
    "Cell",
    "Closure",
    "D",
    "Dimer",
    "Dispersion",
    "Expansion",
    "InputError",
    "Jet",
    "NoSolitaryWave",
    "Terms",
    "Theory",
    "TravelingWave",
    "canonical_wave",
    "expand",
    "homogenize",
    "k",
]
