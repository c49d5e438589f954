"""Traveling waves of the wave equation at D^{k+3}, in closed form.

    u_ττ = u_x^{k-1} u_xx + G u_x^{k-3} u_xx³ + H u_x^{k-2} u_xx u_xxx + I u_x^{k-1} u_4x.

With ξ = x - V τ the strain v = u_ξ obeys a third-order equation. The substitution v = z^p with

    (G + H + I) p² - (H + 3I) p + 2I = 0

removes z_ξ³, the integrating factor z^a makes the rest a total derivative, and what remains is
z'' = μ z^η - σ z (Porter et al. 2008). Its compact wave is v = B cos^m(βξ) on |ξ| ≤ π/(2β),
m = 2/(k-1). Either root p leads to the same

    β = (k-1) / (2 √(G+H+I)),    V² = B^{k-1} (1 - β² [(H + 3I) m - 2I]),

so that p may even be complex; what a wave needs is G + H + I > 0 and V² > 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, overload

import sympy as sp

from lwa.algebra.rational import factored
from lwa.base import latex
from lwa.base.exact import InputError, exact, positive, power, real, root, shorten
from lwa.base.frozen import Value
from lwa.base.quantities import NoSolitaryWave, strain_power
from lwa.cell import Cell, exponent, substitution
from lwa.cell import k as symbol_k
from lwa.law import Power
from lwa.linear.dispersion import Dispersion
from lwa.wave.background import BackgroundWave
from lwa.wave.physical import PhysicalWave
from lwa.wave.precompressed import PrecompressedWave
from lwa.wave.reduction import Reduction, strain_equation

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from lwa.base.arrays import Array
    from lwa.wave.curves import PhysicalWaves
    from lwa.wave.numeric import NumericWave

V = sp.Symbol("V_s", positive=True)
"""The speed V_s = dx/dτ, where the caller gives none."""

_SHARES = sp.symbols("g h", cls=sp.Dummy)
"""For G/I and H/I, in the algebra of the strain's equation."""


