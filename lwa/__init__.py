"""Long-wave theory of granular chains and nonlinear lattices, exact and symbolic."""

from lwa.cell import Cell, D, Dimer, k
from lwa.exact import InputError

__all__ = ["Cell", "D", "Dimer", "InputError", "k"]
