"""Numbers of the pages on other lattices, read out of the text and computed again."""

import math
from fractions import Fraction
from itertools import chain

import numpy as np
import pytest
import sympy as sp

import lwa
from book.studies.disorder import disorder, single_losses
from book.studies.gravity import front_width
from book.studies.links import CASES, links
from book.studies.precompressed import precompressed
from book.studies.shock import shock
from book.studies.struck import struck
from book.studies.widths import widths
from lwa import Cell, LoadedChain, Material, Power, Sphere, canonical_wave, homogenize
from tests.book.prose import bounds, limited, said, told
from validation import Damping, Drive, Scene, measure, simulate
from validation.scenes.chains import PTFE_BEAD, STEEL_BEAD
from validation.scenes.chains import struck as struck_chain

HERTZ = Power("3/2")
PAIR = Cell.of_spheres([STEEL_BEAD, PTFE_BEAD])


def test_the_experiment_of_the_breather():
    steel = Sphere("28.84e-3", "9.525e-3", Material(E="193e9", nu="0.3"))
    aluminium = Sphere("9.75e-3", "9.525e-3", Material(E="73.5e9", nu="0.33"))
    cell = Cell.of_spheres([steel, aluminium])
    (_, low), (edge, _) = LoadedChain(cell, HERTZ, 20).bands.edges() / (2000 * math.pi)
    assert told("modes", "edge of the optical band is # kHz", edge)
    assert told("modes", "Left, at # kHz", edge * (1 - 1 / 250))
    (shaken,) = said("modes", "is shaken at # kHz")
    assert low < float(shaken) < edge
    pair = lwa.envelope(cell, law=HERTZ, precompression=20).numeric()
    mean = float(
        pair.mean_strain[0] / pair.strains[0] * pair.static_compressions[0] / 4
    )
    swing = (1 - math.sqrt(1 - 4 * mean)) / (
        2 * mean
    )  # contacts open at 1 = s - mean s²
    assert told("modes", "the estimate is #", swing**2 * 3 / 128)


# --- links


@pytest.mark.slow
def test_errors_of_exact_waves():
    """Errors fall with the wave; the stated bounds of a wave cover its error."""
    report = links()
    assert report.ok
    rows = report.document()["rows"]
    by_case = {case: [row for row in rows if row["case"] == case] for case in CASES}
    on = [row for row in by_case["neighbours"] if row["ratio_value"] is not None]
    (off,) = (row for row in by_case["neighbours"] if row["ratio_value"] is None)
    squares = [
        [100 * row["square_error_value"] for row in some] for some in (on, [off])
    ]
    limited("links", "is within # % up to $B = p_0$, and # % without load", *squares)
    widths = (100 * row["fwhm_error_value"] for row in (on[-1], off))
    assert told("links", "without load; the width is # % and # % off", *widths)
    for case, chains in CASES.items():
        for one, row in zip(chains(), by_case[case], strict=True):
            wave = lwa.loaded_wave(
                one.lattice, force=one.force, precompression=one.load
            )
            speed = wave.estimate("speed")
            assert abs(math.sqrt(row["square_value"]) - speed.value) < speed.error
            width = wave.estimate("fwhm", row["of"])
            assert abs(row["fwhm_value"] - width.value) < width.error


@pytest.mark.slow
def test_errors_of_struck_lattices():
    def errors(chosen, *names):
        return [[100 * row[f"{name}_error_value"] for row in chosen] for name in names]

    report = struck()
    assert report.ok
    rows = report.document()["rows"]
    flat = [r for r in rows if r["case"] == "packings" and r["strain_value"] < 1.1e-3]
    across, along = (
        [r for r in flat if r["chain"] == name] for name in ("across", "along")
    )
    limited("links", "the speed is within # %. The width", *errors(flat, "speed"))
    words = "The width is # % off across the rows, as in a chain, and # %"
    assert told(
        "links", words, errors(across, "fwhm")[0][0], errors(along, "fwhm")[0][0]
    )
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
        (abs(r["tuning_value"] - 1), r["ringing_value"])
        for r in rung
        if r["chain"] == "m_r = 3/10"
    )
    assert min(ring for _, ring in beside[:2]) > 4 * tuned[1]


# --- shocks


def test_edges_of_a_shock():
    """The strongest shock with a trailing edge, and the peak of a shock without load."""
    (most,) = said("shocks", r"trailing edge up to $c_- = #\,c_+$")
    found = lwa.shock(
        Cell([1], spacing=1), sp.Rational(most) ** 4, 1, law=HERTZ
    )  # c ∝ p^(1/4)
    assert float(found.trailing_speed) == pytest.approx(
        1.5**0.5 * (2 - float(most)), rel=1e-12
    )
    bare = lwa.shock(Cell([1], spacing=1), 1, 0, law=HERTZ)
    assert told("shocks", "for spheres #. There", bare.peak / bare.rise)


