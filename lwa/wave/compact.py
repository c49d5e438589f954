"""The compact traveling wave of the wave equation at the first order of dispersion, in closed form.

The equation, at ``D^{k+3}``, is::

    u_ττ = u_x^{k-1} u_xx + G u_x^{k-3} u_xx³ + H u_x^{k-2} u_xx u_xxx + I u_x^{k-1} u_4x.

With ``ξ = x - V τ`` the strain ``v = u_ξ`` obeys a third-order equation, whose compact wave is
``v = B cos^m(βξ)`` on ``|ξ| ≤ π/(2β)``, ``m = 2/(k-1)`` (Porter et al. 2008; `lwa.wave.reduction`),
with::

    β = (k-1) / (2 √(G+H+I)),    V² = B^{k-1} (1 - β² [(H + 3I) m - 2I]).

The wave needs ``G + H + I > 0`` and ``V² > 0``.

In space and time. All contacts of a cell carry the same force at leading order. Without load
``F = A_eff (D u_x)^k``, so that the wave whose contact force peaks at F has the peak strain
``B = (F/A_eff)^{1/k} / D``. A contact has the force ``F cos^{mk}(βξ)``. A bead bears the mean force
of its two contacts, half a spacing before and behind the bead, which peaks at
``F cos^{mk}(βD/2)``. Results are in the units of the cell: in SI for `lwa.Cell.of_spheres`. Waves
under a load are those of `lwa.loaded.wave`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, Self, get_args, overload

import sympy as sp

from lwa.base import latex
from lwa.base.exact import (
    InputError,
    brief,
    factored,
    integer,
    number,
    positive,
    power,
    read_exact,
    shorten,
    signed,
)
from lwa.base.frozen import (
    RISE,
    SPEED,
    NoSolitaryWave,
    Value,
    known_extent,
    known_quantity,
    strain_power,
)
from lwa.base.words import ExtentName, LanguageName, QuantityName, one_of
from lwa.cell import Cell, exponent, read_cell, substitution
from lwa.cell import k as symbol_k
from lwa.law import ContactLaw, Power, for_cell
from lwa.linear.dispersion import Dispersion
from lwa.wave.reduction import Reduction, roots, square_root

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lwa.base.arrays import Array
    from lwa.loaded.wave import LoadedWave
    from lwa.wave.numeric import Missing, NumericWave

BearerName = Literal["contact", "bead"]
"""A bearer of a peak force."""

BEARERS: tuple[BearerName, ...] = get_args(BearerName)


@dataclass(frozen=True, repr=False)
class CompactWave(Value):
    """Closed forms of the compact wave ``v = u_x = B cos^m(βξ)``, ``ξ = x - V τ``.

    Results are exact SymPy expressions; the speed ``V = dx/dτ`` becomes dx/dt by `time_scale`.

    Parameters
    ----------
    cell : Cell
        The chain.
    k : Expr
        Exponent of its contact law.
    G, H, I : Expr
        Coefficients of the wave equation, D² included.

    Raises
    ------
    NoSolitaryWave
        For numbers without a wave: ``k ≤ 1``, ``G + H + I ≤ 0``, or ``V² ≤ 0``.
    """

    cell: Cell
    k: sp.Expr
    G: sp.Expr
    H: sp.Expr
    I: sp.Expr

    def __post_init__(self) -> None:
        # With symbols every condition is taken to hold.
        if self.k.is_number and not self.k > 1:
            raise NoSolitaryWave(f"k is {self.k}: a compact wave needs k > 1")
        if self.coefficient_sum.is_number and not self.coefficient_sum > 0:
            raise NoSolitaryWave(
                f"(G+H+I)/D² is {self.coefficient_sum}: a compact wave needs G+H+I > 0"
            )
        if self.speed_factor.is_number and not self.speed_factor > 0:
            raise NoSolitaryWave(
                f"V²/B^(k-1) is {self.speed_factor}: a compact wave needs V² > 0"
            )

    def __repr__(self) -> str:
        return f"CompactWave({self.cell!r}, k={self.k}, β={shorten(self.beta)})"

    def latex_rows(self) -> list[str]:
        arch = rf"\cos^{{{latex.expression(self.m)}}}(\beta \xi)"
        return [
            rf"v = u_{{x}} = B {arch}, \quad |\xi| \leq \frac{{\pi}}{{2\beta}}",
            latex.row(r"\beta", self.beta),
            latex.row(r"\frac{\pi}{\beta}", self.width),
            latex.row(latex.fwhm("strain"), self.fwhm("strain")),
            latex.row(latex.fwhm("force"), self.fwhm("force")),
            latex.row("V_{s}", self.speed()),
        ]

    @property
    def D(self) -> sp.Expr:
        """The spacing D of neighbouring particles."""
        return self.cell.spacing

    @cached_property
    def _ratios(self) -> tuple[sp.Expr, sp.Expr]:
        """The ratios G/I and H/I, which in the canonical field depend on k alone."""
        return factored(self.G / self.I), factored(self.H / self.I)

    @cached_property
    def coefficient_sum(self) -> sp.Expr:
        """The sum (G + H + I) / D²."""
        g, h = self._ratios
        if (g + h).free_symbols <= self.k.free_symbols:  # I stays a factor
            return self.I / self.D**2 * factored(1 + g + h)
        return factored((self.G + self.H + self.I) / self.D**2)

    @property
    def m(self) -> sp.Expr:
        """The power ``m = 2/(k-1)`` of the cosine in the strain."""
        return 2 / (self.k - 1)

    @cached_property
    def beta(self) -> sp.Expr:
        """The wavenumber ``β = (k-1) / (2 √(G+H+I))`` of the cosine."""
        return (self.k - 1) / (2 * self.D * square_root(self.coefficient_sum))

    @cached_property
    def width(self) -> sp.Expr:
        """The length π/β of the wave's support."""
        return sp.pi / self.beta

    @property
    def sites(self) -> sp.Expr:
        """The number π/(βD) of particles under the wave."""
        return self.width / self.D

    def fwhm(self, quantity: QuantityName = "strain") -> sp.Expr:
        """Full width at half maximum, a length in x.

        Parameters
        ----------
        quantity : {"strain", "force", "velocity"}
            The strain u_x, the force ``A (D u_x)^k`` of a contact, or the velocity
            ``u_τ = -V u_x``.

        Raises
        ------
        InputError
            For another quantity.
        """
        # The quantity scales as strain^q: cos^{mq}(βξ) = 1/2.
        exponent = strain_power(quantity, self.k) * self.m
        return 2 * sp.acos(2 ** (-1 / exponent)) / self.beta

    @cached_property
    def speed_factor(self) -> sp.Expr:
        """The ratio ``V²/B^{k-1} = 1 - β² [(H + 3I) m - 2I]``."""
        # With β² = (k-1)²/(4 I (1+g+h)) and m = 2/(k-1) written out k - 1 cancels.
        k = self.k
        g, h = self._ratios
        return factored(1 - (k - 1) * (h + 4 - k) / (2 * (1 + g + h)))

    def speed(self, B: Any = RISE) -> sp.Expr:
        """Speed ``V = dx/dτ`` of the wave whose strain peaks at B."""
        factor = square_root(self.speed_factor)
        growth = power(positive(B, "B"), (self.k - 1) / 2)
        return factor * growth

    def amplitude(self, V: Any = SPEED) -> sp.Expr:
        """Peak strain ``B = (V² / speed_factor)^{1/(k-1)}`` of the wave of speed ``V = dx/dτ``."""
        scaled = positive(V, "V") ** 2 / self.speed_factor  # B^{k-1}
        return power(scaled, 1 / (self.k - 1))

    @property
    def force_exponent(self) -> sp.Expr:
        """The power 2k/(k-1) of V to which the peak force F_m is proportional."""
        return 2 * self.k / (self.k - 1)

    @property
    def time_scale(self) -> sp.Expr:
        """The ratio τ/t, by which ``dx/dt = V τ/t``."""
        return self.cell.time_scale(self.k)

    def profile(self, xi: Any, B: Any = RISE) -> sp.Expr:
        """Strain ``v(ξ) = B cos^m(βξ)`` on ``|ξ| ≤ π/(2β)`` and 0 outside, as a SymPy Piecewise.

        >>> canonical_wave(Cell([1]), 3).profile("xi", B=1)
        Piecewise((cos(sqrt(2)*xi/D), Abs(xi) <= sqrt(2)*pi*D/4), (0, True))
        """
        xi = signed(xi, "xi")
        arch = positive(B, "B") * sp.cos(self.beta * xi) ** self.m
        return sp.Piecewise((arch, sp.Abs(xi) <= self.width / 2), (0, True))

    @cached_property
    def roots(self) -> tuple[sp.Expr, sp.Expr]:
        """The two p for which ``v = z^p`` removes ``z_ξ³``; the paper's is the first."""
        total = self.coefficient_sum * self.D**2 / self.I  # 1 + G/I + H/I
        return roots(total, self._ratios[1])

    def reduction(self, root: int = 0, V: Any = SPEED) -> Reduction:
        """Reduction to ``z'' = μ z^η - σ z`` for one of the `roots` p.

        Parameters
        ----------
        root : {0, 1}
            Index of the root; the paper has the first.
        V : number or str
            Speed dx/dτ of the wave.
        """
        p = self.roots[integer(root, "root", 0, 1)]
        return Reduction.of(p, self.k, self.I, self._ratios[1], positive(V, "V"))

    def at(self, **values: Any) -> Self:
        """Substitute numbers (or other symbols) for the named symbols, and for ``ω = m2/m1``.

        Raises
        ------
        InputError
            For a name that the wave does not contain, and a value that is not positive.
        NoSolitaryWave
            For values without a wave.

        Examples
        --------
        >>> canonical_wave(Cell(["m1", "m2"]), "k").at(k="3/2", omega=1).beta
        sqrt(10)/(5*D)
        """
        return self._replaced(substitution(values, self.cell, self.k))

    def _replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> Self:
        """The wave with other values of symbols."""
        return replace(
            self,
            cell=self.cell.replaced(new),
            k=exponent(self.k.xreplace(new)),
            G=self.G.xreplace(new),
            H=self.H.xreplace(new),
            I=self.I.xreplace(new),
        )

    @overload
    def at_force(self, F: Any = "F", of: BearerName = "contact") -> PhysicalWave: ...

    @overload
    def at_force(
        self, F: Any = "F", of: BearerName = "contact", *, precompression: Any
    ) -> PhysicalWave | LoadedWave: ...

    def at_force(
        self, F: Any = "F", of: BearerName = "contact", *, precompression: Any = 0
    ) -> PhysicalWave | LoadedWave:
        """The wave of a given peak force: a `PhysicalWave`, or under load a `LoadedWave`.

        Parameters
        ----------
        F : number or str
            The peak force, or its name; under load the total force, static and dynamic.
        of : {"contact", "bead"}
            The bearer of this force; under load a contact.
        precompression : number or str
            Static load. This wave must then be the canonical field's, as in `on_background`.

        Examples
        --------
        A formula of the symbol F takes arrays once it is compiled:

        >>> speed = canonical_wave(Cell([1], spacing=1), "3/2").at_force("F").speed
        >>> import numpy as np
        >>> sp.lambdify("F", speed)(np.array([1.0, 64.0])).round(8)
        array([0.89442719, 1.78885438])
        """
        load = read_exact(precompression, "precompression")
        if load.is_zero:
            return PhysicalWave(self, F, of)
        if one_of(of, BEARERS, "of") != "contact":
            raise InputError(
                f"of is {shorten(of)}: under a load it is the force of a contact"
            )
        return self._loaded(force=F, precompression=load)

    def on_background(self, p0: Any = "p0", rise: Any = None) -> LoadedWave:
        """The wave of this chain whose strain rises from p0 by ``rise``, by default a symbol B.

        Raises
        ------
        InputError
            For the wave of another field than the canonical one, whose equation has no energy.
        """
        return self._loaded(background=p0, rise=rise)

    def _loaded(self, **states: Any) -> LoadedWave:
        """The wave between two static states, of the canonical field alone."""
        from lwa.loaded.wave import loaded_wave  # start-up: it loads NumPy

        canonical = canonical_wave(self.cell, self.k)
        # Equal coefficients may be written in different ways.
        for name in ("G", "H", "I"):
            difference = getattr(self, name) - getattr(canonical, name)
            if sp.cancel(difference) != 0:
                raise InputError(
                    "waves on a background are those of the canonical field, which conserves "
                    "momentum and energy; canonical_wave(cell, k) is such a wave",
                    closure="full",
                    field="center",
                )
        return loaded_wave(self.cell, k=self.k, **states)

    def numeric(self, missing: Missing = "raise") -> NumericWave:
        """Vectorised float64 functions of (k, ω), ``ω = m2/m1``.

        Parameters
        ----------
        missing : {"raise", "nan"}
            What is done where there is no wave; see `lwa.wave.numeric.NumericWave`.

        Raises
        ------
        InputError
            Unless k is a symbol and the masses are two symbols, as in N:1 dimers.
        """
        from lwa.wave.numeric import NumericWave  # start-up: it loads NumPy

        return NumericWave(
            self.k, self.cell.masses, self.coefficient_sum, self.speed_factor, missing
        )

    def code(self, language: LanguageName) -> str:
        """Source text of a program: β, widths, speed, amplitude and profile as functions.

        Arguments and accuracy of the functions are those of `lwa.wave.source`.

        Parameters
        ----------
        language : {"numpy", "c", "javascript"}
            A key of `lwa.wave.source.LANGUAGES`.

        Raises
        ------
        InputError
            For another language, and for symbols that are no names of variables.
        """
        from lwa.wave.source import TITLE, module, wave_functions  # start-up

        functions = wave_functions(
            self.k, self.cell, self.coefficient_sum, self.speed_factor
        )
        return module([*functions.values()], language, TITLE)


