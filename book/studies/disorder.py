"""Decay of a pulse in chains of random masses.

Equal contacts, A = D = 1. The masses are drawn evenly from 1 - s … 1 + s, the first bead has mass 1
and strikes the others with velocity 1. F is the peak force of a contact.

**One bead.** A single bead of mass 1 + e in a chain of equal beads throws a part of the pulse back:
ln F falls by

    L(e) = a e² + b |e|^{k+1} + …,

a e² for the two linear reflections and |e|^{k+1} for contacts that open at the bead; b differs for
heavier and lighter beads. L is measured on the lattice at the nodes of a Gauss-Legendre rule for
each sign of e.

**All beads.** If the beads reflect independently, the decay of ln F per site is the mean of L over
the distribution of the masses: the theory's line. Measured is d = -d ln F/dn, along the whole chain
by least squares and locally from one place to the next. An exponential decay F ~ e^{-dn} has the
same d in both halves of the chain; a finding tests this. Means are over chains, and errors are the
standard errors of these means.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from lwa import Cell, canonical_wave
from lwa.base.arrays import Array
from lwa.base.frozen import Estimate
from lwa.base.progress import Progress
from validation.lattice.result import Run
from validation.lattice.simulate import simulate, simulate_many
from validation.pictures import Curve, Panel
from validation.pulses.pulse import highest_pulse
from validation.report.study import EXPONENT, Report, option, study
from validation.report.table import Column, Estimates, Finding, Table
from validation.scenes.chains import struck
from validation.scenes.checks import between, integer
from validation.scenes.scene import Scene
from validation.studies.paper import of_momentum

PLACES = 10  # contacts at which the pulse is measured, equally far from each other
NODES = 5  # excesses of either sign at which the loss at a single bead is measured
SIGMAS = (
    2.5  # standard errors by which the decay may differ between the halves of the chain
)
_BEYOND = 20  # beads behind the last place
_BEFORE, _BEHIND = (
    40,
    40,
)  # sites from the blow to the single bead and on to the last sensor
_TOLERANCE = 1e-6  # of the random chains
_CLOSE = 1e-4  # largest change of ln F at ten times the tolerance


@study(
    EXPONENT,
    option("--spread", "Masses lie between 1 - spread and 1 + spread.", default=0.1),
    option("--chains", "Number of random chains.", default=20),
    option("--sites", "Sites from the struck bead to the last place.", default=200),
    option("--seed", "Seed of the random numbers.", default=1),
)
def disorder(
    k: float = 1.5,
    spread: float = 0.1,
    chains: int = 20,
    sites: int = 200,
    seed: int = 1,
    progress: Progress[int] = iter,
) -> Report:
    """Decay of a pulse in chains of random masses, beside the mean loss at single beads.

    ``decay_value`` per site with its error, ``theory_value`` (the mean loss at a single bead),
    ``rows`` by place: ``site``, ``log_force_value`` with its error (mean of ln F less ln F at the
    first place), ``scatter_value`` (standard deviation over chains), ``decay_value`` with its error
    (from the place before to this place) and ``theory_value`` (ln F by the theory); ``single``:
    ``excess_value``, ``loss_value`` with its error.

    Raises `SceneError` for parameters out of range, `lwa.NoSolitaryWave` for k ≤ 1, and
    `MeasureError` where a pulse does not reach the last place.
    """
    between(spread, "spread", 0, 0.5, "one from 0 to 0.5 is wanted")
    chains, seed = integer(chains, "chains", 2, 10_000), integer(seed, "seed", 0)
    sites = integer(sites, "sites", 5 * PLACES, 10_000)
    places = np.linspace(sites / PLACES, sites, PLACES).astype(int)

    def scene(number: int) -> Scene:
        """Scene of the random chain ``number``, which does not depend on the number of chains."""
        random = np.random.default_rng((seed, number))
        masses = (1.0, *random.uniform(1 - spread, 1 + spread, sites + _BEYOND))
        return _struck(masses, k, places.tolist())

    scenes = list(map(scene, range(chains)))
    runs = simulate_many(scenes, rtol=_TOLERANCE)
    logs = np.array([_log_forces(next(runs)) for _ in progress(range(chains))])
    coarse = _log_forces(simulate(scenes[0], rtol=10 * _TOLERANCE))
    change = float(np.abs(coarse - logs[0]).max())
    numerical = Finding(
        "ln F at ten times the tolerance, first chain: largest change",
        change,
        high=_CLOSE,
        key="integration_error",
    )
    node, weight = np.polynomial.legendre.leggauss(NODES)
    excesses = spread / 2 * np.append(node - 1, node + 1)
    losses = single_losses(excesses, k)
    theory = float(np.append(weight, weight) @ [loss.value for loss in losses]) / 4
    title = f"{chains} chains of {sites} sites, masses in 1 ± {spread:g}, k = {k:g}"
    single = list(zip(excesses.tolist(), losses, strict=True))
    return _report(title, places, logs, theory, single, numerical)


def single_losses(
    excesses: Sequence[float] | Array, k: float = 1.5, rtol: float = 1e-9
) -> list[Estimate]:
    """Loss in ln F of a pulse that passes a bead of mass 1 + e among equal beads, for each e.

    The fall without the bead is subtracted: after 20 sites the blow still sheds a millionth. Errors
    are the changes at ten times the tolerance.
    """
    rest = (1.0,) * (_BEHIND + _BEYOND)
    sensors = [_BEFORE // 2, _BEFORE + _BEHIND]
    masses = [(1.0,) * _BEFORE + (1 + e,) + rest for e in (0.0, *excesses)]
    scenes = [_struck(row, k, sensors) for row in masses]
    fine, coarse = (
        np.array(
            [
                -np.diff(_log_forces(run))[0]
                for run in simulate_many(scenes, rtol=tolerance)
            ]
        )
        for tolerance in (rtol, 10 * rtol)
    )
    falls = zip(fine[1:] - fine[0], coarse[1:] - coarse[0], strict=True)
    return [Estimate.against(float(one), float(other)) for one, other in falls]


def _struck(masses: Sequence[float], k: float, sensors: Sequence[int]) -> Scene:
    """Scene of a struck chain, for twice the flight of a pulse with all of the blow's momentum."""
    duration = (
        2
        * len(masses)
        / float(of_momentum(canonical_wave(Cell([1], spacing=1), str(k)), 1.0).speed)
    )
    samples = math.ceil(30 * duration * max(1.0, k / 1.5))
    return struck(
        masses,
        len(masses),
        k,
        contact_sensors=sensors,
        duration=duration,
        samples=samples,
    )


