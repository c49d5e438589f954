"""The command `lwa-validate`, with one command for each study in `validation.studies`."""

from __future__ import annotations

import os
from collections.abc import Sequence

import click

from lwa.command.cli import HELP, Commands, help_end, run, version

STUDIES = {
    "compare": ("records", "Measured forces beside the simulation of their scene."),
    "exact": (
        "exact",
        "Exact solitary wave of the lattice: speed, widths and amplitudes.",
    ),
    "figures": (
        "paper",
        "The figures of Porter et al. (2008), computed (a few seconds).",
    ),
    "law": ("law", "Contact law from measured forces and speeds of pulses."),
    "limits": (
        "limits",
        "The theory's limit k → 1, against the lattice's own waves.",
    ),
    "materials": ("run", "Names and constants of the materials of beads."),
    "paper": (
        "paper",
        "The steel:PTFE chain of the paper: speed, peak force and FWHM.",
    ),
    "pulses": (
        "records",
        "Arrival, peak, FWHM and speeds of pulses in measured records.",
    ),
    "resonances": ("exact", "Mass ratios of the dimers with a solitary wave."),
    "run": ("run", "Pulses at the sensors of any scene, read from a file."),
    "sweep": (
        "sweep",
        "Width, speed and decay of a struck chain's pulse over k and m2/m1.",
    ),
}
"""Module and summary of each study, by the name of its function and command."""

HELP_TEXT = """\
Simulate chains with contacts F = A δ^k and compare them with the long-wave theory.

The exit status is 1 if a comparison fails, and 2 for bad input."""

EXAMPLES = (
    "lwa-validate paper",
    "lwa-validate run --example > scene.toml",
    "lwa-validate run scene.toml --plot forces.svg",
)

_ENVIRONMENT = {
    # Figures go to files: a display, or a notebook's shell, has no part in them.
    "MPLBACKEND": "agg",
    # Linear systems are small: on a busy machine a second thread only waits for the first
    # (`resonances --k 5` took 49 s of CPU time, not 6).
    "OPENBLAS_NUM_THREADS": "1",
    # Runs are parallel by Python's threads; numba refuses to load for a number below 1.
    "NUMBA_NUM_THREADS": "1",
}


@click.group(
    cls=Commands,
    package="validation.studies",
    table=STUDIES,
    context_settings=HELP,
    help=HELP_TEXT,
    epilog=help_end(EXAMPLES, "reference"),
)
@version
def validate() -> None:
    """The command `lwa-validate`."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa-validate`."""
    os.environ |= _ENVIRONMENT
    run(validate, "lwa-validate", arguments)
