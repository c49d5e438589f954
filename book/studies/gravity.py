"""Width of a pulse against depth in a chain under its own weight.

The beads stand on a wall; units are their mean mass, A, D and g. Under x beads the load is F0 = x
and the speed of sound, in sites per unit of time, c0(x) = √(k x^{(k-1)/k}).

**A weak blow** at the top bead. Frequencies are kept on the way down, and a wave of frequency ω has
there the wavenumber q = ω/c0 + I ω³/(2 c0³) + …, I that of the linear chain, at any load. The front
at depth x is thus, with S = ∫ dx/c0³ and z = (t0 - t)/(3 I S/2)^{1/3} at times t around the arrival
t0 of sound,

    v ∝ ∫_0^∞ s^μ cos(s³/3 + z s - πμ/2) ds,    μ = (k-1) / (2(k+1)),

for μ = 0 Airy's function; μ comes from the top, where c0 ∝ x^{(k-1)/2k} starts from 0 and the
blow's long waves are Hankel functions of order 1/(k+1). The front's width in sites is c0 times that
in time, and c0³ S = 2k/(3-k) x for k < 3:

    width = w (3 I k x / (3-k))^{1/3},    w the FWHM of the integral above in z,

(2k/(3-k))^{1/3} times the width at constant speed: sound speeds up, which stretches the front. From
k = 3 on most of the spreading happens at the top, and the exponent is no longer 1/3. Waves that are
not short beside x are no rays: this gives a correction of x^{-2/3} on the way, and one from the top
of x^{-(3-k)/3k} if it is of order ω², or of x^{-2(3-k)/3(k+1)} if of order ω^{4k/(k+1)}. The fit
has the first and the last of these; its errors contain the change by the other.

**A strong blow** makes the solitary wave of the load at its depth (`lwa.loaded_wave`), until
this wave is as wide as the front of a weak blow, which the pulse then follows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np

from lwa import Cell, Power, loaded_wave
from lwa.base.arrays import Array
from lwa.base.frozen import Estimate
from lwa.base.progress import Progress
from lwa.command.options import quantities
from lwa.loaded.background import Background
from validation.lattice.result import Run
from validation.lattice.simulate import repeated, simulate
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Piecewise, first_pulse, highest_pulse
from validation.pulses.sensors import tracks
from validation.report.study import EXPONENT, Report, option, study
from validation.report.table import Column, Estimates, Finding, Table, percent
from validation.scenes.chains import struck
from validation.scenes.checks import between, integer, numeric
from validation.scenes.scene import Scene

CHAINS = ((1,), (1, "1/2"))  # masses of the default cells
WEAK, STRONG = 1e-4, (10.0, 100.0, 1000.0)  # velocities of the struck bead
_UNLIKE = 1000  # largest ratio of masses: a light bead takes ever shorter steps
FIRST = 100  # beads above the first place of the fit of a weak blow's front
_PLACES = 24  # places of a weak blow
_TOP, _FEW = 20, 7  # beads above the first place of a strong blow; number of its places
_SAMPLES = 40.0  # per unit of time


@cache
def front_width(k: float) -> float:
    """FWHM, in the scaled coordinate z, of the first lobe of a weak blow's front.

    >>> round(front_width(1.0), 9), round(front_width(1.5), 9)  # Airy's function, Hertz contacts
    (2.278027519, 2.235263174)
    """
    mu, turn = (k - 1) / (2 * (k + 1)), np.exp(1j * np.pi / 6)  # where s³ falls fastest

    y, weight = np.polynomial.legendre.leggauss(200)
    s, ds = turn * (y + 1) ** 3, 3 * turn * (y + 1) ** 2 * weight  # smooth at 0

    def front(z: float) -> float:
        wave = s**mu * np.exp(1j * (s**3 / 3 + z * s - np.pi * mu / 2))
        return float((wave @ ds).real)

    # From the first zero behind the lobe to where the front has faded.
    places = np.linspace(-3.0, 4.0, 141)
    return highest_pulse(Piecewise(places, np.vectorize(front))).fwhm


@dataclass(frozen=True)
class Upright:
    """A chain under its own weight, of ``beads`` beads that repeat the cell.

    tolerances: of the run that is read and of the less accurate run.
    """

    cell: Cell
    k: float
    beads: int
    tolerances: tuple[float, float] = (1e-5, 1e-4)

    @cached_property
    def masses(self) -> tuple[float, ...]:
        """Masses as floats, in units of their mean."""
        return tuple(
            float(mass * self.cell.size / self.cell.mass) for mass in self.cell.masses
        )

    @cached_property
    def theory(self) -> Background:
        """The long-wave field of the chain at rest."""
        return Background(self.cell, Power(self.k), 0)

    def sound(self, x: Any) -> Any:
        """Speed of sound c0(x)."""
        return np.sqrt(self.k * x ** ((self.k - 1) / self.k))

    @cached_property
    def prefactor(self) -> float:
        """Prefactor of x^{1/3} in the front's width."""
        spread = 3 * float(self.theory.I) * self.k / (3 - self.k)
        return front_width(self.k) * math.pow(spread, 1 / 3)

    def places(self, first: int, count: int) -> Array:
        """Depths in sites, at the first beads of some cells, equally spaced in ln x."""
        size = len(self.masses)
        return np.unique(
            np.geomspace(first, 0.9 * self.beads, count).astype(int) // size * size
        )

    def blown(self, velocity: float, **sensors: Any) -> Scene:
        """Scene of the chain struck at the top, until the sound wave is near the end."""
        flight = 2 * self.k / (self.k + 1) * self.beads / float(self.sound(self.beads))
        return struck(
            self.masses,
            self.beads,
            self.k,
            wall=1.0,
            gravity=1.0,
            velocities=(velocity,),
            duration=0.97 * flight,
            samples=math.ceil(_SAMPLES * flight),
            **sensors,
        )

    def fronts(self) -> tuple[Array, Array, Array]:
        """Depth x, width of the velocity in sites, and this width in a less accurate run.

        Means over a cell.
        """
        beads = np.add.outer(self.places(FIRST, _PLACES), np.arange(len(self.masses)))
        x = beads + 0.5  # half of its own weight is above a bead's middle

        def widths(run: Run) -> Array:
            moving = (run.signal("bead", i, "velocity") for i in run.scene.bead_sensors)
            times = [highest_pulse(velocity).fwhm for velocity in moving]
            return np.asarray((np.reshape(times, x.shape) * self.sound(x)).mean(axis=1))

        scene = self.blown(WEAK, bead_sensors=beads.ravel().tolist())
        fine, coarse = map(widths, repeated(scene, self.tolerances))
        return x.mean(axis=1), fine, coarse

    def fit(self, x: Array, width: Array, power: float) -> Array:
        """Exponent of the width, and prefactor of x^{1/3}; corrections x^-power and x^{-2/3}."""
        rows = np.stack((np.log(x), np.ones_like(x), x**-power, x ** (-2 / 3)), axis=1)
        free, held = (
            np.linalg.lstsq(matrix, values)[0]
            for matrix, values in (
                (rows, np.log(width)),
                (rows[:, 1:], width / np.cbrt(x)),
            )
        )
        return np.array([free[0], held[0]])

    def fitted(
        self, x: Array, width: Array, coarse: Array
    ) -> tuple[Estimate, Estimate]:
        """`fit` with errors, each the largest of three changes.

        The fit changes with the other correction, with the deeper half of the places alone, and
        with the less accurate run.
        """
        half, rest = len(x) // 2, (3 - self.k) / 3
        power, other = 2 * rest / (self.k + 1), rest / self.k
        values = self.fit(x, width, power)
        others = (
            self.fit(x, width, other),
            self.fit(x[half:], width[half:], power),
            self.fit(x, coarse, power),
        )
        off = np.max(np.abs(np.array(others) - values), axis=0)
        exponent, prefactor = map(Estimate, values.tolist(), np.abs(off).tolist())
        return exponent, prefactor

    def pulses(self, velocity: float) -> list[dict[str, float]]:
        """Force and width of the pulse at each place, beside the solitary wave; means over a cell.

        The force is dynamic, over the load. Both widths are FWHM in sites, the wave's at this force
        and load.
        """
        size = len(self.masses)
        contacts = np.add.outer(self.places(_TOP, _FEW), np.arange(2 * size))
        scene = self.blown(velocity, contact_sensors=np.unique(contacts).tolist())
        run, by_contact = simulate(scene, rtol=self.tolerances[0]), {}
        for track in tracks(run):
            pulse = first_pulse(track.force, 0.25**self.k)
            by_contact[track.number - 1] = pulse.arrival, pulse.peak, pulse.fwhm
        rows = []
        for cell in contacts:
            arrival, peak, fwhm = np.array([by_contact[contact] for contact in cell]).T
            load, force = float(cell[0] + (size + 1) / 2), peak[:size].mean()
            width = fwhm[:size].mean() * np.mean(
                size / (arrival[size:] - arrival[:size])
            )
            wave = loaded_wave(
                self.cell, force=float(load + force), precompression=load, k=self.k
            )
            solitary = float(wave.fwhm("force") / self.cell.spacing)
            rows.append(
                {
                    "site": load,
                    "ratio": float(force / load),
                    "width": float(width),
                    "solitary": solitary,
                }
            )
        return rows


