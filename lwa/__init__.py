"""Long-wave theory of granular chains and nonlinear lattices, exact and symbolic.

>>> import sympy as sp
>>> from lwa import Dimer, homogenize
>>> m1, m2 = sp.symbols("m1 m2", positive=True)
>>> theory = homogenize(Dimer(m1, m2), order=4)
>>> theory.pde.I
D**2*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lwa.algebra.coefficients import CoefficientRing
    from lwa.algebra.jets import Monomial
    from lwa.algebra.model import Model
    from lwa.base.arrays import Array
    from lwa.base.exact import InputError, Quantity
    from lwa.base.quantities import NoSolitaryWave
    from lwa.cell import Cell, Dimer
    from lwa.cell import D as D
    from lwa.cell import k as k
    from lwa.closure.consistency import Closure
    from lwa.closure.solution import Solution
    from lwa.envelopes.breather import Breather
    from lwa.envelopes.schrodinger import Envelope, envelope
    from lwa.equation.evolution import Evolution
    from lwa.equation.pde import PDE
    from lwa.equation.terms import Jet, Powers, Terms
    from lwa.expansion.approximants import Resummed
    from lwa.expansion.expand import Expansion, expand
    from lwa.expansion.physical import ExpandedWave
    from lwa.expansion.radiation import Radiation
    from lwa.expansion.series import EpsilonSeries
    from lwa.expansion.strike import Strike, graded_force, pulse_of_strike, transmitted_force
    from lwa.law import ContactLaw, Law, Power, general
    from lwa.linear.dispersion import Dispersion, LoadedChain
    from lwa.shocks.riemann import Shock, piston, shock
    from lwa.spheres import hertz
    from lwa.spheres.hertz import Material, Sphere
    from lwa.theory import Theory, homogenize
    from lwa.wave.background import BackgroundWave, background_wave
    from lwa.wave.closed import CompactWave, Reduction
    from lwa.wave.kdv import KdV
    from lwa.wave.numeric import NumericWave
    from lwa.wave.physical import PhysicalWave
    from lwa.wave.precompressed import PrecompressedWave
    from lwa.wave.quadrature import NumericBackground
    from lwa.wave.traveling import TravelingWave, canonical_wave

    __version__: str

__all__ = [
    "PDE",
    "Array",
    "BackgroundWave",
    "Breather",
    "Cell",
    "Closure",
    "CoefficientRing",
    "CompactWave",
    "ContactLaw",
    "Dimer",
    "Dispersion",
    "Envelope",
    "EpsilonSeries",
    "Evolution",
    "ExpandedWave",
    "Expansion",
    "InputError",
    "Jet",
    "KdV",
    "Law",
    "LoadedChain",
    "Material",
    "Model",
    "Monomial",
    "NoSolitaryWave",
    "NumericBackground",
    "NumericWave",
    "PhysicalWave",
    "Power",
    "Powers",
    "PrecompressedWave",
    "Quantity",
    "Radiation",
    "Reduction",
    "Resummed",
    "Shock",
    "Solution",
    "Sphere",
    "Strike",
    "Terms",
    "Theory",
    "TravelingWave",
    "background_wave",
    "canonical_wave",
    "envelope",
    "expand",
    "general",
    "graded_force",
    "hertz",
    "homogenize",
    "piston",
    "pulse_of_strike",
    "shock",
    "transmitted_force",
]


_MODULES = {
    "algebra.coefficients": "CoefficientRing",
    "algebra.jets": "Monomial",
    "algebra.model": "Model",
    "wave.background": "BackgroundWave background_wave",
    "wave.kdv": "KdV",
    "wave.precompressed": "PrecompressedWave",
    "wave.quadrature": "NumericBackground",
    "cell": "Cell D Dimer k",
    "closure.consistency": "Closure",
    "closure.solution": "Solution",
    "base.arrays": "Array",
    "wave.numeric": "NumericWave",
    "wave.physical": "PhysicalWave",
    "wave.closed": "CompactWave Reduction",
    "base.exact": "InputError Quantity",
    "envelopes.breather": "Breather",
    "envelopes.schrodinger": "Envelope envelope",
    "expansion.approximants": "Resummed",
    "expansion.expand": "Expansion expand",
    "expansion.physical": "ExpandedWave",
    "expansion.radiation": "Radiation",
    "expansion.series": "EpsilonSeries",
    "expansion.strike": "Strike graded_force pulse_of_strike transmitted_force",
    "law": "ContactLaw Law Power general",
    "linear.dispersion": "Dispersion LoadedChain",
    "equation.evolution": "Evolution",
    "equation.pde": "PDE",
    "base.quantities": "NoSolitaryWave",
    "shocks.riemann": "Shock piston shock",
    "spheres.hertz": "Material Sphere",
    "equation.terms": "Jet Powers Terms",
    "theory": "Theory homogenize",
    "wave.traveling": "TravelingWave canonical_wave",
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    """Each name is loaded when it is first asked for: the command starts before SymPy does."""
    if name == "__version__":
        from importlib.metadata import version  # here: it takes as long as all the rest

        return version("lwa")
    if name == "hertz":
        return import_module("lwa.spheres.hertz")
    if name not in _HOMES:
        raise AttributeError(f"module 'lwa' has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(f"lwa.{_HOMES[name]}"), name)
    return found


def __dir__() -> list[str]:
    return [*globals(), *__all__]
