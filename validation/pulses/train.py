"""Pulses at several beads or contacts of a chain, and their mean speed, peak and width."""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import dataclass, replace

import numpy as np

from validation.lattice.run import Run
from validation.pulses.pulse import MeasureError, Pulse, highest_pulse, speed
from validation.pulses.sensors import tracks


@dataclass(frozen=True)
class Train:
    """A pulse at several beads or contacts: ``pulses`` of dynamic force by number, from 1.

    spacing : distance of neighbours.
    """

    pulses: Mapping[int, Pulse]
    spacing: float

    @classmethod
    def of(cls, run: Run, kind: str = "bead") -> Train:
        """Measure the pulses at the "bead" or "contact" sensors of a run, before the wall's echo.

        The last contact sensor must be the wall's, and all spacings equal. Raises `MeasureError` if
        a pulse is not wholly in the record.
        """
        end = float(run.time[np.argmax(run.contact_force[-1])])
        pulses = {}
        for track in tracks(run)[:-1]:
            if track.kind == kind:
                try:
                    pulses[track.number] = highest_pulse(track.force, end)
                except MeasureError as error:
                    place = f"{kind} {track.number}, before the wave reaches the wall"
                    raise MeasureError(f"{place}: {error}") from None
        return cls(pulses, run.scene.spacings[0])

    def only(self, wanted: Container[int]) -> Train:
        """Return the train of the pulses with the wanted numbers."""
        chosen = {number: pulse for number, pulse in self.pulses.items() if number in wanted}
        return replace(self, pulses=chosen)

    @property
    def speed(self) -> float:
        """Speed of the pulse from the first sensor to the last, a length per time."""
        first, last = min(self.pulses), max(self.pulses)
        return speed(self.pulses[first], self.pulses[last], (last - first) * self.spacing)

    @property
    def peak(self) -> float:
        """Mean peak force."""
        return float(np.mean([pulse.peak for pulse in self.pulses.values()]))

    @property
    def fwhm(self) -> float:
        """Mean FWHM, a time."""
        return float(np.mean([pulse.fwhm for pulse in self.pulses.values()]))
