"""Numbers of the pages on other lattices, computed again.

The numbers are read out of the pages: a number of the text that is changed turns a test red.
"""

import math
from itertools import chain

import pytest
import sympy as sp

from book.studies.links import CASES, links
from book.studies.shock import shock as driven
from book.studies.struck import struck
from lwa import Cell, LoadedChain, Material, Power, Sphere, envelope, loaded_wave, shock
from tests.book.prose import limited, said, told

HERTZ = Power("3/2")


def test_the_experiment_of_the_breather():
    steel = Sphere("28.84e-3", "9.525e-3", Material(E="193e9", nu="0.3"))
    aluminium = Sphere("9.75e-3", "9.525e-3", Material(E="73.5e9", nu="0.33"))
    cell = Cell.of_spheres([steel, aluminium])
    (_, low), (edge, _) = LoadedChain(cell, HERTZ, 20).bands.edges() / (2000 * math.pi)
    assert told("modes", "edge of the optical band is # kHz", edge)
    assert told("modes", "Left, at # kHz", edge * (1 - 1 / 250))
    (shaken,) = said("modes", "is shaken at # kHz")
    assert low < float(shaken) < edge
    pair = envelope(cell, law=HERTZ, precompression=20).numeric()
    mean = float(pair.mean_strain[0] / pair.strains[0] * pair.static_compressions[0] / 4)
    swing = (1 - math.sqrt(1 - 4 * mean)) / (2 * mean)  # contacts open at 1 = s - mean s²
    assert told("modes", "the estimate is #", swing**2 * 3 / 128)


# --- links


@pytest.mark.slow
def test_errors_of_exact_waves():
    """Errors fall with the wave; the stated bounds of a wave cover its error."""
    rows = links().document()["rows"]
    by_case = {case: [row for row in rows if row["case"] == case] for case in CASES}
    on = [row for row in by_case["neighbours"] if row["ratio_value"] is not None]
    (off,) = (row for row in by_case["neighbours"] if row["ratio_value"] is None)
    squares = [[100 * row["square_error_value"] for row in some] for some in (on, [off])]
    limited("links", "is within # % up to $B = p_0$, and # % without load", *squares)
    widths = (100 * row["fwhm_error_value"] for row in (on[-1], off))
    assert told("links", "without load; the width is # % and # % off", *widths)
    for case, chains in CASES.items():
        for one, row in zip(chains(), by_case[case], strict=True):
            wave = loaded_wave(one.lattice, force=one.force, precompression=one.load)
            assert abs(math.sqrt(row["square_value"]) - float(wave.speed)) < wave.speed_error
            assert abs(row["fwhm_value"] - row["fwhm_theory_value"]) < wave.fwhm_error(row["of"])


@pytest.mark.slow
def test_errors_of_struck_lattices():
    def errors(chosen, *names):
        return [[100 * row[f"{name}_error_value"] for row in chosen] for name in names]

    rows = struck().document()["rows"]
    flat = [r for r in rows if r["case"] == "packings" and r["strain_value"] < 1.1e-3]
    across, along = ([r for r in flat if r["chain"] == name] for name in ("across", "along"))
    limited("links", "the speed is within # %. The width", *errors(flat, "speed"))
    words = "The width is # % off across the rows, as in a chain, and # %"
    assert told("links", words, errors(across, "fwhm")[0][0], errors(along, "fwhm")[0][0])
    mixed = [r for r in rows if r["chain"] == "δ^3/2, δ^1"]
    words = "within # % over almost four decades of the force, while the width is off by up to # %"
    limited("links", words, *errors(mixed, "speed", "fwhm"))
    forces = [r["force_value"] for r in mixed]
    assert 8e3 < max(forces) / min(forces) < 1e4
    rung = [r for r in rows if r["case"] == "resonators"]
    known = [r for r in rung if r["speed_error_value"] is not None]
    words = "the speed is within # % and the width within # % where"
    limited("links", words, *errors(known, "speed", "fwhm"))
    (least,) = said("links", r"is at least $# \cdot 2\pi V_s$")
    assert all((r in known) == (r["tuning_value"] >= float(least)) for r in rung)
    tuned, *beside = sorted(
        (abs(r["tuning_value"] - 1), r["ringing_value"]) for r in rung if r["chain"] == "m_r = 3/10"
    )
    assert min(ring for _, ring in beside[:2]) > 4 * tuned[1]


# --- shocks


def test_edges_of_a_shock():
    """The strongest shock with a trailing edge, and the peak of a shock without load."""
    (most,) = said("shocks", r"trailing edge up to $c_- = #\,c_+$")
    found = shock(Cell([1], spacing=1), sp.Rational(most) ** 4, 1, law=HERTZ)  # c ∝ p^(1/4)
    assert float(found.trailing_speed) == pytest.approx(1.5**0.5 * (2 - float(most)), rel=1e-12)
    bare = shock(Cell([1], spacing=1), 1, 0, law=HERTZ)
    assert told("shocks", "for spheres #. There", bare.peak / bare.rise)


@pytest.mark.slow
def test_driven_chains():
    """The page's table, with the sentences about it."""
    chains = {"jumps": (3,)}, {"k": "3/2", "jumps": (2, 8)}, {"k": "3/2", "jumps": (1,), "ahead": 0}
    rows = [row for one in chains for row in driven(duration=300, **one).document()["rows"]]
    toda, powers = rows[0], rows[1:]

    def errors(rows, theory):
        return [[100 * row[f"{theory}_error_value"][n] for row in rows] for n in ("speed", "peak")]

    limited("shocks", "right within # % in speed and # % in strain", *errors(powers, "doubling"))
    (agreement,) = said("shocks", "rule, edge and lattice agree to # %")
    exact = *chain(*errors([toda], "doubling")), 100 * toda["dispersion_error_value"]["speed"]
    assert max(map(abs, exact)) < float(agreement)
    own = [[*chain(*errors(some, "canonical"))] for some in (powers, [toda])]
    limited("shocks", "up to # % for powers and # % for Toda's contacts", *own)
    spheres = {row["behind_value"]: row for row in powers if row["law"] == "k = 3/2"}
    slow = (-100 * spheres[n]["dispersion_error_value"]["speed"] for n in (3, 8))
    assert told("shocks", "it is # % too slow at $p_-/p_+ = 3$, # % at 8", *slow)
    loaded, bare = (
        [100 * r["plateau_error_value"] for r in part] for part in (rows[:-1], rows[-1:])
    )
    limited("shocks", "under a load is right within # %", loaded)
    assert told("shocks", "the plateau's strain is # % below", *(-error for error in bare))
