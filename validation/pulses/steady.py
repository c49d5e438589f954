"""The steady pulse of a struck dimer chain: its width, speed and decay at one k and one ω.

Bead 0 of a chain of masses 1, ω, 1, … at rest is struck (with ``A = D = 1``), and the leading pulse
is recorded at `PLACES` cells at equal distances (the places). The law ``F = A δ^k`` has no scale of
its own. So a pulse that leaves energy behind in every cell comes to lose the same fraction of its
peak force F in each cell, ``F ~ e^{-d n}`` after n sites; the speed then scales as
``F^{(k-1)/(2k)}``, and the width, in sites, stays constant. All numbers are means over the two
contacts of a cell, from the stretch (two neighbouring places) where their errors are least. Each
number is compared with the stretch before, with a less accurate run, and with a stretch that is
`FARTHER` times as far as the last place.

A pulse that decays is overtaken in the end by a higher one from behind, as higher pulses are
faster. So at the far stretch the highest pulse must have the force predicted from the decay, within
`STEADY`. Otherwise the pulse is not steady and the point has no numbers (for spheres, ω from 0.49
to 0.7).
"""

from __future__ import annotations

import json
import math
import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import scipy
import sympy as sp

from lwa.base import Refusal
from lwa.base.arrays import Array
from lwa.base.exact import InputError, read_exact
from lwa.base.frozen import Estimate
from validation.lattice.cost import IntegrationError
from validation.lattice.result import Run
from validation.lattice.simulate import simulate
from validation.pulses.pulse import MeasureError, first_pulse
from validation.scenes.chains import struck

LABELS = {  # measured numbers and their labels
    "width": "FWHM of the contact force (sites)",
    "strain_width": "FWHM of the contact strain (sites)",
    "speed": "speed at contact force 1 (sites/time)",
    "decay": "decay of the peak force per site",
}
PLACES = 10  # cells at which the pulse is recorded
STRETCH = 4  # number of cells from one place to the next, for k ≥ 3/2
# Tolerances of the accurate run and of the run that gives its error. Of 80 numbers of 20 points
# none is outside its error and 7 have one more than thirty times too large; with 1e-6 they are 0
# and 21, with 3e-6 they are 4 and 4.
TOLERANCES = (2e-6, 1e-5)
# Distance of the far stretch over that of the last place: there the pulse must still be the
# highest. At four times the distance a number that nears its limit like n^{-1/2} is half way to it.
FARTHER = 4
# Largest difference of the force at the far stretch from that which the decay predicts, over it
STEADY = 0.1
_WEAKEST = 1 / 50  # peak force of the slowest pulse for which a run is long enough
# Version of a file of points: another one for another definition of a quantity.
VERSION = 5

Key = tuple[sp.Rational, sp.Rational]  # k and ω of a point


@dataclass(frozen=True)
class Point:
    """Measured numbers at one k and ω, or the reason why there are none."""

    k: sp.Rational
    omega: sp.Rational
    # Distances of both ends of the measured stretch from the struck bead
    sites: tuple[int, int] | None
    numbers: Mapping[str, Estimate]  # by the names `LABELS`
    missing: str | None = None  # reason without numbers


def cells_apart(k: float, stretch: int) -> int:
    """Return the number of cells between two measurements; more as k → 1, where wakes are long.

    >>> [cells_apart(k, 4) for k in (3, 1.5, 1.1)]
    [4, 4, 30]
    """
    # 1 at k of 3/2. The power is chosen, not derived: stretches are compared with one another, so
    # that stretches too short widen the errors and do no more harm.
    longer = math.pow(2 * (k - 1), -1.25)
    return math.ceil(stretch * max(1.0, longer))


def point(
    k: sp.Rational, omega: sp.Rational, stretch: int = STRETCH, farther: float = FARTHER
) -> Point:
    """Strike the chain and return the measured point; after a failure its ``missing`` says why.

    Parameters
    ----------
    k, omega : Rational
        Exponent of the contact law, and mass ratio.
    stretch : int
        Number of cells between two places for k of 3/2 or more, as of `cells_apart`.
    farther : float
        Distance over which the pulse must lead, 1.2 or more, over the last place's distance.
    """
    try:
        return _measured(k, omega, stretch, farther)
    except (InputError, IntegrationError, ArithmeticError) as error:
        return Point(k, omega, None, {}, str(error) or type(error).__name__)