_ROWS = (
    Column("site", "site"),
    Estimates("log_force", "ln F less its first"),
    Column("scatter_value", "scatter over chains", format=".2e"),
    Estimates("decay", "decay per site, local"),
    Column("theory_value", "ln F, theory", format=".5f"),
)
_SINGLE = (
    Column("excess_value", "excess e", format="+.4f"),
    Estimates("loss", "loss of ln F"),
    Column("", "loss/e²", format=".4f"),
)


def _report(
    title: str,
    places: Array,
    logs: Array,
    theory: float,
    single: Sequence[tuple[float, Estimate]],
    numerical: Finding,
) -> Report:
    """Build the report from ln F (chains, places) and the losses at single beads."""
    falls, half = logs - logs[:, :1], len(places) // 2
    decay = _slopes(places, logs)
    change = _mean(
        _slopes(places[half:], logs[:, half:]) - _slopes(places[:half], logs[:, :half])
    )
    means, scatter = [_mean(fall) for fall in falls.T], falls.std(axis=0, ddof=1)
    local = [None, *map(_mean, (-np.diff(logs, axis=1) / np.diff(places)).T)]
    line = theory * (places[0] - places)
    mean = _mean(decay)
    bound = SIGMAS * change.error + _CLOSE / (places[-1] - places[0])
    constant = Finding(
        f"decay per site, second half less first; {SIGMAS} standard errors are allowed",
        change.value,
        -bound,
        bound,
        key="decay_change",
    )
    bars = [m.value for m in means], "C0o", [m.error for m in means]
    beads = []
    for e, loss in single:
        share = loss.value / e**2 if e else None
        beads.append({"excess_value": e, "loss": loss, "loss/e²": share})
    rows = []
    for row in zip(places.tolist(), means, scatter, local, line, strict=True):
        names = [column.name for column in _ROWS]
        rows.append(dict(zip(names, row, strict=True)))
    return Report(
        f"{title}; decay of ln F per site: {mean}, mean loss at a single bead: {theory:.3g}",
        (
            Table(_ROWS, rows, "rows"),
            Table(
                _SINGLE,
                beads,
                "single",
                note="Loss at one bead of mass 1 + e in equal ones.",
            ),
        ),
        (numerical, constant),
        (
            Panel(
                "site",
                "ln F, less that at the first place",
                (
                    Curve("mean over chains", places, *bars),
                    Curve(
                        f"mean loss at a single bead {theory:.3g}", places, line, "C1-"
                    ),
                ),
            ),
        ),
        ("F: peak force of a contact. ±: standard error of the mean over chains.",),
        {
            "decay_value": mean.value,
            "decay_error_value": mean.error,
            "theory_value": theory,
        },
    )


def _slopes(places: Array, logs: Array) -> Array:
    """Decay rate -d ln F/dn of each chain, by least squares."""
    return np.asarray(-np.polynomial.polynomial.polyfit(places, logs.T, 1)[1])


def _log_forces(run: Run) -> Array:
    """Logarithm of the peak force at each sensor."""
    signals = (run.signal("contact", i) for i in run.scene.contact_sensors)
    return np.log([highest_pulse(force).peak for force in signals])


def _mean(values: Array) -> Estimate:
    """The mean over chains with its standard error."""
    mean = float(values.mean())
    return Estimate(mean, float(values.std(ddof=1)) / math.sqrt(len(values)))


if __name__ == "__main__":
    disorder.main()
