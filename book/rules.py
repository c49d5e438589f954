"""Tables of measured rules: the largest errors of the theory in a range."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pulse import struck_pulse
from studies.disorder import disorder
from studies.links import links
from table import percent, table

from validation.report.study import Report

Row = Mapping[str, Any]
"""A wave that was measured."""


def worst(rows: Iterable[Row], key: str) -> float:
    """The value of the largest size."""
    return max((row[key] for row in rows), key=abs)


def loaded(chains: Mapping[str, Sequence[Row]]) -> Report:
    """Errors of the speed under a load, of the chains of the page by their names."""
    every = [row for rows in chains.values() for row in rows]
    shown = []
    for name, most, rows in (
        ("all three", 0.3, every),
        ("all three", 4.4, every),
        ("equal beads", 10, chains["equal beads"]),
    ):
        within = [row for row in rows if row["ratio_value"] <= most]
        shown.append((name, f"up to {most}", worst(within, "error_value")))
    last = chains["masses 1, 1/2"][-1]
    shown.append(("masses 1, 1/2", f"{last['ratio_value']:.1f}", last["error_value"]))
    error = "largest error of the speed", percent(2)
    return table(shown, "chain", "dynamic force, in loads", error)


def lattices(struck: Sequence[Row]) -> Report:
    """Errors of speed and width in struck lattices, and in waves of second neighbours."""
    far = [
        row | {"speed_error_value": row["square_error_value"] / 2}
        for row in links("neighbours").document()["rows"]
    ]
    rubber = [row for row in struck if row["chain"] == "δ^3/2, δ^1"]
    rung = [row for row in struck if row["case"] == "resonators"]
    packed = [
        row
        for row in struck
        if row["case"] == "packings" and row["strain_value"] < 1.1e-3
    ]
    across, along = (
        [row for row in packed if row["chain"] == name] for name in ("across", "along")
    )
    quarter = "second neighbours, a quarter of the stiffness"
    rules = (
        ("links δ^3/2 and δ", "no load, almost four decades of the force", rubber),
        ("resonators, m_r = 0.3 and 1", "no load, ω₀ ≥ 1.2 · 2πV_s", rung),
        (quarter, "up to B = p₀", [row for row in far if row["ratio_value"]]),
        ("the same", "no load", [row for row in far if not row["ratio_value"]]),
        ("packing across its rows", "strains to 10⁻³", across),
        ("packing along its rows", "strains to 10⁻³", along),
    )
    shown = []
    for name, reach, rows in rules:
        errors = (worst(rows, f"{of}_error_value") for of in ("speed", "fwhm"))
        shown.append((name, reach, *errors))
    heads = ("largest error of the speed", percent(2)), ("of the width", percent(1))
    return table(shown, "lattice", "range", *heads)


def between() -> Report:
    """Decay and width of a struck chain's pulse at mass ratios that are not special."""
    shown = []
    for omega in ("0.2", "0.5", "0.55", "0.57", "0.6", "0.65", "0.8"):
        pulse = struck_pulse(1.5, omega)
        shown.append((omega, pulse.decay, pulse.width))
    heads = ("force lost per site", percent(2)), ("FWHM in sites", ".2f")
    return table(shown, "ω", *heads)


def definitions(rows: Sequence[Row]) -> Report:
    """Errors of the paper's three lines by each definition of the width."""
    shown = []
    for row in rows:
        errors = row["error_value"]["linear"]
        shown.append((row["quantity"], row["unit"], *errors.values()))
    return table(shown, "FWHM of", "in", *((line, percent(1)) for line in errors))


def spreads() -> Report:
    """Decay of pulses in chains of random masses, beside the mean loss at single beads."""
    keys = "theory_value", "decay_value", "decay_error_value"
    shown = []
    for spread in (0.1, 0.2, 0.4):
        found = disorder(spread=spread, chains=20, sites=200).data
        shown.append((spread, *map(found.get, keys)))
    names = "mean of single losses", "decay per site", "±"
    return table(shown, "ς", *((name, ".5f") for name in names))
