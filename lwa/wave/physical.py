"""The compact wave of a given peak force, in space and time.

All contacts of a cell carry the same force at leading order, F = A_eff (D u_x)^k, so that the wave
whose contact force peaks at F has the peak strain B = (F/A_eff)^{1/k} / D and, with V² = f B^{k-1}
(`CompactWave.speed_factor`) and dx/dt = V √(P k A_eff D^{k+1} / M), the speed

    dx/dt = D √(f P k / M) A_eff^{1/(2k)} F^{(k-1)/(2k)}.

A contact's force passes as F cos^{mk}(βξ), m = 2/(k-1), ξ = x - (dx/dt) t. A bead bears the mean of
its two contacts, half a spacing before and behind it: at its peak the share cos^{mk}(βD/2) of F.

Everything is in the units of the cell: in SI for `lwa.Cell.of_spheres`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, number, one_of, positive, power, root, shorten
from lwa.base.frozen import Value
from lwa.base.quantities import known, known_extent, strain_power
from lwa.cell import RESERVED, meant, unmistakable
from lwa.wave.closed import CompactWave

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lwa.base.arrays import Array

BEARERS = ("contact", "bead")
"""Whose force it is."""


@dataclass(frozen=True, eq=False)
class PhysicalWave(Value):
    """The compact wave with a given peak force, or the waves of an array of peak forces.

    Parameters
    ----------
    wave : closed forms of the wave.
    force : peak force, a number, a symbol, or an array of numbers. The answers are exact
        expressions or, for an array, float64 arrays of its shape.
    of : "contact" or "bead", whose force peaks at ``force``.

    Raises `lwa.InputError` unless the force is positive, for a name that already has a meaning in
    the wave, for an array and a chain with symbols, and for the force of a bead in a wave so short
    that its two contacts peak one after the other.

    >>> from lwa import Cell, canonical_wave
    >>> wave = canonical_wave(Cell(["m"], ["A"]), "3/2").at_force("F")
    >>> wave.compression, wave.speed
    (F**(2/3)/A**(2/3), 2*sqrt(5)*A**(1/3)*D*F**(1/6)/(5*sqrt(m)))
    """

    wave: CompactWave
    force: Any
    of: str = "contact"

    def __post_init__(self) -> None:
        one_of(self.of, BEARERS, "of")
        given = self.force
        many = not isinstance(given, str | bytes) and getattr(
            given, "shape", hasattr(given, "__len__")
        )
        object.__setattr__(self, "force", _forces(given) if many else self._exact(given))
        if self.of == "bead":
            self._bead_share  # noqa: B018 - a share that does not exist is refused here
        if many:
            number(self.speed_at(sp.S.One))

    def _exact(self, given: Any) -> sp.Expr:
        """The force as an exact expression, its names checked."""
        force = positive(given, "force")
        unmistakable(list(force.free_symbols))
        chain = (s.name for s in (*self.wave.cell.symbols, *self.wave.k.free_symbols))
        taken = dict.fromkeys(chain, "a property of the chain") | RESERVED
        return meant(force, "force", taken=taken)

    @property
    def _key(self) -> tuple[Any, ...]:
        force = self.force
        known_by = force if isinstance(force, sp.Expr) else (force.shape, force.tobytes())
        return self.wave, known_by, self.of

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PhysicalWave) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    def latex_rows(self) -> list[str]:
        if not isinstance(self.force, sp.Expr):
            return []
        values = {"F": self.contact_force, "B": self.strain, latex.SPEED: self.speed}
        return latex.rows(values)

    # --- the wave's answers -----------------------------------------------------------------

    @cached_property
    def _bead_share(self) -> sp.Expr:
        """cos^{mk}(βD/2), a bead's peak force over its contacts'."""
        wave, k = self.wave, self.wave.k
        angle = (k - 1) / (4 * root(wave.dispersion))  # βD/2
        exponent = 2 * k / (k - 1)
        # At ξ = 0 the mean of cos^e(βξ ± angle) has its maximum only where it is concave.
        if angle.is_number and not (angle < sp.pi / 2 and exponent * sp.sin(angle) ** 2 < 1):
            raise InputError(
                f"k is {shorten(k)}: the two contacts of a bead peak one after the other, so that "
                "its force has no single peak; give that of a contact"
            )
        return sp.cos(angle) ** exponent

    @cached_property
    def contact_force(self) -> Any:
        """The peak force of the contacts."""
        return self.force if self.of == "contact" else self.force / self._like(self._bead_share)

    @cached_property
    def bead_force(self) -> Any:
        """The peak force of a bead, the mean of its two contacts."""
        return self.force if self.of == "bead" else self.force * self._like(self._bead_share)

    @cached_property
    def strain(self) -> Any:
        """B, the peak strain."""
        return self.compression / self._like(self.wave.cell.spacing)

    @cached_property
    def compression(self) -> Any:
        """D B, the peak compression of a contact; for unlike ones their mean (`compressions`)."""
        k = self.wave.k
        return self._scaled(partial(_root, A=self.wave.cell.stiffness(k), k=k), 1 / k)

    @cached_property
    def compressions(self) -> tuple[Any, ...]:
        """(F/A_i)^{1/k}, the peak compression of each contact of the cell."""
        k = self.wave.k
        return tuple(
            self._scaled(partial(_root, A=A, k=k), 1 / k) for A in self.wave.cell.stiffnesses
        )

    @cached_property
    def speed(self) -> Any:
        """dx/dt = V τ/t."""
        k = self.wave.k
        return self._scaled(self.speed_at, (k - 1) / (2 * k))

    def speed_at(self, contact_force: sp.Expr) -> sp.Expr:
        """dx/dt of this chain's wave with another peak contact force, exact."""
        wave, k = self.wave, self.wave.k
        factor = wave.speed_factor * wave.cell.size * k / wave.cell.mass
        powers = power(wave.cell.stiffness(k), 1 / (2 * k))
        return wave.D * root(factor) * powers * power(contact_force, (k - 1) / (2 * k))

    @cached_property
    def bead_velocity(self) -> Any:
        """B dx/dt, the peak velocity u_t of the beads; in this theory all of a cell move alike."""
        return self.strain * self.speed

    @cached_property
    def momentum(self) -> Any:
        """Σ m u_t over the chain: M/(P D) · B dx/dt · ∫ cos^m(βξ) dξ."""
        return self._like(self._density * self._arch(self.wave.m)) * self.bead_velocity

    @cached_property
    def energy(self) -> Any:
        """Kinetic and elastic energy of the chain, (k + 3)/(k + 1) times the kinetic energy.

        That is the virial theorem, which holds for the lattice's waves and for the canonical
        field's. The kinetic energy is M/(2 P D) · (B dx/dt)² · ∫ cos^{2m}(βξ) dξ.
        """
        k = self.wave.k
        kinetic = self._like(self._density * self._arch(2 * self.wave.m)) / 2
        return self._like((k + 3) / (k + 1)) * kinetic * self.bead_velocity**2

    @cached_property
    def effective_mass(self) -> sp.Expr:
        """P²/(2E) of momentum and energy, which does not depend on the force.

        >>> from lwa import Cell, canonical_wave
        >>> round(canonical_wave(Cell([1]), "3/2").at_force(1).effective_mass.n(), 4)
        1.4192
        """
        k, m = self.wave.k, self.wave.m
        return (k + 1) / (k + 3) * self._density * self._arch(m) ** 2 / self._arch(2 * m)

    @property
    def _density(self) -> sp.Expr:
        """Mass per length."""
        return self.wave.cell.mass / (self.wave.cell.size * self.wave.D)

    def _arch(self, n: sp.Expr) -> sp.Expr:
        """∫ cos^n(βξ) dξ over the wave."""
        return sp.sqrt(sp.pi) * sp.gamma((n + 1) / 2) / (self.wave.beta * sp.gamma(n / 2 + 1))

    def fwhm(self, quantity: str = "force", extent: str = "length") -> Any:
        """Full width at half maximum of "strain", "force" or "velocity", a "length" or a "time".

        The force is that of a contact. Raises `lwa.InputError` for any other.
        """
        known_extent(extent)
        length = self._scaled(lambda _: self.wave.fwhm(quantity), sp.S.Zero)
        return length if extent == "length" else length / self.speed

    def _scaled(self, formula: Callable[[sp.Expr], sp.Expr], exponent: sp.Expr) -> Any:
        """A quantity that scales as the contact force to this exponent, by its exact formula."""
        if isinstance(self.force, sp.Expr):
            return formula(self.contact_force)
        return number(formula(sp.S.One)) * self.contact_force ** number(exponent)

    def _like(self, value: sp.Expr) -> Any:
        """An exact value, or its float beside an array of forces."""
        return value if isinstance(self.force, sp.Expr) else number(value)

    # --- curves -----------------------------------------------------------------------------

    def curve(self, t: ArrayLike, quantity: str = "force", of: str = "") -> Array:
        """A quantity at the times t, float64: "force", "strain" or "velocity"; its peak is at 0.

        ``of`` names a "contact" or a "bead", by default the bearer of the peak force. A bead's
        force and strain are the mean of its two contacts', and velocities are those of beads.

        Raises `lwa.InputError` for any other, and unless all is in numbers.

        >>> from lwa import Cell, canonical_wave
        >>> canonical_wave(Cell([1], spacing=1), "3/2").at_force(8).curve([-99, 0, 99])
        array([0., 8., 0.])
        """
        from lwa.base.arrays import finite  # start-up: it loads NumPy

        return self._along(-number(self.speed) * finite(t, "t"), quantity, of)

    def along(self, x: ArrayLike, quantity: str = "force", of: str = "") -> Array:
        """A quantity at the places x at one time, as `curve` at the times; its peak is at 0."""
        from lwa.base.arrays import finite  # start-up: it loads NumPy

        return self._along(finite(x, "x"), quantity, of)

    def _along(self, xi: Array, quantity: str, of: str) -> Array:
        import numpy as np  # start-up: `lwa wave` does without

        wave, k = self.wave, number(self.wave.k)
        peak = {
            "strain": self.strain,
            "force": self.contact_force,
            "velocity": self.bead_velocity,
        }[known(quantity)]
        beta, exponent = number(wave.beta), 2 * strain_power(quantity, k) / (k - 1)

        def arch(x: Array) -> Array:
            y = beta * x
            return np.asarray(np.where(np.abs(y) < np.pi / 2, np.cos(y), 0.0) ** exponent)

        if one_of(of or self.of, BEARERS, "of") == "bead" and quantity != "velocity":
            half = number(wave.D) / 2
            return np.asarray(number(peak) * (arch(xi - half) + arch(xi + half)) / 2)
        return np.asarray(number(peak) * arch(xi))

    def plot(self, ax: Any = None, units: tuple[str, str] = ("", "")) -> Any:
        """Draw the force of a contact and of a bead over time on ``ax`` or a new figure.

        units : of time and force, "s" and "N" for a cell in SI. Returns the axes.
        """
        import numpy as np  # start-up: `lwa wave` does without

        from lwa.wave.plots import draw  # start-up: it loads NumPy

        half = number(self.fwhm("force", "time"))
        t = np.linspace(-2 * half, 2 * half, 501)
        names = (
            f"{n} ({unit})" if unit else n for n, unit in zip(("t", "force"), units, strict=True)
        )
        return draw(ax, t, {of: self.curve(t, of=of) for of in BEARERS}, *names)

    def at(self, **values: Any) -> PhysicalWave:
        """Substitute numbers (or other symbols) for the named symbols.

        Symbols of the force are taken too. Raises the errors of `lwa.TravelingWave.at`.
        """
        known = {s.name: s for s in getattr(self.force, "free_symbols", ())}
        new = {known[n]: positive(value, n) for n, value in values.items() if n in known}
        rest = {name: value for name, value in values.items() if name not in known}
        force = self.force.xreplace(new) if new else self.force
        return PhysicalWave(self.wave.at(**rest), force, self.of)


def _root(F: sp.Expr, A: sp.Expr, k: sp.Expr) -> sp.Expr:
    """(F/A)^{1/k}, the compression at which a contact pushes with F."""
    return power(F / A, 1 / k)


def _forces(values: Sequence[Any] | Array) -> Array:
    """An array of positive forces that nobody can change."""
    from lwa.base.arrays import finite  # start-up: it loads NumPy

    array = finite(values, "force").copy()
    if not (array > 0).all():
        raise InputError(f"force is {array.min()}: it must be positive")
    array.setflags(write=False)
    return array