def _measured(
    k: sp.Rational, omega: sp.Rational, stretch: int, farther: float
) -> Point:
    """Strike the chain and return the measured point; raise `MeasureError` if it is not steady.

    A rough run reaches the far stretch, and an accurate one the places near the striker. The
    numbers are those of the stretch with the least error.
    """
    cells = cells_apart(float(k), stretch)
    chain = StruckDimer(float(k), float(omega), 2 * cells)
    near = [n * chain.sites for n in range(1, PLACES + 1)]
    far = int(farther * near[-1])
    rtol, less = TOLERANCES
    distant = [*near, far - chain.sites, far]
    rough = chain.passages(chain.run(distant, chain.crossing(far), less))
    # The accurate run ends when the leading pulse has passed all places, and a place's time later:
    # the front of a later, slower pulse is no leading pulse.
    passed = rough["end"][:PLACES].max()
    until = (1 + 1 / PLACES) * passed
    fine = chain.passages(chain.run(near, until, rtol))
    numbers = chain.numbers(fine)
    less_accurate = chain.numbers(rough)
    errors = {}
    relative = []
    for name, values in numbers.items():
        # A number for each stretch. The rough run's last one is that of the far stretch; the one
        # before, of the long way there, means nothing.
        others = less_accurate[name]
        differences = (
            values[1:] - values[:-1],
            values[1:] - others[1 : PLACES - 1],
            # A number that approaches its limit like n^{-1/2} has come half way to it at 4 n.
            2 * (values[1:] - others[-1]),
        )
        error = np.abs(differences).max(axis=0)
        errors[name] = error
        # The decay may be 0: its error is compared with a decay that would change the force e-fold
        # over the stretch.
        scale = values[1:]
        if name == "decay":
            scale = np.full_like(scale, 1 / chain.sites)
        relative.append(error / scale)
    worst = np.max(relative, axis=0)
    if np.isnan(worst).all():
        raise MeasureError("not steady: the pulse does not arrive later at each place")
    best = np.nanargmin(worst)
    measured = {}
    for name, values in numbers.items():
        value = float(values[1 + best])
        measured[name] = Estimate(value, float(errors[name][best]))
    place = near[best + 1]
    farther_sites = far - near[-1]
    decayed = math.exp(-measured["decay"].value * farther_sites)
    expected = fine["peak"][-1] * decayed
    ratios = rough["highest"][-1] / expected
    higher = np.mean(ratios)
    if not abs(higher - 1) <= STEADY:
        raise MeasureError(
            f"not steady: at {far} sites the highest pulse has {higher:.3g} times the force that "
            f"the leading pulse's decay at {place} sites predicts"
        )
    ends = (place, place + chain.sites)
    return Point(k, omega, ends, measured)