def canonical_wave(
    cell: Cell, k: Any = symbol_k, *, law: ContactLaw | None = None
) -> CompactWave:
    """The wave of the canonical field of any cell, from the linear chain's dispersion alone.

    With ``Ω² = κ² (1 - (I/D²) κ² + …)`` the equation of the canonical field has
    ``G = I (k-1)(k-2)/2`` and ``H = 2I (k-1)`` for every cell (theorem, see `lwa.equation.energy`),
    hence ``β = (k-1)/√(2I k(k+1))`` and ``V² = 2 B^{k-1}/(k(k+1))``. The wave is that of
    ``homogenize(cell, closure="full", field="center").pde.traveling_wave()``.

    Parameters
    ----------
    cell : Cell
        The chain.
    k : number or str
        Exponent of the contact law.
    law : Power, optional
        The contact law in place of its exponent.

    Raises
    ------
    InputError
        For a law that is no power.

    Examples
    --------
    >>> canonical_wave(Cell((1, 1)), "3/2").beta
    sqrt(10)/(5*D)
    """
    if law is not None:
        law = for_cell(law, cell, k)
        if not law.homogeneous:
            raise InputError(
                f"law is {law.text}: the compact wave is that of a power law; waves of any law are "
                "those of `lwa.loaded_wave`"
            )
        k = law.exponent
    read_cell(cell)
    k = exponent(k)
    # Masses and contacts enter by I alone.
    I = Dispersion(cell, k).I
    G = I * (k - 1) * (k - 2) / 2
    H = 2 * I * (k - 1)
    return CompactWave(cell=cell, k=k, G=G, H=H, I=I)


