"""Public names of `lwa` and their modules: for type checkers, and for `lwa` itself."""

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
from lwa.expansion.lattice_wave import LatticeWave as LatticeWave
from lwa.expansion.lattice_wave import lattice_wave as lattice_wave
from lwa.expansion.strike import Strike as Strike
from lwa.expansion.strike import pulse_of_strike as pulse_of_strike
from lwa.law import Law as Law
from lwa.law import Power as Power
from lwa.law import general as general
from lwa.linear.dispersion import Dispersion as Dispersion
from lwa.linear.dispersion import LoadedChain as LoadedChain
from lwa.linear.springs import Bands as Bands
from lwa.loaded.background import KdV as KdV
from lwa.loaded.lattice import Lattice as Lattice
from lwa.loaded.lattice import Link as Link
from lwa.loaded.lattice import Resonator as Resonator
from lwa.loaded.lattice import hexagonal as hexagonal
from lwa.loaded.wave import LoadedWave as LoadedWave
from lwa.loaded.wave import loaded_wave as loaded_wave
from lwa.shocks.front import piston as piston
from lwa.shocks.front import shock as shock
from lwa.shocks.riemann import Shock as Shock
from lwa.spheres import hertz as hertz
from lwa.spheres.hertz import Material as Material
from lwa.spheres.hertz import Sphere as Sphere
from lwa.theory import Theory as Theory
from lwa.theory import homogenize as homogenize
from lwa.wave.compact import CompactWave as CompactWave
from lwa.wave.compact import canonical_wave as canonical_wave
from lwa.wave.physical import PhysicalWave as PhysicalWave

__all__: list[str]
__version__: str
