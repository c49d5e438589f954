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
    from lwa.base.exact import InputError as InputError
    from lwa.base.frozen import Estimate as Estimate
    from lwa.base.frozen import NoSolitaryWave as NoSolitaryWave
    from lwa.cell import Cell as Cell
    from lwa.cell import D as D
    from lwa.cell import Dimer as Dimer
    from lwa.cell import k as k
    from lwa.envelopes.schrodinger import Breather as Breather
    from lwa.envelopes.schrodinger import Envelope as Envelope
    from lwa.envelopes.schrodinger import envelope as envelope
    from lwa.equation.pde import PDE as PDE
    from lwa.expansion.expand import Expansion as Expansion
    from lwa.expansion.expand import expand as expand
    from lwa.expansion.physical import ExpandedWave as ExpandedWave
    from lwa.expansion.physical import Strike as Strike
    from lwa.expansion.physical import pulse_of_strike as pulse_of_strike
    from lwa.law import Law as Law
    from lwa.law import Power as Power
    from lwa.law import general as general
    from lwa.linear.bands import Bands as Bands
    from lwa.linear.dispersion import Dispersion as Dispersion
    from lwa.linear.dispersion import LoadedChain as LoadedChain
    from lwa.loaded.background import KdV as KdV
    from lwa.loaded.lattice import Lattice as Lattice
    from lwa.loaded.lattice import Link as Link
    from lwa.loaded.lattice import Resonator as Resonator
    from lwa.loaded.lattice import hexagonal as hexagonal
    from lwa.loaded.wave import LoadedWave as LoadedWave
    from lwa.loaded.wave import loaded_wave as loaded_wave
    from lwa.shocks.riemann import Shock as Shock
    from lwa.shocks.riemann import piston as piston
    from lwa.shocks.riemann import shock as shock
    from lwa.spheres import hertz as hertz
    from lwa.spheres.hertz import Material as Material
    from lwa.spheres.hertz import Sphere as Sphere
    from lwa.theory import Theory as Theory
    from lwa.theory import homogenize as homogenize
    from lwa.wave.compact import CompactWave as CompactWave
    from lwa.wave.compact import PhysicalWave as PhysicalWave
    from lwa.wave.compact import canonical_wave as canonical_wave

    __version__: str

# Public names by their module, each loaded on its first use (PEP 562): the command starts before
# SymPy does.
_HOMES = {
    "lwa.base.frozen": "Estimate NoSolitaryWave",
    "lwa.base.exact": "InputError",
    "lwa.cell": "Cell D Dimer k",
    "lwa.envelopes.schrodinger": "Breather Envelope envelope",
    "lwa.equation.pde": "PDE",
    "lwa.expansion.expand": "Expansion expand",
    "lwa.expansion.physical": "ExpandedWave Strike pulse_of_strike",
    "lwa.law": "Law Power general",
    "lwa.linear.bands": "Bands",
    "lwa.linear.dispersion": "Dispersion LoadedChain",
    "lwa.loaded.background": "KdV",
    "lwa.loaded.lattice": "Lattice Link Resonator hexagonal",
    "lwa.loaded.wave": "LoadedWave loaded_wave",
    "lwa.shocks.riemann": "Shock piston shock",
    "lwa.spheres.hertz": "Material Sphere hertz",
    "lwa.theory": "Theory homogenize",
    "lwa.wave.compact": "CompactWave PhysicalWave canonical_wave",
}
_HOME = {name: module for module, names in _HOMES.items() for name in names.split()}
__all__ = sorted(_HOME.keys() - {"D", "k"})  # bound by name only


def __getattr__(name: str) -> Any:
    """Load a public name on its first use."""
    if name == "__version__":
        from importlib.metadata import version  # here: it takes as long as all the rest

        return version("lwa")
    if name not in _HOME:
        raise AttributeError(f"module 'lwa' has no attribute {name!r}")
    home = import_module(_HOME[name])
    return home if name == "hertz" else getattr(home, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