@dataclass(frozen=True, repr=False)
class TravelingWave(Value):
    """The compact traveling wave v = u_x = B cos^m(βξ), ξ = x - V τ.

    G, H, I are the wave equation's coefficients with their D²; the results are exact SymPy
    expressions. Lengths are in the unit of the spacing D; B is the peak of the strain u_x, and the
    speed V = dx/dτ becomes dx/dt by `speed_scale`.

    Raises `NoSolitaryWave` when it is built with numbers for which there is none (k ≤ 1,
    G + H + I ≤ 0, or V² ≤ 0).
    """

    cell: Cell
    k: sp.Expr
    G: sp.Expr
    H: sp.Expr
    I: sp.Expr

    def __post_init__(self) -> None:
        if self.k.is_number and not self.k > 1:
            raise NoSolitaryWave(
                f"k is {self.k}: a compact wave needs k > 1 (at k = 1 the chain is linear)"
            )
        if self.dispersion.is_number and not self.dispersion > 0:
            raise NoSolitaryWave(
                f"(G+H+I)/D² is {self.dispersion}: there is no compact wave unless G+H+I > 0"
            )
        if self.speed_factor.is_number and not self.speed_factor > 0:
            raise NoSolitaryWave(
                f"V²/B^(k-1) is {self.speed_factor}: there is no wave with a real speed"
            )

    def __repr__(self) -> str:
        return f"TravelingWave({self.cell!r}, k={self.k}, β={shorten(self.beta)})"

    def _repr_latex_(self) -> str:
        return latex.display(
            [
                r"v = u_{x} = B \cos^{2/(k-1)}(\beta \xi), \quad |\xi| \leq \frac{\pi}{2\beta}",
                latex.row(r"\beta", self.beta),
                latex.row("V_{s}", self.speed()),
            ]
        )

    @property
    def D(self) -> sp.Expr:
        """The spacing."""
        return self.cell.spacing

    @cached_property
    def _shares(self) -> tuple[sp.Expr, sp.Expr]:
        """G/I and H/I; in the canonical field both depend on k alone."""
        return factored(self.G / self.I), factored(self.H / self.I)

    @cached_property
    def dispersion(self) -> sp.Expr:
        """(G + H + I) / D²."""
        g, h = self._shares
        if (g + h).free_symbols <= self.k.free_symbols:  # I need not be taken apart
            return self.I / self.D**2 * factored(1 + g + h)
        return factored((self.G + self.H + self.I) / self.D**2)

    @property
    def m(self) -> sp.Expr:
        """m = 2/(k-1), the power of the cosine in the strain."""
        return 2 / (self.k - 1)

    @cached_property
    def beta(self) -> sp.Expr:
        """β = (k-1) / (2 √(G+H+I))."""
        return (self.k - 1) / (2 * self.D * _root(self.dispersion))

    @cached_property
    def width(self) -> sp.Expr:
        """π/β, the length of the wave's support."""
        return sp.pi / self.beta

    @property
    def sites(self) -> sp.Expr:
        """π/(βD), the number of particles under the wave."""
        return self.width / self.D

    def fwhm(self, quantity: str = "strain") -> sp.Expr:
        """Full width at half maximum, a length in x.

        ``quantity`` is "strain" (u_x), "force" (of a contact, A (D u_x)^k) or "velocity"
        (u_τ = -V u_x, so that in this theory its width is the strain's).

        Raises `lwa.InputError` for any other quantity.
        """
        return 2 * sp.acos(2 ** (-1 / (strain_power(quantity, self.k) * self.m))) / self.beta

    @cached_property
    def speed_factor(self) -> sp.Expr:
        """V²/B^{k-1} = 1 - β² [(H + 3I) m - 2I]."""
        # β² and m written out: (k-1) cancels, and the result is rational in k and the masses.
        k, (g, h) = self.k, self._shares
        return factored(1 - (k - 1) * (h + 4 - k) / (2 * (1 + g + h)))

    def speed(self, B: Any = None) -> sp.Expr:
        """V = dx/dτ of the wave whose strain peaks at B (a symbol B when not given)."""
        B = sp.Symbol("B", positive=True) if B is None else positive(B, "B")
        return _root(self.speed_factor) * power(B, (self.k - 1) / 2)

    def amplitude(self, V: Any = V) -> sp.Expr:
        """B = (V² / speed_factor)^{1/(k-1)}, the peak strain of the wave of speed V = dx/dτ."""
        return power(positive(V, "V") ** 2 / self.speed_factor, 1 / (self.k - 1))

    @property
    def force_exponent(self) -> sp.Expr:
        """2k/(k-1), the power of V to which the peak force F_m is proportional."""
        return 2 * self.k / (self.k - 1)

    @property
    def speed_scale(self) -> sp.Expr:
        """τ/t: the speed in space and time is dx/dt = V τ/t."""
        return self.cell.time_scale(self.k)

    @overload
    def at_force(self, F: Sequence[Any] | Array, of: str = "contact") -> PhysicalWaves: ...

    @overload
    def at_force(
        self, F: Any = "F", of: str = "contact", *, precompression: Any = 0
    ) -> PhysicalWave | PrecompressedWave: ...

    def at_force(self, F: Any = "F", of: str = "contact", *, precompression: Any = 0) -> Any:
        """The wave whose force peaks at F, in space and time; the force ``of`` a contact or a bead.

        A number or a name gives a `PhysicalWave`, a list or an array `PhysicalWaves`. Under the
        load ``precompression``, of which a contact's force F is the sum with the dynamic one, it
        is a `PrecompressedWave`, and this wave must be the canonical field's, as in
        `on_background`.

        >>> canonical_wave(Cell([1], spacing=1), "3/2").at_force([1, 64]).speed
        array([0.89442719, 1.78885438])
        """
        load = exact(precompression, "precompression")
        if not load.is_zero:
            self._demand_canonical()
            if of != "contact":
                raise InputError(f"of is {shorten(of)}: under a load it is the force of a contact")
            return PrecompressedWave(self.cell, Power(self.k), F, load)
        if isinstance(F, str | bytes) or not getattr(F, "shape", hasattr(F, "__len__")):
            return PhysicalWave(self, F, of)
        from lwa.wave.curves import (
            PhysicalWaves,  # here, so that `import lwa` does not load NumPy
        )

        return PhysicalWaves(PhysicalWave(self, sp.S.One, of), F)

    def force(self, t: ArrayLike, peak: Any, of: str = "contact") -> Array:
        """The force of a contact, or a bead, at the times t: ``peak`` at t = 0; see `at_force`.

        >>> canonical_wave(Cell([1], spacing=1), "3/2").force([0, 99], peak=10)
        array([10.,  0.])
        """
        return PhysicalWave(self, peak, of).curve(t)

    def plot(self, ax: Any = None) -> Any:
        """Strain and contact force along the chain, drawn on ``ax`` or a new picture.

        Returns the axes. Raises `lwa.InputError` unless k and the masses are numbers.
        """
        from lwa.wave.plots import profiles  # here: Matplotlib is wanted for pictures only

        return profiles(self, ax)

    def on_background(self, p0: Any = "p0") -> BackgroundWave:
        """The waves on a strain p0, where this one is that of the canonical field.

        Raises `lwa.InputError` for another field: its equation has no energy with two terms.

        >>> canonical_wave(Cell((1,)), 2).on_background("p0").speed()
        sqrt(B/3 + p0)
        """
        self._demand_canonical()
        return BackgroundWave(self.cell, Power(self.k), p0)

    def _demand_canonical(self) -> None:
        k, (g, h) = self.k, self._shares
        bloch = Dispersion(self.cell, k).I * self.D**2
        if any(
            sp.cancel(x) != 0 for x in (g - (k - 1) * (k - 2) / 2, h - 2 * (k - 1), self.I - bloch)
        ):
            raise InputError(
                "waves on a background are those of the canonical field, which conserves momentum "
                'and energy: closure="full" with field="center" (--closure full --field center), '
                "or canonical_wave(cell, k)"
            )

    def profile(self, xi: Any, B: Any = None) -> sp.Expr:
        """v(ξ) = B cos^m(βξ) on |ξ| ≤ π/(2β) and 0 outside, as a SymPy Piecewise.

        >>> canonical_wave(Cell((1,)), 3).profile("xi", B=1)
        Piecewise((cos(sqrt(2)*xi/D), Abs(xi) <= sqrt(2)*pi*D/4), (0, True))
        """
        xi = real(xi, "xi")
        B = sp.Symbol("B", positive=True) if B is None else positive(B, "B")
        arch = B * sp.cos(self.beta * xi) ** self.m
        return sp.Piecewise((arch, sp.Abs(xi) <= self.width / 2), (0, True))

    @cached_property
    def roots(self) -> tuple[sp.Expr, sp.Expr]:
        """Both p for which v = z^p removes z_ξ³, the paper's first (2/(k+1) at equal masses)."""
        p, equation = self._equation
        quadratic = sp.Poly(sp.cancel(equation["cubic"] / p), p).all_coeffs()
        A, B, C = (factored(self._with_shares(c)) for c in quadratic)
        root = _root(factored(B**2 - 4 * A * C)).replace(sp.Abs, lambda x: x)
        return (sp.together((-B - root) / (2 * A)), sp.together((-B + root) / (2 * A)))

    @cached_property
    def _equation(self) -> tuple[sp.Symbol, dict[str, sp.Expr]]:
        """p and `strain_equation` over I, with symbols for G/I and H/I."""
        p = sp.Dummy("p")
        return p, strain_equation(p, _SHARES[0], _SHARES[1], sp.S.One)

    def _with_shares(self, value: sp.Expr) -> sp.Expr:
        return value.xreplace(dict(zip(_SHARES, self._shares, strict=True)))

    def reduction(self, root: int = 0, V: Any = V) -> Reduction:
        """z'' = μ z^η - σ z for one root p (0: the paper's, 1: the other).

        With p the equation reads V² z^p p r_1 = z^{kp} p (r_1 + I r_3 + q r_1 r_2). Since
        ∂(z^e r_2) = z^e (r_3 + (e - 1) r_1 r_2), the factor z^a, kp + a = e = q/I + 1, makes it
        a total derivative; integrated once it is the equation of z.
        """
        if root not in (0, 1):
            raise InputError(f"root is {shorten(root)}: 0 or 1 is wanted")
        p, equation = self._equation
        exponent = sp.Poly(sp.cancel(equation["product"] / equation["third"]) + 1, p)  # e
        slope, constant = (factored(self._with_shares(exponent.nth(n))) for n in (1, 0))
        a = factored(slope - self.k) * self.roots[root] + constant
        return Reduction(k=self.k, I=self.I, p=self.roots[root], a=a, V=positive(V, "V"))

    def at(self, **values: Any) -> TravelingWave:
        """The same wave with numbers (or other symbols) for the named symbols, and for ω = m2/m1.

        Raises `lwa.InputError` for a name that the wave does not contain or a value that is not
        positive, and `NoSolitaryWave` where the values admit none.

        >>> from lwa import Dimer, homogenize
        >>> wave = homogenize(Dimer("m1", "m2")).pde.traveling_wave()
        >>> wave.at(k=sp.Rational(3, 2), m1=1, m2=1).beta
        sqrt(10)/(5*D)
        """
        new = substitution(values, self.cell, self.k)
        G, H, I = (c.xreplace(new) for c in (self.G, self.H, self.I))
        return TravelingWave(
            cell=self.cell.replaced(new), k=exponent(self.k.xreplace(new)), G=G, H=H, I=I
        )

    def numeric(self, missing: Literal["raise", "nan"] = "raise") -> NumericWave:
        """Vectorised float64 functions of (k, ω), ω = m2/m1; see `lwa.NumericWave`.

        Raises `lwa.InputError` unless k is a symbol and the masses are two, as in N:1 dimers.
        """
        from lwa.wave.numeric import (
            NumericWave,  # here, so that `import lwa` does not load NumPy
        )

        return NumericWave(self, missing)

    def code(self, language: str) -> str:
        """β, widths, speed, amplitude and profile as functions in a program's source text.

        ``language`` is "python" (plain `math`), "numpy", "c", "fortran", "julia" or "javascript";
        arguments and accuracy are told in `lwa.wave.functions`.

        Raises `lwa.InputError` for another language, and for numbers beyond a double.
        """
        from lwa.wave.functions import wave_code  # here: it knows this class

        return wave_code(self, language)


def canonical_wave(cell: Cell, k: Any = symbol_k) -> TravelingWave:
    """The wave of the canonical field of any cell, from the linear chain's dispersion alone.

    With Ω² = κ² (1 - I κ² + …) the equation of the canonical field has G = I (k-1)(k-2)/2 and
    H = 2I (k-1), hence β = (k-1)/√(2I k(k+1)) and V² = 2 B^{k-1}/(k(k+1)); the same as
    ``homogenize(cell, closure="full", field="center").pde.traveling_wave()``.

    >>> canonical_wave(Cell((1, 1)), "3/2").beta
    sqrt(10)/(5*D)
    """
    k = exponent(k, cell)
    I = Dispersion(cell, k).I * cell.spacing**2
    return TravelingWave(cell=cell, k=k, G=I * (k - 1) * (k - 2) / 2, H=2 * I * (k - 1), I=I)


def _root(value: sp.Expr) -> sp.Expr:
    """√value of a rational expression in positive quantities, squares taken out of the root."""
    plain, back = sp.posify(value)
    numerator, denominator = sp.fraction(plain)
    return (root(numerator) / root(denominator)).xreplace(back)
