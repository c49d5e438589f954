"""Decay of a pulse in chains of random masses.

Equal contacts, A = D = 1; masses are drawn evenly from 1 - s … 1 + s, but for the first bead, of
mass 1, which strikes with velocity 1. Every bead that differs from its neighbours throws a part of
the pulse back, and its peak force falls as F ~ e^{-d n} over n sites. d is the slope of ln F by
least squares in each chain; means are over chains, and errors are standard errors of these means.
"""

from __future__ import annotations

import math

import numpy as np

from lwa.base.arrays import Array
from lwa.base.progress import Progress
from validation.lattice.run import Run
from validation.lattice.simulate import simulate, simulate_many
from validation.pulses.pulse import Measured, measure
from validation.report.command import EXPONENT, option, study
from validation.report.panel import Curve, Panel
from validation.report.result import Report
from validation.report.table import Column, Finding, Table
from validation.scenes.chains import struck
from validation.scenes.checks import between, integer
from validation.scenes.scene import Scene
from validation.waves.theory import Compacton, theory_at

PLACES = 10  # contacts at which the pulse is measured, equally far from each other
_BEYOND = 20  # beads behind the last place
_TOLERANCE = 1e-6
_CLOSE = 1e-4  # by how much ln F may change at a ten times coarser tolerance


@study(
    EXPONENT,
    option("--spread", default=0.1, says="s: masses lie in 1 - s … 1 + s."),
    option("--chains", default=20, says="How many are drawn."),
    option("--sites", default=200, says="From the struck bead to the last place."),
    option("--seed", default=1, says="Of the random numbers; the same seed, the same chains."),
)
def disorder(
    k: float = 1.5, spread: float = 0.1, chains: int = 20, sites: int = 200, seed: int = 1,
    progress: Progress[int] = iter,
) -> Report:  # fmt: skip
    """Decay of a pulse in chains of random masses, with error bars over chains.

    ``decay_value`` per site, its error, and ``rows``: ``site``, ``log_force_value`` and its error,
    the mean of ln F less that at the first place, and ``scatter_value``, its standard deviation
    over chains.

    Raises `SceneError` for numbers that cannot be meant, `lwa.NoSolitaryWave` for k ≤ 1, and
    `MeasureError` where a pulse does not come through.
    """
    between(spread, "spread", 0, 0.5, "one from 0 to 0.5 is wanted")
    chains, seed = integer(chains, "chains", 2, 10_000), integer(seed, "seed", 0)
    sites = integer(sites, "sites", 5 * PLACES, 10_000)
    places = np.linspace(sites / PLACES, sites, PLACES).astype(int)
    # Twice what a pulse needs that keeps all of the blow's momentum.
    duration = 2 * (sites + _BEYOND) / Compacton.of_momentum(theory_at(str(k), 1), 1.0).speed
    samples = math.ceil(30 * duration * max(1.0, k / 1.5))

    def scene(number: int) -> Scene:
        """Chain ``number``, whatever the number of chains."""
        random = np.random.default_rng((seed, number))
        masses = (1.0, *random.uniform(1 - spread, 1 + spread, sites + _BEYOND))
        return struck(masses, len(masses), k, contact_sensors=tuple(places.tolist()),
                      duration=duration, samples=samples)  # fmt: skip

    scenes = list(map(scene, range(chains)))
    runs = simulate_many(scenes, rtol=_TOLERANCE)
    logs = np.array([_log_forces(next(runs)) for _ in progress(range(chains))])
    coarse = _log_forces(simulate(scenes[0], rtol=10 * _TOLERANCE))
    numerical = Finding(
        "ln F at ten times the tolerance, first chain: largest change",
        float(np.abs(coarse - logs[0]).max()), high=_CLOSE, key="integration_error",
    )  # fmt: skip
    title = f"{chains} chains of {sites} sites, masses in 1 ± {spread:g}, k = {k:g}"
    return _report(title, places, logs, numerical)


_COLUMNS = (
    Column("site", "site"),
    Column("log_force", "ln F less its first", error=True),
    Column("scatter_value", "scatter over chains", format=".2e"),
)


def _report(title: str, places: Array, logs: Array, numerical: Finding) -> Report:
    """Of ln F by chain and place."""
    falls = logs - logs[:, :1]
    decay = _mean(-np.polynomial.polynomial.polyfit(places, logs.T, 1)[1])
    means, scatter = [_mean(fall) for fall in falls.T], falls.std(axis=0, ddof=1)
    line = falls.mean() - decay.value * (places - places.mean())
    values, errors = [m.value for m in means], [m.error for m in means]
    bars = Curve.of("mean over chains", places, values, "C0o", errors)
    fit = Curve.of(f"decay {decay.value:.3g} per site", places, line, "C1-")
    rows = tuple(zip(places.tolist(), means, scatter.tolist(), strict=True))
    return Report(
        f"{title}; decay of the peak force per site: {decay}",
        (Table(_COLUMNS, rows, "rows"),),
        (numerical,),
        (Panel("site", "ln F, less that at the first place", (bars, fit)),),
        ("F: peak force of a contact. ±: standard error of the mean over chains.",),
        {"decay_value": decay.value, "decay_error_value": decay.error},
    )


def _log_forces(run: Run) -> Array:
    """ln F at the sensors."""
    return np.log([measure(run.time, force).peak for force in run.contact_force])


def _mean(values: Array) -> Measured:
    """The mean over chains; its standard error is the error."""
    mean = float(values.mean())
    return Measured(mean, mean + float(values.std(ddof=1)) / math.sqrt(len(values)))


if __name__ == "__main__":
    disorder.main()