@study(
    EXPONENT,
    option(
        "--masses",
        "Masses of a cell, such as 1,1/2; by default two chains.",
        read=quantities,
    ),
    option("--beads", "Number of beads.", default=3000),
)
def gravity(
    k: float = 1.5,
    masses: Sequence[Any] = (),
    beads: int = 3000,
    progress: Progress[Any] = iter,
) -> Report:
    """Width of a pulse down a chain under its own weight, weak and strong (five seconds).

    ``rows`` for weak blows: ``masses``, ``exponent_value`` and ``prefactor_value`` of the front's
    width in sites with their errors, ``prefactor_theory_value`` and ``error_value``
    (theory/lattice - 1). ``strong``: ``masses``, ``blow_value`` (the velocity), ``site_value``,
    ``ratio_value`` (dynamic over static force), ``width_value``, ``solitary_value`` and
    ``front_value``, the widths of the solitary wave there and of a weak blow's front.

    Raises `SceneError` for parameters out of range.
    """
    between(
        k,
        "k",
        1.1,
        1.75,
        "one from 1.1 to 1.75 is wanted; the nearer to 3, where the front's width ceases to go "
        "as the depth's third root, the more beads it takes to see it",
    )
    beads = integer(beads, "beads", 10 * FIRST, 20_000)
    cells = [Cell(row, spacing=1) for row in ([masses] if masses else CHAINS)]
    for cell in cells:
        for mass in cell.masses:
            numeric(mass, "mass")
        ratio = float(max(cell.masses) / min(cell.masses))
        between(ratio, "the largest mass over the least", 1, _UNLIKE)
    chains = [Upright(cell, k, beads) for cell in cells]
    jobs = [(chain, blow) for chain in chains for blow in (WEAK, *STRONG)]
    measured = {
        (chain, blow): chain.fronts() if blow == WEAK else chain.pulses(blow)
        for chain, blow in progress(jobs)
    }
    return _report(chains, measured)


