"""Shocks of chains that a piston drives, on the lattice beside `lwa.shock`.

A = D = 1. The first bead of a chain of strain p₊ moves at the velocity v_p for which the plateau
behind the front has the strain p₋. Measured are, from the piston on:

- the plateau, the mean strain of a contact near the piston over the last tenth of the run. The
  trailing edge leaves the piston where r = c₋/c₊ < 2; else oscillations remain there.
- the speed s₊ of the leading pulse, from the times t(x) at which its peak passes contacts. It lags
  behind its edge by the logarithm of the time (Toda's and KdV's do), so that t = x/s₊ + a log x + b
  is fitted.
- the peak strain of the leading pulse at x → ∞, by the fit P + b/x.

The error of a fit is the difference to the fit through the farther half of the contacts.

Theories, for equal beads: El's leading edge; the doubling rule (the leading pulse is the solitary
wave whose beads move at 2 v_p) with the lattice's own wave, which is Toda's soliton or for powers
the wave by Newton's method; and the doubling rule with the canonical wave, in closed form.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from lwa import Cell, Power, Shock, shock as front
from lwa.base.exact import InputError, read_exact
from lwa.base.frozen import Estimate
from lwa.base.progress import Progress
from lwa.command.answer import attempt
from lwa.command.options import quantities
from lwa.law import ContactLaw, named
from validation.lattice.result import Run
from validation.lattice.simulate import simulate, simulate_many
from validation.pictures import Curve, Map, Panel
from validation.report.study import Report, option, study
from validation.report.table import Column, Estimates, Finding, Table
from validation.scenes.checks import between
from validation.scenes.forcing import Drive
from validation.scenes.scene import Scene
from validation.waves.solver import exact_wave

TODA = 0.5  # the a of its force
LAWS = named("exponential", TODA), Power("3/2"), Power(2)
JUMPS = "3/2", 2, 3  # strains behind the front over those ahead of it
SPAN = 0.25, 0.95  # of the way of the leading pulse, on which it is measured
CONTACTS = 16  # at which it is measured
NEAR = 4  # contacts from the piston to that of the plateau
SAMPLES = 10  # per unit of time
SHORTEST, SHOWN = 100.0, 120.0  # least time of a run, time of the picture
TOLERANCE = 1e-6  # rtol of the runs
Pair = tuple[float | None, float | None]  # speed and peak strain of the leading pulse


@study(
    option("--k", "Exponent of F = δ^k; by default Toda, 3/2 and 2.", read=read_exact),
    option(
        "--jumps",
        "Strains behind the front over that ahead; if that is 0, strains behind.",
        read=quantities,
        default=",".join(map(str, JUMPS)),
    ),
    option("--ahead", "Strain ahead of the front.", read=read_exact, default="1"),
    option("--duration", "Time for which the piston moves.", default=2500.0),
)
def shock(
    k: Any = None,
    jumps: Sequence[Any] = JUMPS,
    ahead: Any = 1,
    duration: float = 2500.0,
    progress: Progress[Any] = iter,
) -> Report:
    """Shocks of chains that a piston drives: plateau, leading speed and peak (half a minute).

    ``rows``: ``law``, ``behind_value``, ``ahead_value`` (strains), ``ratio_value`` (c₋/c₊),
    ``plateau_value`` (measured strain) with ``plateau_error_value`` (over p₋, less 1),
    ``speed_value`` and ``peak_value`` (of the leading pulse, with errors), and by theory
    ``doubling_value`` (the rule on the lattice's own wave) and ``canonical_value`` (the rule on the
    canonical wave), both {"speed", "peak"}, and ``dispersion_value`` {"speed"}, with
    ``…_error_value`` (theory over lattice, less 1).

    Raises `lwa.InputError` for parameters out of range.
    """
    end = between(
        duration, "duration", SHORTEST, math.inf, f"at least {SHORTEST:g} is wanted"
    )
    start, cell = read_exact(ahead, "ahead"), Cell((1,), spacing=1)
    laws = LAWS if k is None else (Power(k),)
    steps = [read_exact(jump, "jump") for jump in jumps]
    behind = [step * start if start else step for step in steps]
    fronts = [front(cell, p, start, law=law) for law in laws for p in behind]
    for candidate in fronts:
        if candidate.kind != "shock":
            raise InputError(
                f"behind is {candidate.behind}: a strain above the one ahead is wanted"
            )
    driven = [Driven(candidate, end) for candidate in fronts]
    runs = simulate_many((chain.scene() for chain in driven), rtol=TOLERANCE)
    rows = [chain.row(run) for chain, run in zip(progress(driven), runs, strict=True)]
    return _report(driven, rows)


@dataclass(frozen=True)
class Driven:
    """A chain that a piston drives for a time, and the theory of its front."""

    theory: Shock
    duration: float

    def scene(self) -> Scene:
        """Build the scene, with sensors near the piston and along the leading pulse's path."""
        # Not beyond the pulse: the canonical wave of a steep law is too fast.
        rule, _ = self.theories["doubling"]
        reach = self.duration * min(self._fastest, 1.03 * rule if rule else math.inf)
        distances = {round(place) for place in np.linspace(*SPAN, CONTACTS) * reach} - {
            NEAR
        }
        return self._scene(self.duration, (NEAR, *sorted(distances)), SAMPLES)

    def _scene(
        self, duration: float, contacts: tuple[int, ...], samples: float
    ) -> Scene:
        """Build a scene of a given duration, with sensors at contacts counted from the piston."""
        chain = self.theory
        masses = (1.0,) * math.ceil(self._fastest * duration + 20)
        law: dict[str, Any] = {"law": chain.law}
        return Scene(
            masses=masses, stiffnesses=(1.0,) * (len(masses) - 1), wall=1.0,
            precompression=float(chain.law.at(chain.ahead)) if chain.ahead else 0.0,
            drive=Drive(velocity=float(chain.plateau)), duration=duration,
            contact_sensors=contacts, samples=math.ceil(samples * duration), **law,
        )  # fmt: skip

    @property
    def _fastest(self) -> float:
        """Upper bound of the speed of the leading pulse."""
        speeds = [speed for speed, _ in self.theories.values() if speed]
        return 1.02 * max(speeds, default=float(self.theory.sound(self.theory.behind)))

    @cached_property
    def theories(self) -> dict[str, Pair]:
        """Speed and peak strain of the leading pulse by theory; None where a theory gives none."""
        chain = self.theory
        edge, speed = (
            attempt(chain.leading_speed, rule) for rule in ("dispersion", "doubling")
        )
        closed = _number(speed), _number(attempt(lambda: chain.peak))
        own = attempt(own_wave, chain)
        own = (None, None) if isinstance(own, InputError) else own
        return {
            "doubling": own,
            "canonical": closed,
            "dispersion": (_number(edge), None),
        }

    @property
    def trailing(self) -> float | None:
        """Speed s₋ of the trailing edge; None where the theory gives none."""
        return _number(attempt(lambda: self.theory.trailing_speed))

    def row(self, run: Run) -> dict[str, Any]:
        """Table row: plateau, speed and peak on the lattice, with the theories' errors."""
        chain, strain = self.theory, float(self.theory.behind)
        plateau = float(run.compression[0][-len(run.time) // 10 :].mean())
        speed, peak = leading(run)
        cells: dict[str, Any] = {
            "law": _name(chain.law),
            "behind_value": strain,
            "ahead_value": float(chain.ahead),
            "ratio_value": float(chain.ratio) if chain.ahead else math.inf,
            "plateau_value": plateau,
            "plateau_error_value": plateau / strain - 1,
            "speed": speed,
            "peak": peak,
        }
        for name, (s, p) in self.theories.items():
            for quantity, value, own in (("speed", s, speed), ("peak", p, peak)):
                cells[f"{name}_value.{quantity}"] = value
                cells[f"{name}_error_value.{quantity}"] = _off(value, own.value)
        return cells

    def panels(self) -> tuple[Panel, Panel]:
        """Strain over position and time, and the profile at the end, with the edges drawn in."""
        chain, end = self.theory, min(self.duration, SHOWN)
        scene = self._scene(end, tuple(range(int(self._fastest * end))), 2)
        run = simulate(scene, rtol=TOLERANCE)
        x, strain = np.arange(0.5, len(run.compression)), run.compression
        speeds = {
            "s₊, doubling": (self.theories["doubling"][0], "C1--"),
            "s₊, dispersion": (self.theories["dispersion"][0], "C3:"),
            "s₋": (self.trailing, "C2-."),
        }
        known = [
            (name, s, style) for name, (s, style) in speeds.items() if s is not None
        ]
        paths = [Curve(name, [0, s * end], [0, end], style) for name, s, style in known]
        ends = [strain[:, -1].min(), strain[:, -1].max()]
        edges = [Curve(name, [s * end] * 2, ends, style) for name, s, style in known]
        title = f"{_name(chain.law)}, p₋ = {float(chain.behind):g}"
        return (
            Panel("sites from the piston", "time", tuple(paths), title=title,
                  map=Map("strain", x, run.time, strain.T)),
            Panel("sites from the piston", f"strain at time {end:g}",
                  (Curve("lattice", x, strain[:, -1], "C0-"), *edges)),
        )  # fmt: skip


def own_wave(chain: Shock) -> Pair:
    """Speed and peak strain of the exact solitary wave with bead velocity 2 v_p.

    Toda's soliton under (e^{aδ} - 1)/a has cosh κ = 1 + a v_p/c₊, the speed c₊ sinh κ/κ and the
    strain 2 ln(cosh κ)/a above the one ahead (Toda, Phys. Rep. 18, 1 (1975)).

    Raises `lwa.InputError` where there is none.
    """
    if _toda(chain.law):
        a, c = TODA, float(chain.sound(chain.ahead))
        angle = math.acosh(1 + a * float(chain.plateau) / c)
        return c * math.sinh(angle) / angle, float(chain.ahead) + 2 * math.log(
            math.cosh(angle)
        ) / a
    k, ahead, fastest = (
        float(chain.law.exponent),
        float(chain.ahead),
        2 * float(chain.plateau),
    )
    if not ahead:  # the speed of the beads scales as the strain to the power (k + 1)/2
        wave = exact_wave([1], k)
        factor = (fastest / wave.peak("velocity")) ** (2 / (k + 1))
        speed = wave.c * factor ** ((k - 1) / 2)
        return speed, wave.peak("strain") * factor

    def scaled(share: float) -> tuple[float, float, float]:
        """Speed, peak strain and bead velocity of the wave with background strain share · peak."""
        wave, factor = exact_wave([1], k, background=share), ahead / share
        pace = factor ** ((k - 1) / 2)
        strain, velocity = (wave.peak(name) * factor for name in ("strain", "velocity"))
        return math.sqrt(wave.c2) * pace, ahead + strain, velocity * pace

    guess = ahead / float(chain.peak)
    # By secants: the canonical wave is near, and each evaluation solves for a wave.
    share = scipy.optimize.newton(
        lambda x: scaled(x)[2] / fastest - 1, guess, x1=0.99 * guess, tol=1e-9 * guess
    )
    return scaled(share)[:2]


def leading(run: Run) -> tuple[Estimate, Estimate]:
    """Speed and peak strain of the leading pulse; the first sensor is near the piston."""
    x = np.array(run.scene.contact_sensors[1:], float)
    time, peak = np.array([_first_peak(run, i) for i in range(1, len(x) + 1)]).T

    def fits(last: slice) -> tuple[float, float]:
        columns = np.stack([x, np.log(x), np.ones_like(x)], axis=1)[last]
        slope = np.linalg.lstsq(columns, time[last])[0][0]
        return float(1 / slope), float(np.polyfit(1 / x[last], peak[last], 1)[1])

    pairs = zip(fits(slice(None)), fits(slice(len(x) // 2, None)), strict=True)
    speed, height = (Estimate.against(*pair) for pair in pairs)
    return speed, height


def _first_peak(run: Run, i: int) -> tuple[float, float]:
    """Time and strain of the first peak of a record that rises above half its largest rise.

    Behind a piston that pulls the strain falls.
    """
    values, time = run.compression[i], run.time
    signal = run.signal("contact", run.scene.contact_sensors[i], "compression")
    sign = float(np.sign(values[-1] - values[0]))
    rise = sign * (values - values[0])
    start = int(np.argmax(rise > rise.max() / 2))
    top = start + int(np.argmax(np.diff(rise[start:]) < 0))
    maximum = scipy.optimize.minimize_scalar(
        lambda t: -sign * float(signal(t)), bounds=(time[top - 1], time[top + 1]), method="bounded",
        options={"xatol": 1e-8},
    )  # fmt: skip
    return float(maximum.x), -sign * float(maximum.fun)


def _number(value: Any) -> float | None:
    return None if isinstance(value, InputError) else float(value)


def _off(value: float | None, true: float) -> float | None:
    return None if value is None else value / true - 1


def _toda(law: ContactLaw) -> bool:
    return not law.homogeneous


def _name(law: ContactLaw) -> str:
    return "Toda" if _toda(law) else f"k = {law.exponent}"


_PERCENT = "+.2%"


def _theory_columns(name: str, label: str, *quantities: str) -> list[Column]:
    """Columns of a theory's values, in JSON only, and of their errors."""
    return [
        column
        for quantity in quantities
        for column in (
            Column(f"{name}_value.{quantity}"),
            Column(
                f"{name}_error_value.{quantity}",
                f"{label} {_LETTERS[quantity]}",
                _PERCENT,
            ),
        )
    ]


_LETTERS = {"speed": "s₊", "peak": "peak"}
_COLUMNS = (
    Column("law", "law"),
    Column("behind_value", "p₋", format=".4g"),
    Column("ahead_value", "p₊", format=".4g"),
    Column("ratio_value", "c₋/c₊", format=".4g"),
    Column("plateau_value", "plateau", format=".5g"),
    Column("plateau_error_value", "over p₋", format=_PERCENT),
    Estimates("speed", "s₊"),
    Estimates("peak", "peak"),
    *_theory_columns("doubling", "rule:", "speed", "peak"),
    *_theory_columns("canonical", "canonical:", "speed", "peak"),
    *_theory_columns("dispersion", "El:", "speed"),
)


def _report(driven: Sequence[Driven], rows: Sequence[dict[str, Any]]) -> Report:
    findings = []
    for chain, cells in zip(driven, rows, strict=True):
        bound = 0.001 if _toda(chain.theory.law) else 0.006
        bounds = {
            f"{letter} by the rule": (f"doubling_error_value.{quantity}", bound)
            for quantity, letter in _LETTERS.items()
        }
        if cells["ratio_value"] < 2:
            bounds["plateau"] = "plateau_error_value", 0.005
        for label, (key, most) in bounds.items():
            if (error := cells[key]) is not None:
                name = f"{label}, {cells['law']}, p₋ = {cells['behind_value']:g}: relative error"
                findings.append(Finding(name, error, -most, most))
    return Report(
        "Chains driven by a piston: lattice and theory",
        (Table(_COLUMNS, rows, "rows"),),
        tuple(findings),
        max(
            driven, key=lambda chain: (chain.trailing is not None, chain.theory.ratio)
        ).panels(),
        (
            "Speeds in sites per unit of time; errors are theory over lattice, less 1. Rule: the "
            "lattice's own wave of beads at twice the piston's velocity. Canonical: the canonical "
            "wave, in closed form.",
        ),
    )


if __name__ == "__main__":
    shock.main()
