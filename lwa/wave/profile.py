"""The profile of a wave on a background in many digits: one quadrature, by mpmath.

With v = B / cosh²θ the equation of `lwa.wave.background` is

    dξ/dθ = 2 √(I F′(p0+v) (B - v) / (B (Q(B) - Q(v)))),

regular as far as π/2 from the real axis at any load.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import mpmath
from mpmath.calculus.quadrature import GaussLegendre

Function = Callable[[Any], Any]

_GAUSS = GaussLegendre(mpmath.mp)


@dataclass(frozen=True)
class Profile:
    """A wave that rises by B, in mpmath's working precision, of which differences lose some.

    force, slope and stiffness are F, F′ and Q at the strain v above the background.
    """

    B: Any
    I: Any
    force: Function
    slope: Function
    stiffness: Function

    @cached_property
    def _top(self) -> Any:
        return self.stiffness(self.B)

    def rate(self, theta: Any) -> Any:
        """dξ/dθ, θ > 0."""
        v = self.strain(theta)
        gap = self.B * (self._top - self.stiffness(v))
        return 2 * mpmath.sqrt(self.I * self.slope(v) * (self.B - v) / gap)

    def strain(self, theta: Any) -> Any:
        """v."""
        return self.B / mpmath.cosh(theta) ** 2

    def place(self, theta: Any) -> Any:
        """ξ(θ)."""
        pieces = max(1, int(mpmath.ceil(theta)))
        return self._integral(mpmath.linspace(0, theta, pieces + 1))

    def half(self, quantity: str) -> Any:
        """θ where the quantity has half of its rise."""
        if quantity != "force":
            return mpmath.acosh(mpmath.sqrt(2))
        half = (self.force(mpmath.mpf(0)) + self.force(self.B)) / 2
        v = self.B
        for _ in range(200):  # Newton, from the side where a law that stiffens does not overshoot
            change = (self.force(v) - half) / self.slope(v)
            v -= change
            if abs(change) < abs(v) * mpmath.eps * 100:
                break
        return mpmath.acosh(mpmath.sqrt(self.B / v))

    def theta(self, place: Any, accuracy: Any) -> Any:
        """θ at a place ξ > 0."""
        start, here = mpmath.mpf(0), mpmath.mpf(0)
        while here + (step := self._integral([start, start + 1])) < place:
            start, here = start + 1, here + step
            if start > 3 * mpmath.mp.dps:  # v is nothing there
                return start
        low, high = start, start + 1
        theta = (low + high) / 2
        for _ in range(4 * mpmath.mp.dps):  # Newton, or halves where it leaves the panel
            gap = here + self._integral([start, theta]) - place
            low, high = (theta, high) if gap < 0 else (low, theta)
            change = gap / self.rate(theta)
            inside = low < theta - change < high
            theta = theta - change if inside else (low + high) / 2
            if abs(change) < accuracy or high - low < accuracy:
                break
        return theta

    def _integral(self, points: list[Any]) -> Any:
        """∫ dξ by Gauss's rule on pieces of length 1, of as many points as the precision asks for.

        n points are good to 6^{-2n}; its cancellation at small θ would keep an adaptive rule busy.
        """
        degree = 4 + max(0, math.ceil(math.log2(mpmath.mp.dps / 50)))  # 3·2^{degree-1} points
        pieces = (_GAUSS.get_nodes(a, b, degree, mpmath.mp.prec) for a, b in pairwise(points))
        return mpmath.fdot((w, self.rate(theta)) for nodes in pieces for theta, w in nodes)
