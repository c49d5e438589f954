"""Contact laws in numbers: force, stiffness and energy of a contact of unit stiffness.

A law with F′(0) > 0 also pulls: Toda's, Fermi, Pasta, Ulam and Tsingou's, magnets. Any other law
opens where δ < 0, as a power does.
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

from lwa import Cell
from lwa.base.arrays import Array
from lwa.base.exact import shorten
from lwa.law import ContactLaw
from validation.scenes.checks import SceneError


@dataclass(frozen=True)
class Contact:
    """The force F(δ) of a contact of unit stiffness, for a `ContactLaw` or for the power δ^k.

    damping_power : exponent p of the damping force ~ δ^p dδ/dt; None without damping.
    """

    k: float
    law: ContactLaw | None = None
    damping_power: float | None = None

    @cached_property
    def pulls(self) -> bool:
        """True if the contact holds, and pulls, where δ < 0."""
        return self.law is not None and bool(self.law.at(sp.S.Zero, 1).is_positive)

    def force(self, compression: Array) -> Array:
        """Return the force F at a compression δ, of any shape; [δ]_+^k for a power law."""
        if self.law is not None:
            return self._evaluated(0, compression)
        pressed = np.maximum(compression, 0.0)
        return np.asarray(
            pressed * np.sqrt(pressed) if self.k == 1.5 else pressed**self.k
        )

    def stiffness(self, compression: Array) -> Array:
        """Return the stiffness F′ = dF/dδ at a compression δ, of any shape."""
        if self.law is not None:
            return self._evaluated(1, compression)
        return np.asarray(self.k * np.maximum(compression, 0.0) ** (self.k - 1))

    def energy(self, compression: Array) -> Array:
        """Return the elastic energy ∫ F dδ, from 0 to the compression."""
        if self.law is not None:
            return self._evaluated(2, compression)
        return np.asarray(self.force(compression) * compression / (self.k + 1))

    def damped(
        self, elastic: Array, damping: Array, compression: Array, rate: Array
    ) -> Array:
        """Return the total forces (contacts, …); damping : coefficients, rate : dδ/dt."""
        if self.damping_power is None:
            return elastic
        closed = compression if self.pulls else np.maximum(compression, 0.0)
        force = np.asarray(
            elastic + (damping * (closed**self.damping_power * rate).T).T
        )
        return (
            force
            if self.pulls
            else np.where(compression > 0.0, np.maximum(force, 0.0), 0.0)
        )

    def _evaluated(self, order: int, compression: Array) -> Array:
        function = _functions(self.law)[order]
        closed = compression if self.pulls else np.maximum(compression, 0.0)
        with np.errstate(all="ignore"):  # beyond a singular law's reach: inf or NaN
            values = np.broadcast_to(function(closed), compression.shape)
        return np.asarray(
            values if self.pulls else np.where(compression > 0, values, 0.0)
        )

    def compressed_by(self, forces: Array) -> Array:
        """Return static compressions at given forces; `lwa.InputError` for unattainable forces."""
        if self.law is None:
            return np.asarray(forces ** (1 / self.k))
        different, place = np.unique(forces, return_inverse=True)
        law, cell = self.law, Cell((1,))
        return np.array(
            [float(law.compression(cell, sp.Float(F, 40))) for F in different]
        )[place]

    def reached_by(self, energy: float, start: float) -> float:
        """Return a scale of the compression that an energy reaches from ``start``."""
        if self.law is None:
            return float(
                np.float64(energy) ** (1 / (self.k + 1))
            )  # of δ^{k+1}/(k+1) = energy

        # The first of many places at which the energy is reached, or a pole; else a barrier.
        d = start + np.geomspace(1e-15, 1e15, 7000)
        at_start = np.array(start)
        work = (
            self.energy(d) - self.energy(at_start) - self.force(at_start) * (d - start)
        )
        reached = np.flatnonzero(~(work < energy))
        return float(d[reached[0] if len(reached) else np.argmax(work)])

    @property
    def addresses(self) -> dict[str, int]:
        """Addresses of the machine code of F, F′ and the energy by name; 0 for a power."""
        code = (
            [0, 0, 0]
            if self.law is None
            else [f.address for f in _machine_code(self.law)]
        )
        return dict(zip(("force", "slope", "energy"), code, strict=True))


def _expressions(law: ContactLaw) -> tuple[sp.Expr, ...]:
    """Return F, F′ and the energy, with float coefficients and e^x - 1 as expm1(x)."""
    energy = law.energy
    at_rest = sp.limit(energy, law.delta, 0, "+")
    rows = law.F, law.slope(), energy - at_rest
    return tuple(optimize(sp.N(sp.sympify(row), 20), [expm1_opt]) for row in rows)


@lru_cache
def _functions(law: ContactLaw | None) -> tuple[Callable[[Array], Any], ...]:
    """Return F, F′ and the energy of a law as functions of arrays."""
    assert law is not None
    with _evaluated(law):
        functions = tuple(
            sp.lambdify(law.delta, row, "numpy") for row in _expressions(law)
        )
        for function in functions:
            function(np.ones(2))
        return functions


@lru_cache
def _machine_code(law: ContactLaw) -> tuple[Any, ...]:
    """Return compiled F, F′ and energy of a law as functions of one float."""
    from numba import cfunc  # start-up

    with _evaluated(law):
        rows = [sp.lambdify(law.delta, row, "math") for row in _expressions(law)]
        return tuple(cfunc("f8(f8)", error_model="numpy")(row) for row in rows)


@contextmanager
def _evaluated(law: ContactLaw) -> Iterator[None]:
    """Raise `SceneError` in place of the many errors of SymPy and Numba."""
    try:
        with np.errstate(all="ignore"):
            yield
    except Exception:
        text = "a force with an energy in elementary functions is wanted"
        raise SceneError(f"law is {shorten(law.text)}: {text}") from None