@pytest.mark.slow
def test_driven_chains():
    """The page's table, with the sentences about it; all findings hold."""
    chains = (
        {"jumps": (3,)},
        {"k": "3/2", "jumps": (2, 8)},
        {"k": "3/2", "jumps": (1,), "ahead": 0},
    )
    reports = [shock(duration=300, **one) for one in chains]
    assert all(report.ok for report in reports)
    rows = [row for report in reports for row in report.document()["rows"]]
    assert all(row["speed_error_value"] < 3e-4 * row["speed_value"] for row in rows)
    toda, powers = rows[0], rows[1:]

    def errors(rows, theory):
        return [
            [100 * row[f"{theory}_error_value"][n] for row in rows]
            for n in ("speed", "peak")
        ]

    limited(
        "shocks",
        "right within # % in speed and # % in strain",
        *errors(powers, "doubling"),
    )
    (agreement,) = said("shocks", "rule, edge and lattice agree to # %")
    exact = (
        *chain(*errors([toda], "doubling")),
        100 * toda["dispersion_error_value"]["speed"],
    )
    assert max(map(abs, exact)) < float(agreement)
    own = [[*chain(*errors(some, "canonical"))] for some in (powers, [toda])]
    limited("shocks", "up to # % for powers and # % for Toda's contacts", *own)
    spheres = {row["behind_value"]: row for row in powers if row["law"] == "k = 3/2"}
    slow = (-100 * spheres[n]["dispersion_error_value"]["speed"] for n in (3, 8))
    assert told("shocks", "it is # % too slow at $p_-/p_+ = 3$, # % at 8", *slow)
    *loaded, bare = (100 * row["plateau_error_value"] for row in rows)
    limited("shocks", "under a load is right within # %", loaded)
    assert told("shocks", "the plateau's strain is # % below", -bare)


@pytest.mark.slow
def test_a_wall_that_recedes_makes_a_fan():
    """c(p) = x/t between the edges c₋ and c₊; the lattice is about a site off at all times."""
    found, errors = lwa.shock(Cell([1], spacing=1), 1, 2, law=HERTZ), []
    for end in (200, 400):
        fan = [round(share * end) for share in np.linspace(1.29, 1.41, 5)]
        scene = struck_chain(
            (1.0,), 2 * end, wall=1.0, precompression=2**1.5, velocities=(), duration=end,
            drive=Drive(velocity=float(found.plateau)), contact_sensors=(5, *fan), samples=11,
        )  # fmt: skip
        plateau, *strains = simulate(scene, rtol=1e-7).compression[:, -1]
        assert plateau == pytest.approx(1, rel=1e-3)
        theory = (((np.array(fan) + 0.5) / end) ** 2 / 1.5) ** 2  # c² = F'(p) = 3/2 √p
        assert 1.1 < theory[0] < theory[-1] < 1.95
        errors.append(np.abs(strains / theory - 1).max())
    assert errors[0] < 0.02
    assert errors[1] < 0.6 * errors[0]


# --- a chain under load, and under its own weight


def test_gap_of_the_papers_chain():
    """Frequencies scale as the load to the power 1/6; the edges of the gap have a fixed ratio."""
    edges = [LoadedChain(PAIR, HERTZ, load).bands.edges() for load in (1, 10)]
    (power,) = said("pressed", "scales as $F_0^{#}$")
    scaled = 0.1 ** float(Fraction(power))
    assert edges[0][:, 1] / edges[1][:, 1] == pytest.approx(scaled, rel=1e-12)
    assert edges[0][1, 0] / edges[0][0, 1] == pytest.approx(
        math.sqrt(450 / 123), rel=1e-12
    )


@pytest.mark.slow
@pytest.mark.parametrize("masses", [(1,), (1, "1/2"), (1, "1/4")])
def test_lattice_beside_nesterenkos_relation(masses):
    rows = precompressed(masses=masses, ratios=(0.1, 0.3, 1, 3, 10)).document()["rows"]
    off = [100 * abs(row["error_value"]) for row in rows]
    words = "within # % of the line up to dynamic forces of # loads, and within # % up to # loads"
    numbers = said("pressed", words)
    assert off == sorted(off)
    assert numbers[1::2] == ["0.3", "10"]
    assert np.all(np.take(off, [1, -1]) < np.array(numbers[::2], float))


def test_front_of_an_upright_chain():
    """The rest is in `studies/test_gravity.py`."""
    assert told("pressed", r"$\ell_{3/2} = #$", front_width(1.5))
    A = float(Cell.of_spheres([STEEL_BEAD]).stiffnesses[0])
    unit = math.sqrt(9.81) * np.cbrt(0.45e-3 * 9.81 / A)  # √(g ℓ), ℓ = (m g/A)^{2/3}
    blow, shown = said("pressed", "a blow of # to steel beads of 4.76 mm is # m/s")
    assert float(blow) * unit == pytest.approx(float(shown), abs=5e-3)


