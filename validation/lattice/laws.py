"""Contact laws in numbers: force, stiffness and energy of a contact of unit stiffness.

A law with ``F′(0) > 0`` also pulls: Toda's, Fermi, Pasta, Ulam and Tsingou's, magnets. Any other
law opens where ``δ < 0``, as a power does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import sympy as sp
from sympy.codegen.rewriting import expm1_opt, optimize

from lwa.base.arrays import Array
from lwa.base.exact import shorten
from lwa.law import ContactLaw
from validation.scenes.checks import SceneError

# The energy of a smaller change, in units of the rest compression, is integrated: its digits cancel
# in the difference of two energies. Eight points integrate powers up to 20 to 1e-16 up to here.
_SMALL = 0.05
_TRIED = 7000  # compressions that are tried at a time, 1 % apart over thirty decades
_OPENS = 1e-100  # a compression at which a contact is about to open, in any units
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_NODES, _WEIGHTS = (1 + _NODES) / 2, _WEIGHTS / 2  # of an integral from 0 to 1


@dataclass(frozen=True)
class Contact:
    """The force F(δ) of a contact of unit stiffness.

    Parameters
    ----------
    k : float
        Exponent of the power law ``F = [δ]_+^k``.
    law : ContactLaw, optional
        Any other law, without symbols, in place of the power.
    damping_power : float, optional
        Exponent p of the damping force, proportional to ``δ^p dδ/dt``; None without damping.
    """

    k: float
    law: ContactLaw | None = None
    damping_power: float | None = None

    @cached_property
    def pulls(self) -> bool:
        """True if the contact holds, and pulls, where δ < 0."""
        return self.law is not None and self.law.pulls

    @cached_property
    def sticks(self) -> bool:
        """True if damping may pull, as the law pulls, or attracts where the contact opens."""
        (opening,) = self.force(np.array([_OPENS]))
        return self.pulls or bool(opening < 0)

    def force(self, compression: Array) -> Array:
        """Return the force F at a compression δ, of any shape; ``[δ]_+^k`` for a power law."""
        if self.law is not None:
            return self._evaluated("force", compression)
        pressed = np.maximum(compression, 0.0)
        if self.k == 1.5:  # a root is faster than a power
            return pressed * np.sqrt(pressed)
        return pressed**self.k

    def stiffness(self, compression: Array) -> Array:
        """Return the stiffness ``dF/dδ`` at a compression δ, of any shape."""
        if self.law is not None:
            return self._evaluated("slope", compression)
        return self.k * np.maximum(compression, 0.0) ** (self.k - 1)

    def energy(self, compression: Array) -> Array:
        """Return the elastic energy ``∫ F dδ``, from 0 to the compression."""
        if self.law is not None:
            return self._evaluated("energy", compression)
        return self.force(compression) * compression / (self.k + 1)

    def energy_above(self, rest: Array, change: Array) -> Array:
        """Return the energy of a change of the compression less the work of the static force.

        Parameters
        ----------
        rest, change : array
            Static compressions, and the changes from there, of equal shape.
        """
        energy = self.energy(rest + change) - self.energy(rest)
        energy -= self.force(rest) * change
        small = np.abs(change) <= _SMALL * rest
        if small.any():
            x = change[small]
            r = rest[small]
            # ∫ (x - s) F′(r + s) ds from s = 0 to x is x² ∫ (1 - u) F′(r + u x) du, u = 0 … 1.
            points = r + np.multiply.outer(_NODES, x)
            stiffness = self.stiffness(points)
            weights = _WEIGHTS * (1 - _NODES)
            mean = np.einsum("i,i...", weights, stiffness)
            energy[small] = x * x * mean
        return energy

    def damped(
        self, elastic: Array, damping: Array, compression: Array, rate: Array
    ) -> Array:
        """Return the total forces (contacts, …); damping may not pull unless the contact `sticks`.

        Parameters
        ----------
        elastic : array
            Elastic forces.
        damping : array, (contacts,)
            Factors of ``δ^p dδ/dt``.
        compression, rate : array
            Compressions δ and rates dδ/dt.
        """
        if self.damping_power is None:
            return elastic
        # A law that pulls has k = 1 (`validation.scenes.checks.contact_law`), and so p = 0: the
        # power is 1 where δ < 0, too.
        resisted = np.maximum(compression, 0.0) ** self.damping_power * rate
        force = elastic + (damping * resisted.T).T
        if not self.sticks:
            # Damping may weaken a push to 0, and add nothing to the pull of a law that attracts.
            force = np.maximum(force, np.minimum(elastic, 0.0))
        return force if self.pulls else np.where(compression > 0.0, force, 0.0)

    def _evaluated(self, name: str, compression: Array) -> Array:
        """Evaluate a function of the law: its "force", "slope" or "energy"."""
        assert self.law is not None
        with _refused(self.law):  # beyond a singular law's reach: inf or NaN
            function = _function(self.law, name, "numpy")
            if self.pulls:
                values = function(compression)
                # A constant is a number, whatever the array.
                return np.array(np.broadcast_to(values, compression.shape))
            values = np.zeros(compression.shape)
            closed = compression > 0.0
            values[closed] = function(compression[closed])
            return values

    def compressed_by(self, forces: Array) -> Array:
        """Return static compressions at given forces; `lwa.InputError` for unattainable forces."""
        if self.law is None:
            return forces ** (1 / self.k)
        different, place = np.unique(forces, return_inverse=True)
        found = []
        for force in different:
            # Solved in 40 digits, so that the compression is right to the last digit of a float.
            compression = self.law.inverse(sp.Float(force, 40))
            found.append(float(compression))
        return np.array(found)[place]

    def reached_by(self, energy: float, start: float) -> float:
        """Return a scale of the compression that an energy reaches from ``start``.

        The scale of a power is the compression that the energy reaches from 0, whatever the start.
        `validation.lattice.equations.Motion.scales` takes the greater of this scale and the start.
        """
        if self.law is None:
            # δ^{k+1}/(k+1) = energy, without the factor k + 1, which no scale needs
            return float(energy ** (1 / (self.k + 1)))
        # The first of many places at which the energy is reached, or a pole: 1 % apart, then 3e-6,
        # as the motion near a pole is the faster the nearer it comes.
        low = 1e-15
        high = 1e15
        for _ in range(2):
            change = np.geomspace(low, high, _TRIED)
            work = self.energy_above(np.full(_TRIED, start), change)
            # Not `work >= energy`: beyond a pole the work is NaN, and the energy is reached there.
            reached = ~(work < energy)
            if not reached.any():
                # The greatest work is less: the energy overcomes a barrier, whose top is the scale.
                reached = work == work.max()
            first = int(np.argmax(reached))
            # The top of a barrier, and a pole with a fall behind it, may lie on either side.
            low = change[max(first - 1, 0)]
            high = change[min(first + 1, _TRIED - 1)]
        return float(start + change[first])

    @property
    def addresses(self) -> dict[str, int]:
        """Addresses of the machine code of the force, its slope and the energy; 0 for a power."""
        if self.law is None:
            return dict.fromkeys(_NAMES, 0)
        return {name: f.address for name, f in _machine_code(self.law).items()}


_NAMES = ("force", "slope", "energy")


@lru_cache
def _function(law: ContactLaw, name: str, module: str) -> Callable[..., Any]:
    """Return F, F′ or the energy of a law, as a function that calls "numpy" or "math"."""
    # An energy by SymPy's integral takes seconds, which forces alone need not wait for.
    if name == "force":
        expression = law.F
    elif name == "slope":
        expression = law.slope()
    else:
        at_zero = sp.limit(law.energy, law.delta, 0, "+")
        expression = law.energy - at_zero
    # Exact coefficients become floats. Small compressions keep their digits in e^δ - 1.
    decimal = sp.N(sp.sympify(expression), 20)
    prepared = optimize(decimal, [expm1_opt])
    function: Callable[..., Any] = sp.lambdify(law.delta, prepared, module)
    return function


@lru_cache
def _machine_code(law: ContactLaw) -> dict[str, Any]:
    """Return compiled F, F′ and energy of a law as functions of one float, by name."""
    from numba import cfunc  # start-up

    compiled = cfunc("f8(f8)", error_model="numpy")
    with _refused(law):
        return {name: compiled(_function(law, name, "math")) for name in _NAMES}


@contextmanager
def _refused(law: ContactLaw) -> Iterator[None]:
    """Raise `SceneError` in place of the many errors of SymPy and Numba."""
    try:
        with np.errstate(all="ignore"):
            yield
    except Exception:
        raise SceneError(
            f"law is {shorten(law.text)}: a force with an energy in elementary functions is "
            "wanted"
        ) from None