@dataclass(frozen=True, repr=False)
class PhysicalWave(Value):
    """The compact wave of a given peak force in a chain without load, in the units of the cell.

    Parameters
    ----------
    wave : CompactWave
        Closed forms of the wave.
    force : number or str
        Peak force.
    of : {"contact", "bead"}
        The bearer of this force.

    Raises
    ------
    InputError
        Unless the force is positive, and for the force of a bead whose two contacts peak one after
        the other.

    Examples
    --------
    >>> wave = canonical_wave(Cell(["m"], ["A"]), "3/2").at_force("F")
    >>> wave.compression, wave.speed
    (F**(2/3)/A**(2/3), 2*sqrt(5)*A**(1/3)*D*F**(1/6)/(5*sqrt(m)))
    >>> canonical_wave(Cell([1], spacing=1), "3/2").at_force(64)
    PhysicalWave(F=64, dx/dt=1.78885, FWHM of the force 1.49094)
    """

    wave: CompactWave
    force: sp.Expr
    of: BearerName = "contact"

    def __post_init__(self) -> None:
        object.__setattr__(self, "force", positive(self.force, "force"))
        if one_of(self.of, BEARERS, "of") == "bead":
            self._bead_share  # noqa: B018 - a share that does not exist is refused here

    def __repr__(self) -> str:
        return (
            f"PhysicalWave(F={brief(self.force)}, dx/dt={brief(self.speed)}, "
            f"FWHM of the force {brief(self.fwhm())})"
        )

    def latex_rows(self) -> list[str]:
        rows = {
            "F": self.contact_force,
            "B": self.strain,
            latex.SPEED: self.speed,
            latex.fwhm("force"): self.fwhm("force"),
        }
        return latex.rows(rows)

    @cached_property
    def _bead_share(self) -> sp.Expr:
        """Ratio cos^{mk}(βD/2) of a bead's peak force to its contacts'."""
        k = self.wave.k
        # From the sum itself, not from β, in which roots were taken out
        angle = (k - 1) / (4 * sp.sqrt(self.wave.coefficient_sum))  # βD/2
        exponent = 2 * k / (k - 1)
        # At ξ = 0 the mean of cos^e(βξ ± angle) has its maximum only where it is concave.
        if angle.is_number and not (
            angle < sp.pi / 2 and exponent * sp.sin(angle) ** 2 < 1
        ):
            raise InputError(
                f"k is {shorten(k)}: the two contacts of a bead peak one after the other, so that "
                "its force has no single peak; give that of a contact"
            )
        return sp.cos(angle) ** exponent

    @cached_property
    def contact_force(self) -> sp.Expr:
        """The peak force of the contacts."""
        return self.force if self.of == "contact" else self.force / self._bead_share

    @cached_property
    def bead_force(self) -> sp.Expr:
        """The peak force of a bead, the mean force of its two contacts."""
        return self.force if self.of == "bead" else self.force * self._bead_share

    @cached_property
    def strain(self) -> sp.Expr:
        """The peak strain B."""
        return self.compression / self.wave.D

    @cached_property
    def compression(self) -> sp.Expr:
        """The peak compression D B of a contact; the mean over unlike contacts."""
        return Power(self.wave.k).compression(self.wave.cell, self.contact_force)

    @cached_property
    def speed(self) -> sp.Expr:
        """The speed ``dx/dt = D √(f P k / M) A_eff^{1/(2k)} F^{(k-1)/(2k)}``, ``f = V²/B^{k-1}``.

        The cell has P beads, the mass M and the mean stiffness A_eff; F is the peak contact force.
        """
        # V² = f B^{k-1} times (τ/t)² = P k A_eff D^{k+1} / M, powers of each quantity collected
        cell = self.wave.cell
        k = self.wave.k
        rate = power(self.wave.speed_factor * cell.size * k / cell.mass, sp.S.Half)
        hardness = power(cell.stiffness(k), 1 / (2 * k))
        growth = power(self.contact_force, (k - 1) / (2 * k))
        return cell.spacing * rate * hardness * growth

    @cached_property
    def bead_velocity(self) -> sp.Expr:
        """The peak velocity ``u_t = B dx/dt`` of the beads, the same for all beads of a cell."""
        return self.strain * self.speed

    @cached_property
    def momentum(self) -> sp.Expr:
        """The momentum ``Σ m u_t = M/(P D) · B dx/dt · ∫ cos^m(βξ) dξ`` of the chain."""
        cell = self.wave.cell
        m = self.wave.m
        density = cell.mass / (cell.size * cell.spacing)
        # ∫ cos^m y dy over |y| < π/2 = √π Γ((m+1)/2) / Γ(m/2 + 1)
        arch = sp.sqrt(sp.pi) * sp.gamma((m + 1) / 2) / sp.gamma(m / 2 + 1)
        return density * arch / self.wave.beta * self.bead_velocity

    def fwhm(
        self, quantity: QuantityName = "force", extent: ExtentName = "length"
    ) -> sp.Expr:
        """Full width at half maximum.

        Parameters
        ----------
        quantity : {"strain", "force", "velocity"}
            The quantity, "force" that of a contact.
        extent : {"length", "time"}
            A length, or the time of passage.

        Raises
        ------
        InputError
            For other words.
        """
        length = self.wave.fwhm(quantity)
        if known_extent(extent) == "length":
            return length
        return length / self.speed

    def curve(
        self,
        t: ArrayLike,
        quantity: QuantityName = "force",
        of: BearerName | None = None,
    ) -> Array:
        """Course in time: values at the times t, with the peak at ``t = 0``.

        Parameters
        ----------
        t : array_like
            Times.
        quantity : {"force", "strain", "velocity"}
            The quantity; a velocity is always a bead's.
        of : {"contact", "bead"}, optional
            The bearer of force or strain, by default that of the given force. A bead's are the
            means over its two contacts.

        Raises
        ------
        InputError
            For other words, and where the wave or its force holds symbols.

        Examples
        --------
        >>> canonical_wave(Cell([1], spacing=1), "3/2").at_force(8).curve([-99, 0, 99])
        array([0., 8., 0.])
        """
        from lwa.base.arrays import finite  # start-up: it loads NumPy

        return self.along(-number(self.speed) * finite(t, "t"), quantity, of)

    def along(
        self,
        x: ArrayLike,
        quantity: QuantityName = "force",
        of: BearerName | None = None,
    ) -> Array:
        """Profile in space: values at the positions x when the peak is at 0; see `curve`."""
        import numpy as np  # start-up: `lwa wave` does without

        from lwa.base.arrays import finite

        peaks = {
            "strain": self.strain,
            "force": self.contact_force,
            "velocity": self.bead_velocity,
        }
        peak = number(peaks[known_quantity(quantity)])
        bearer = one_of(self.of if of is None else of, BEARERS, "of")
        xi = finite(x, "x")
        # The strain is B cos^m(βξ), m = 2/(k-1); the force scales as strain^k.
        k = number(self.wave.k)
        beta = number(self.wave.beta)
        exponent = 2 * strain_power(quantity, k) / (k - 1)

        def arch(x: Array) -> Array:
            phase = beta * x
            inside = np.abs(phase) < np.pi / 2
            # The cosine of a phase outside is negative: its power would be NaN.
            cosine = np.where(inside, np.cos(phase), 0.0)
            return np.asarray(cosine**exponent)

        # Strain and force are those of contacts; a bead has a velocity of its own.
        if bearer == "bead" and quantity != "velocity":
            half = number(self.wave.D) / 2
            return np.asarray(peak * (arch(xi - half) + arch(xi + half)) / 2)
        return np.asarray(peak * arch(xi))

    def at(self, **values: Any) -> PhysicalWave:
        """Substitute values for symbols of the wave and of the force, as `CompactWave.at`."""
        # Symbols that the force has besides those of the wave
        own = {*self.wave.cell.symbols, *self.wave.k.free_symbols}
        more = sorted(self.force.free_symbols - own, key=str)
        new = substitution(values, self.wave.cell, self.wave.k, more)
        return PhysicalWave(self.wave._replaced(new), self.force.xreplace(new), self.of)
