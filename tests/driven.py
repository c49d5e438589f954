"""A chain that a wall drives: speed and peak of its leading pulse."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy

from lwa import Shock
from validation import Drive, Scene, simulate

SITES = 600  # that the leading pulse runs
PATH = 0.25, 0.9  # parts of these sites between which the pulse is measured


@dataclass(frozen=True)
class Driven:
    """Measured values, and what they may lack of those of the steady pulse."""

    speed: float
    speed_doubt: float
    peak: float
    peak_doubt: float
    displacements: np.ndarray
    time: float


def drive(front: Shock, sites: int = SITES, **options) -> Driven:
    """Drive a chain without units at v_p; ``options`` are those of `validation.simulate`."""
    end, n = sites / float(front.leading_speed()), math.ceil(1.15 * sites) + 40
    places = np.unique(np.linspace(*PATH, 12) * sites).astype(int)
    scene = Scene(
        masses=(1.0,) * n, stiffnesses=(1.0,) * (n - 1),
        wall=1.0, law=front.law, drive=Drive(velocity=float(front.plateau)), duration=end,
        precompression=float(front.law.at(front.ahead)),
        contact_sensors=tuple(map(int, places)), samples=8 * sites + 1,
    )  # fmt: skip
    run = simulate(scene, **({"rtol": 1e-6} | options))
    sign = 1.0 if front.plateau > 0 else -1.0
    time, peak = np.array([_first_peak(run.time, sign * row) for row in run.compression]).T
    x = places.astype(float)
    (speed, top), (later, last) = (_limits(x[i:], time[i:], sign * peak[i:]) for i in (0, 6))
    return Driven(speed, abs(speed - later), top, abs(top - last), run.displacements, end)


def _limits(x: np.ndarray, time: np.ndarray, peak: np.ndarray) -> tuple[float, float]:
    """Speed and peak as x → ∞: arrivals x/s + a ln x + b, as KdV's, and peaks b + a/x."""
    columns = np.stack([x, np.log(x), np.ones_like(x)], axis=1)
    return float(1 / np.linalg.lstsq(columns, time)[0][0]), float(np.polyfit(1 / x, peak, 1)[1])


def _first_peak(time: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Time and height of the first maximum above half the largest rise, by a parabola."""
    start = int(np.argmax(values - values[0] > np.ptp(values) / 2))
    i = start + int(np.argmax(np.diff(values[start:]) < 0))
    a, b, c = np.polyfit(time[i - 1 : i + 2] - time[i], values[i - 1 : i + 2], 2)
    return time[i] - b / (2 * a), c - b**2 / (4 * a)


def trailing_edge(front: Shock, chain: Driven) -> float:
    """The place over time where the line through the lower half of the envelope reaches p₋."""
    rise = float(front.ahead) - np.diff(chain.displacements) - float(front.behind)
    tops = scipy.signal.find_peaks(rise, height=0)[0]
    place, rise = (tops + 0.5) / chain.time, rise[tops]
    part = np.digitize(place, np.linspace(place.min(), place.max(), 120))
    envelope = np.array([(place[part == i].mean(), rise[part == i].max()) for i in np.unique(part)])
    height = envelope[:, 1] / rise.max()
    slope, offset = np.polyfit(*envelope[(height > 0.15) & (height < 0.5)].T, 1)
    return float(-offset / slope)
