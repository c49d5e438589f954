"""The base of a record before a pulse, and the noise about it.

Two bases are fitted to samples before the pulse: a straight line, for drift and hum, and a line
with two exponentials that grow towards the pulse, for what may rise slowly before the pulse
arrives. They are averaged with Akaike's weights exp(-(χ² + 2p)/2), p the number of terms, χ² by the
noise and its correlations. Each drawn record takes one of the bases, by their weights: so errors
hold the doubt between them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from lwa.base.arrays import Array

_BEFORE = 2.0  # widths between the samples of the base and the rise
_CLOSE = 1.0  # the same in a record that would leave less than 2.5 widths for the base
_LONG = 10.0  # widths of the longest base: drift and hum are straight over such a time
_SHORTEST = 0.9  # widths of the shortest base
FEWEST_FOR_BASE = 16  # samples of a base, at least
# Widths in which the terms that rise before the pulse grow e-fold.
_GROWTHS = (1.0, 2.0)
_LINE = 2  # terms of a straight line
_BASES = (_LINE, _LINE + len(_GROWTHS))  # terms of the bases
_SLOW = 5.0  # widths of the shortest base in which a slow rise differs from a line
_GUESSED = 5  # samples at the start of a record that begins too late
DRAWS = 200  # records that are drawn for an error


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted base: the sizes of its terms, and the noise that is left, (B,)."""

    sizes: Array
    noise: Array

    @classmethod
    def of(cls, x: Array, f: Array, count: int) -> Fit:
        """Fit the first ``count`` terms of a base to samples f at times x in widths.

        f is (B,), or (B, draws) for a fit of each drawn record.
        """
        terms = _terms(x, count)
        solved, *_ = np.linalg.lstsq(terms, f)
        sizes = np.asarray(solved, float)
        return cls(sizes, f - terms @ sizes)

    def at(self, x: Array) -> Array:
        """Return the base at times of the pulse, without the terms that rise before the pulse."""
        line = self.sizes[:_LINE]
        return _terms(x, len(line)) @ line

    @property
    def variance(self) -> float:
        """Variance of the noise: its squares over the degrees of freedom, samples less terms."""
        squares = np.sum(self.noise**2)
        freedom = len(self.noise) - len(self.sizes)
        return float(squares) / freedom

    @cached_property
    def correlation_time(self) -> float:
        """Integrated autocorrelation time of the noise, in samples; 1 without noise.

        It is ``1 + 2 Σ ρ_j``, where ``ρ_j`` is the correlation of samples at a distance (lag) of
        1, 2, … samples. A mean over N samples varies as one over ``N/(1 + 2 Σ ρ_j)`` independent
        samples does.
        """
        products = self.correlations
        if not products[0]:
            return 1.0
        # products[j]/products[0] = ρ_j, and ρ_0 = 1 counts once.
        return float(2 * products.sum() / products[0] - 1)

    @cached_property
    def correlations(self) -> Array:
        """Mean products of the noise with itself by lag, up to the first lag without any."""
        count = len(self.noise)
        # Twice as long, so that the end of the noise does not meet its start. `scipy.signal`, which
        # has the sum, takes 0.4 s to load.
        spectrum = np.fft.rfft(self.noise, 2 * count)
        power = np.abs(spectrum) ** 2
        products = np.fft.irfft(power)[:count] / count
        unlike = np.append(products, 0.0) <= 0
        first = np.argmax(unlike)
        return products[: max(1, first)]


