"""Long-wave theory of granular chains and nonlinear lattices, exact and symbolic.

>>> import sympy as sp
>>> from lwa import Dimer, homogenize
>>> m1, m2 = sp.symbols("m1 m2", positive=True)
>>> theory = homogenize(Dimer(m1, m2), order=4)
>>> theory.pde.I
D**2*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)
"""

from typing import TYPE_CHECKING, Any

from lwa.base.lazy import public

if TYPE_CHECKING:
    from lwa.base.estimate import Estimate as Estimate
    from lwa.base.exact import InputError as InputError
    from lwa.base.quantities import NoSolitaryWave as NoSolitaryWave
    from lwa.cell import Cell as Cell
    from lwa.cell import D as D
    from lwa.cell import Dimer as Dimer
    from lwa.cell import k as k
    from lwa.closure.consistency import Closure as Closure
    from lwa.envelopes.schrodinger import Breather as Breather
    from lwa.envelopes.schrodinger import Envelope as Envelope
    from lwa.envelopes.schrodinger import envelope as envelope
    from lwa.equation.pde import PDE as PDE
    from lwa.equation.terms import Terms as Terms
    from lwa.expansion.approximants import Resummed as Resummed
    from lwa.expansion.expand import Expansion as Expansion
    from lwa.expansion.expand import expand as expand
    from lwa.expansion.physical import ExpandedWave as ExpandedWave
    from lwa.expansion.physical import Strike as Strike
    from lwa.expansion.physical import pulse_of_strike as pulse_of_strike
    from lwa.expansion.series import EpsilonSeries as EpsilonSeries
    from lwa.force import ContactLaw as ContactLaw
    from lwa.law import Law as Law
    from lwa.law import Power as Power
    from lwa.law import general as general
    from lwa.linear.bands import Bands as Bands
    from lwa.linear.dispersion import Dispersion as Dispersion
    from lwa.linear.dispersion import LoadedChain as LoadedChain
    from lwa.links.lattice import Lattice as Lattice
    from lwa.links.lattice import Link as Link
    from lwa.links.lattice import Resonator as Resonator
    from lwa.links.packings import hexagonal as hexagonal
    from lwa.links.wave import LatticeWave as LatticeWave
    from lwa.links.wave import lattice_wave as lattice_wave
    from lwa.shocks.riemann import Shock as Shock
    from lwa.shocks.riemann import piston as piston
    from lwa.shocks.riemann import shock as shock
    from lwa.spheres import hertz as hertz
    from lwa.spheres.hertz import Material as Material
    from lwa.spheres.hertz import Sphere as Sphere
    from lwa.theory import Theory as Theory
    from lwa.theory import homogenize as homogenize
    from lwa.wave.background import BackgroundWave as BackgroundWave
    from lwa.wave.background import background_wave as background_wave
    from lwa.wave.closed import CompactWave as CompactWave
    from lwa.wave.closed import Reduction as Reduction
    from lwa.wave.kdv import KdV as KdV
    from lwa.wave.numeric import NumericWave as NumericWave
    from lwa.wave.physical import PhysicalWave as PhysicalWave
    from lwa.wave.physical import PrecompressedWave as PrecompressedWave
    from lwa.wave.traveling import TravelingWave as TravelingWave
    from lwa.wave.traveling import canonical_wave as canonical_wave

    __version__: str

_load, _names = public(__name__)
__all__ = [name for name in _names if name not in ("D", "k")]  # bound by name only


def __getattr__(name: str) -> Any:
    """Load a public name on its first use, so that the command starts before SymPy does."""
    if name == "__version__":
        from importlib.metadata import version  # here: it takes as long as all the rest

        return version("lwa")
    return _load(name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