# --- the paper's column, unequal masses, damping


@pytest.mark.slow
def test_unequal_masses():
    """Losses at one bead, and the decay along chains of random masses."""
    excess = np.array([0.0025, 0.005, 0.01, 0.02])
    basis, fits = np.stack([np.ones(4), np.sqrt(excess)], axis=1), []
    for sign, words in (
        (1, "holds within # % with $L_2 = #$ and $L_{5/2} = #$"),
        (-1, "bead costs more: $L_2 = #$ and $L_{5/2} = #$, within # %"),
    ):
        losses = [loss.value for loss in single_losses(sign * excess)] / excess**2
        fits.append(np.linalg.lstsq(basis, losses, rcond=None)[0])
        numbers = said("column", words)
        most = numbers.pop(0 if sign > 0 else -1)
        assert bounds(100 * (basis @ fits[-1] / losses - 1), most)
        assert fits[-1] == pytest.approx([float(x) for x in numbers], rel=0.02)
    # an upper bound for masses within a percent: heavier beads cost less
    assert 38 * np.dot(fits[1], (1e-4 / 3, 1e-5 / 3.5)) < 1e-4
    for spread, digits in ((0.1, 5), (0.2, 5), (0.4, 4)):
        found = disorder(spread=spread, chains=20, sites=200).data
        shown = said("column", f"| {spread} | # | # ± # |")
        keys = "theory_value", "decay_value", "decay_error_value"
        assert [float(x) for x in shown] == [round(found[key], digits) for key in keys]
        assert abs(found["theory_value"] / found["decay_value"] - 1) < 0.2
    local = disorder(spread=0.5, chains=20, sites=200).tables[0].records()[1:]
    ends = (row["decay_value"] for row in (local[0], local[-1]))
    assert told(
        "column", r"$\varsigma = 0.5$ the decay per site falls from # to #", *ends
    )


def test_speeds_of_the_papers_column():
    scene = Scene.of_cell(
        PAIR, 19, "3/2", velocities=(1.37,), duration=1.2e-3, samples=6001,
        bead_sensors=range(13, 35),
    )  # fmt: skip
    run = simulate(scene)
    column = dict(enumerate((measure(run.time, force) for force in run.bead_force), 14))
    force = (column[15].peak + column[34].peak) / 2
    for wave, words in (
        (homogenize(PAIR, k="3/2").pde.traveling_wave(), "theory is # to # % too slow"),
        (canonical_wave(PAIR, "3/2"), "too slow, and the canonical wave # to # %"),
    ):
        speed = float(wave.at_force(float(force), of="bead").speed)
        slow = [
            100
            - 100
            * speed
            * (column[b].arrival - column[a].arrival)
            / ((b - a) * 4.76e-3)
            for a, b in ((15, 33), (16, 34))
        ]
        assert told("column", words, *sorted(slow))
    drop = float(said("column", "from a height of # centimetres")[0]) / 100
    assert told("column", "striker at # m/s", math.sqrt(2 * 9.81 * drop))


@pytest.mark.slow
def test_the_papers_errors_of_the_width():
    wide = widths().document()
    met = {
        (d["quantity"], d["unit"]): len(d["reproduced"]) for d in wide["definitions"]
    }
    assert len(met) == 10  # "of ten definitions"
    assert [name.split()[0] for (name, _), n in met.items() if n > 1] == ["PTFE"]
    lines = wide["lines_value"]["linear"]
    assert lines["m1 ≫ m2"] / lines["m1 = m2"] == pytest.approx(math.sqrt(2), rel=1e-9)
    over, under = (
        float(x) / 100 for x in said("column", "With $+#$ % and $#$ % their ratio")
    )
    (middle,) = said("column", "the middle one is about $#$ %")
    for end, error in (("m1 ≫ m2", over), ("m1 = m2", under)):
        implied = (1 + error) * lines["m2/m1 = 0.27"] / lines[end] - 1
        assert 100 * implied == pytest.approx(float(middle), abs=0.05)


@pytest.mark.parametrize(("kind", "power"), [("contact", 1), ("kuwabara_kono", -1)])
def test_speed_or_slowness_is_linear_in_damped_chains(kind, power):
    scene = struck_chain(
        (1.0,), 160, duration=180.0, samples=9001, contact_sensors=range(30, 131, 20),
        damping=Damping(kind, 0.002),
    )  # fmt: skip
    run = simulate(scene)
    times = [measure(run.time, force).arrival for force in run.contact_force]
    slopes = np.diff(np.diff(times) ** -power)
    assert slopes[-1] == pytest.approx(slopes[0], rel=1e-3)