@dataclass(frozen=True, eq=False)
class Base:
    """The base before a pulse and its noise.

    Parameters
    ----------
    rise, width : float
        Time at which the pulse rises, and its width.
    x : array
        Times of the samples, (B,), in widths from the rise.
    fits : sequence of Fit
        Fitted bases, whose mean is the base.
    weights : array
        Weights of the fits in the mean.
    best : Fit
        The fit whose residuals are the noise.
    """

    rise: float
    width: float
    x: Array
    fits: Sequence[Fit]
    weights: Array
    best: Fit

    @classmethod
    def before(cls, t: Array, f: Array, rise: float, width: float) -> Base | None:
        """Return the base before a pulse; None if the record begins too late."""
        end = rise - _BEFORE * width
        # A short record leaves too few samples so far ahead of the pulse.
        if t[0] > end - 2.5 * width:
            end = rise - _CLOSE * width
        start = end - _LONG * width
        calm = (t > start) & (t < end)
        x = (t[calm] - rise) / width
        if len(x) < FEWEST_FOR_BASE:
            return None
        length = np.ptp(x)
        if length < _SHORTEST:
            return None
        counts: Sequence[int] = _BASES
        if length < _SLOW:
            counts = (_LINE,)
        samples = f[calm]
        fits = [Fit.of(x, samples, count) for count in counts]
        # Akaike's criterion, with the noise that the base with all terms leaves; correlated samples
        # count as fewer. Where no noise is left any scale will do.
        full = fits[-1]
        scale = full.variance * full.correlation_time or 1.0
        criteria = []
        for fit in fits:
            squares = np.sum(fit.noise**2)
            criteria.append(squares / scale + 2 * len(fit.sizes))
        exponents = -np.array(criteria) / 2
        weights = scipy.special.softmax(exponents)
        best = fits[np.argmax(weights)]
        return cls(rise, width, x, fits, weights, best)

    @classmethod
    def guessed(cls, f: Array, noise: float) -> Base:
        """Return the base of a record that begins too late: its first values, or its lowest.

        Parameters
        ----------
        f : array
            Samples.
        noise : float
            Standard deviation of their noise.
        """
        # Two levels in place of fits, equally likely, each with the noise in a form that gives this
        # variance and no correlation; rise and width do not matter to a level.
        samples = np.array([noise, 0.0])
        first = f[:_GUESSED].mean()
        lowest = np.quantile(f, 0.1)  # not the least value, which is that of the noise
        fits = [Fit(np.array([level]), samples) for level in (first, lowest)]
        nowhere = np.zeros(0)
        alike = np.full(2, 0.5)
        return cls(0.0, 1.0, nowhere, fits, alike, fits[0])

    def at(self, t: Array) -> Array:
        """Return the base at times of the pulse."""
        x = (t - self.rise) / self.width
        bases = [fit.at(x) for fit in self.fits]
        return self.weights @ bases

    def drawn(self, t: Array, pulse: Array, variance: float, step: float) -> Array:
        """Draw errors that noise makes in a pulse over its base.

        Parameters
        ----------
        t, pulse : array
            Times, (N,), and the pulse without noise.
        variance : float
            Variance of the noise during the pulse.
        step : float
            Distance of the levels to which samples are rounded, 0 if they are not.

        Returns
        -------
        array
            Draws, (N, `DRAWS`).
        """
        rng = np.random.default_rng(0)
        count = len(self.x)
        noise = self._noise(rng, count + len(t))
        # The first rows of the noise are in the samples of the base, the others in the pulse.
        calm = noise[:count] * self.best.noise.std()
        # Rounding has the variance step²/12, and the noise before it what is left of the variance.
        unrounded = max(0.0, variance - step**2 / 12)
        added = noise[count:] * math.sqrt(unrounded)
        if step:
            # Without noise the samples of the base are alike, all at one place between two levels.
            calm = _rounding(calm, np.zeros(1), step, rng)
            added = _rounding(added, pulse, step, rng)
        x = (t - self.rise) / self.width
        mean = self.at(t)
        chosen = rng.choice(len(self.fits), DRAWS, p=self.weights)
        for i, fit in enumerate(self.fits):
            draws = chosen == i
            samples = calm[:, draws]
            # The pulse is the record less its base. If the drawn fit is the base, and not the mean
            # of all fits, the pulse is higher by mean - fit.
            apart = mean - fit.at(x)
            added[:, draws] += apart[:, np.newaxis]
            # The noise before the pulse moves a base of as many terms by the fit to this noise, and
            # the pulse the other way.
            drawn = Fit.of(self.x, samples, len(fit.sizes))
            added[:, draws] -= drawn.at(x)
        return added

    def _noise(self, rng: np.random.Generator, count: int) -> Array:
        """Draw records with the correlations of the noise and variance 1, (count, `DRAWS`)."""
        products = self.best.correlations
        size = count + len(products)
        white = rng.normal(size=(size, DRAWS))
        # The power spectrum sums the products at lags of both signs; lag 0 counts once. Half of it,
        # as its scale does not matter, is the transform of the lags from 0 on less half of lag 0.
        spectrum = np.fft.rfft(products, size)
        one_sided = spectrum.real - products[0] / 2
        power = np.maximum(one_sided, 0.0)
        if not power.any():
            return white[:count]
        factors = np.sqrt(power / power.mean())
        spectra = np.fft.rfft(white, axis=0)
        spectra *= factors[:, np.newaxis]
        shaped = np.fft.irfft(spectra, size, axis=0)
        return shaped[:count]


def _rounding(
    noise: Array, exact: Array, step: float, rng: np.random.Generator
) -> Array:
    """Return noise with the errors of rounding to levels; ``exact`` are values without noise."""
    # Base and pulse lie anywhere between two levels.
    places = rng.uniform(-0.5, 0.5, DRAWS)
    true = exact[:, np.newaxis] + step * places
    levels = np.round((true + noise) / step)
    return step * levels - true


def _terms(x: Array, count: int) -> Array:
    """Return the first terms of a base, (len(x), count): level, slope, exponentials.

    x : times in widths of the pulse, 0 where the pulse rises through half of its peak.
    """
    # Exponentials are fitted before the rise alone, where x < 0. Behind it no base has them
    # (`Fit.at`); there they stay 1, so that they do not overflow.
    before = np.minimum(x, 0.0)
    columns = [np.ones_like(x), x]
    for growth in _GROWTHS:
        columns.append(np.exp(before / growth))
    return np.column_stack(columns[:count])