_WEAK = (
    Column("masses", "masses", format=", ".join),
    Estimates("exponent", "exponent"),
    Estimates("prefactor", "prefactor"),
    Column("prefactor_theory_value", "theory", format=".4f"),
    Column("error_value", "off", format=percent),
)
_STRONG = (
    Column("masses", "masses", format=", ".join),
    Column("blow_value", "blow", format="g"),
    Column("site_value", "site", format=".0f"),
    Column("ratio_value", "F/F0", format=".3g"),
    Column("width_value", "FWHM (sites)", format=".2f"),
    Column("solitary_value", "solitary (sites)", format=".2f"),
    Column("front_value", "front (sites)", format=".2f"),
)

_WEAK_NOTE = f"""\
Weak blows, of {WEAK:g}: width in sites at x sites, from {FIRST} on, prefactor x^exponent."""
_STRONG_NOTE = """\
Strong blows: width of the dynamic contact force F on the load F0, of the solitary wave of
the same F on F0, and of a weak blow's front."""


def _report(
    chains: Sequence[Upright], measured: Mapping[tuple[Upright, float], Any]
) -> Report:
    weak, strong, panels = [], [], []
    for chain in chains:
        names = [str(mass) for mass in chain.cell.masses]
        x, width, coarse = measured[chain, WEAK]
        exponent, prefactor = chain.fitted(x, width, coarse)
        theory = chain.prefactor
        weak.append(
            {
                "masses": names,
                "exponent": exponent,
                "prefactor": prefactor,
                "prefactor_theory_value": theory,
                "error_value": theory / prefactor.value - 1,
            }
        )
        sites = np.geomspace(_TOP, chain.beads, 50)
        curves = [
            Curve("weak blow", x, width, "C0o"),
            Curve("front", sites, theory * np.cbrt(sites), "C0-"),
        ]
        for blow, colour in zip(STRONG, ("C1", "C2", "C3"), strict=True):
            pulses = measured[chain, blow]
            for pulse in pulses:
                row = {"masses": names, "blow_value": blow}
                row |= {f"{name}_value": number for name, number in pulse.items()}
                strong.append(row | {"front_value": theory * math.cbrt(pulse["site"])})
            at, width, solitary = (
                [p[n] for p in pulses] for n in ("site", "width", "solitary")
            )
            curves += [
                Curve(f"blow of {blow:g}", at, width, f"{colour}s"),
                Curve("solitary wave", at, solitary, f"{colour}--"),
            ]
        panels.append(
            Panel("site", "FWHM (sites)", tuple(curves), "xy", ", ".join(names))
        )
    return Report(
        f"Chains of {chains[0].beads} beads under their own weight, k = {chains[0].k:g}",
        (
            Table(_WEAK, weak, "rows", note=_WEAK_NOTE),
            Table(_STRONG, strong, "strong", note=_STRONG_NOTE),
        ),
        tuple(_findings(weak, strong)),
        tuple(panels),
        ("Units: the mean mass, A, D, g.",),
    )


def _findings(
    weak: Sequence[dict[str, Any]], strong: Sequence[dict[str, Any]]
) -> Iterator[Finding]:
    """The front's power law, and how much narrower than two waves strong pulses are."""
    for row in weak:
        of = ", ".join(row["masses"])
        exponent = row["exponent"]
        low, high = 1 / 3 - 0.02, 1 / 3 + 0.02
        yield Finding(f"{of}: exponent", exponent.value, low, high, exponent.error)
        over = row["prefactor"] * (1 / row["prefactor_theory_value"])
        yield Finding(f"{of}: prefactor/theory", over.value, 0.97, 1.03, over.error)
    narrower = []
    for row in strong:
        if len(row["masses"]) == 1:
            other = min(row["solitary_value"], row["front_value"])
            narrower.append(1 - row["width_value"] / other)
    if narrower:
        than = "equal beads: narrower than the narrower of solitary wave and front"
        # Measured at all k that are taken: -0.02 to 0.26, at 1,000 and 3,000 beads
        yield Finding(f"{than}, at least", min(narrower), low=-0.05)
        yield Finding(f"{than}, at most", max(narrower), high=0.3)


if __name__ == "__main__":
    gravity.main()