@dataclass(frozen=True)
class StruckDimer:
    """A dimer chain of masses 1, ω whose first bead is struck."""

    k: float
    omega: float
    sites: int  # from one place of measurement to the next

    def crossing(self, sites: int) -> float:
        """Return the time in which the theory's pulse of force `_WEAKEST` passes sites."""
        # The speed is 2 F^q/√((k+1)(1+ω)), F the peak contact force, in the long-wave theory of
        # equal beads with the mean mass (1+ω)/2.
        q = (self.k - 1) / (2 * self.k)
        weak = math.pow(_WEAKEST, q)
        of_unit_force = 2 / math.sqrt((self.k + 1) * (1 + self.omega))
        return sites / (of_unit_force * weak)

    def run(self, places: Sequence[int], duration: float, rtol: float) -> Run:
        """Strike the chain and record the two contacts of each place, up to the last one."""
        sensors = tuple(place + side for place in places for side in (0, 1))
        options = {"contact_sensors": sensors, "duration": duration, "samples": 2}
        # The chain goes on behind the last place: by 12 sites, twice the five of a pulse of spheres
        # and two more, or by a stretch, which grows as pulses do for k → 1.
        behind = max(12, self.sites)
        masses = (1.0, self.omega)
        length = places[-1] + behind
        scene = struck(masses, length, self.k, **options)
        return simulate(scene, rtol=rtol)

    def passages(self, run: Run) -> dict[str, Array]:
        """Return numbers of the leading pulse at both contacts of each place, (places, 2), by name.

        Names are arrival, peak, width of the force, strain_width, end, and highest, the peak of the
        highest pulse. Raises `MeasureError` if a pulse does not pass all places in time.
        """
        # The leading pulse is the first whose compression exceeds a quarter of the greatest. As
        # F = δ^k, its force exceeds this share of the greatest.
        low = 0.25**self.k
        sensors = run.scene.contact_sensors
        found: dict[str, list[float]] = {}
        for contact in sensors:
            force = run.signal("contact", contact)
            highest = force(force.times).max()
            try:
                pulse = first_pulse(force, low)
                # Its width at half of its greatest compression is the FWHM of the strain.
                strain = first_pulse(force, low, 0.5**self.k)
            except MeasureError:
                end = run.scene.duration
                missing = (
                    f"the pulse has not passed {sensors[-2]} sites by t = {end:.3g}"
                )
                raise MeasureError(f"not steady: {missing}") from None
            numbers = {
                "arrival": pulse.arrival,
                "peak": pulse.peak,
                "width": pulse.fwhm,
                "strain_width": strain.fwhm,
                "end": pulse.fall,
                "highest": max(pulse.peak, highest),
            }
            for name, number in numbers.items():
                found.setdefault(name, []).append(number)
        return {name: np.reshape(row, (-1, 2)) for name, row in found.items()}

    def numbers(self, passages: Mapping[str, Array]) -> dict[str, Array]:
        """Return `LABELS` on each stretch, (stretches,); NaN where a pulse does not arrive later.

        Over N sites and the time T the peak force falls from F_1 to F_2. The decay is
        ``d = ln(F_1/F_2)/N`` and the speed at contact force 1 is ``c = N (e^z - 1)/(z T F_1^q)``,
        with ``q = (k-1)/(2k)`` and ``z = q d N``, as the integral of ``dn/(c F^q)`` over
        ``F = F_1 e^{-d n}`` is T.
        """
        elapsed = np.diff(passages["arrival"], axis=0)
        elapsed[elapsed <= 0] = np.nan
        logarithms = np.log(passages["peak"])
        fall = -np.diff(logarithms, axis=0)
        q = (self.k - 1) / (2 * self.k)
        scaled = passages["peak"] ** q
        # exprel(z) is (e^z - 1)/z.
        distance = self.sites * scipy.special.exprel(q * fall)
        speed = distance / (elapsed * scaled[:-1])
        # A width is a duration at a contact times the speed there.
        at_end = speed * scaled[1:]
        numbers = {
            "width": passages["width"][1:] * at_end,
            "strain_width": passages["strain_width"][1:] * at_end,
            "speed": speed,
            "decay": fall / self.sites,
        }
        return {name: values.mean(axis=1) for name, values in numbers.items()}


@contextmanager
def stored(path: Path) -> Iterator[tuple[dict[Key, Point], Callable[[Point], None]]]:
    """Yield the finished points of a file, and a function that stores a point on the disk.

    The file is an SQLite database. Its one table has a row for each finished point, the `Point` in
    JSON; the table's name holds `VERSION` and `STRETCH`. Raises `lwa.InputError` for another
    sweep's file, one that is damaged or cannot be written, and one that another process has opened.
    """
    try:
        with closing(sqlite3.connect(path, timeout=0, isolation_level=None)) as data:
            data.execute("pragma locking_mode = exclusive")
            data.execute("begin exclusive")
            own = f"points_{VERSION}_{STRETCH}"
            data.execute(f"create table if not exists {own} (point)")
            # Points of another version, or with another stretch, are in a table of another name.
            (tables,) = data.execute("select count(*) from sqlite_master").fetchone()
            if tables > 1:
                raise ValueError("it holds other data than points of this definition")
            data.execute("commit")

            def keep(point: Point) -> None:
                # Exact numbers, which JSON lacks, become texts.
                row = json.dumps(asdict(point), default=str)
                data.execute(f"insert into {own} values (?)", [row])

            points = {}
            for (row,) in data.execute(f"select point from {own}"):
                entry = json.loads(row)
                numbers = {}
                for name, number in entry["numbers"].items():
                    numbers[name] = Estimate(**number)
                # A tuple is a list in JSON, and exact numbers are texts.
                sites = entry["sites"]
                key = (
                    read_exact(entry["k"], "k"),
                    read_exact(entry["omega"], "omega"),
                )
                ends = sites and (sites[0], sites[1])
                points[key] = Point(*key, ends, numbers, entry["missing"])
            yield points, keep
    except (sqlite3.Error, ValueError, TypeError, LookupError) as error:
        if isinstance(error, Refusal):
            raise
        beside = path.with_stem(f"{path.stem}-2")
        raise InputError(f"file is {path}: {error}", file=str(beside)) from None
