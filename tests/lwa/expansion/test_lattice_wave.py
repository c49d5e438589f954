"""The lattice's wave in closed form beside exact waves and struck chains; the nearest theory."""

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Dimer, NoSolitaryWave, lattice_wave
from lwa.cell import k as symbol_k
from lwa.expansion.dimers import dimer_error, exponent_of_light_beads
from lwa.expansion.joined import FORMS, phi_series
from tests.lwa.expansion.test_exact_waves import lattice
from tests.lwa.wave.test_source import LANGUAGE, answers
from tests.test_errors import LOOSE, holds
from validation import simulate
from validation.pulses.pulse import measure
from validation.pulses.steady import point
from validation.scenes.chains import struck

EQUAL = Cell([1], spacing=1)
BOUNDS = dict.fromkeys(FORMS, 0.001) | {"speed": 1e-5}
RESULTS = {name: (name,) for name in ("speed", "momentum", "energy")}
RESULTS |= {name: ("fwhm", name) for name in ("strain", "force", "velocity")}


def test_closed_forms_are_the_lattices_at_every_k():
    """The stated bounds hold, and so does ±: near the deviation of some k, and not too large for
    nine numbers of ten. The short form of the speed is right to two in a thousand.
    """
    ratios = {name: [] for name in RESULTS}
    # The errors of the last six are the nearest to the deviations.
    spread = 1 + np.geomspace(0.01, 59, 6).round(3)
    for k in (*spread.tolist(), 1.15, 1.9, 2.4, 2.83, 4.5, 5.1):
        wave, exact = lattice_wave(EQUAL, k=k), lattice(k)[0]
        assert float(wave.short_speed) == pytest.approx(exact["speed"], rel=2e-3)
        for name, call in RESULTS.items():
            found = wave.estimate(*call)
            deviation = abs(found.value / exact[name] - 1)
            assert deviation <= BOUNDS[name], (k, name)
            assert deviation <= found.relative_error + 2e-12, (k, name)
            if deviation > 1e-11:
                ratios[name].append(found.relative_error / deviation)
    assert all(min(of_name) < 1.2 for of_name in ratios.values())
    assert np.mean(np.concatenate([*ratios.values()]) <= LOOSE) >= 0.9


def test_the_first_coefficient_of_the_speed_is_exact():
    """By hand, to all digits: c = 1 - ε/4 + …, c₂(1) = √8/π, c₂'/c₂ = (1 - 2 ln 2)/4 at k = 1."""
    first = (1 - sp.log(2)) / 2 / (1 - sp.sqrt(8) / sp.pi)
    assert abs(sp.Float(phi_series("speed", 0)[0], 30) - first.n(30)) < 1e-27


@pytest.mark.parametrize("name", FORMS)
def test_light_beads_that_follow_are_exact_to_first_order(name):
    """The exponent e of (1 + ω)^{-e} is the reduced chain's own, by its exact waves."""
    for k, bound in ((1.1, 1e-4), (1.5, 1e-3), (2.0, 4e-3), (3.0, 0.025)):
        low, high = (lattice(k, omega)[0][name] for omega in (-1e-3, 1e-3))
        slope = -np.log(high / low) / 2e-3
        e = exponent_of_light_beads(name).subs(symbol_k, sp.Rational(str(k)))
        assert float(e) == pytest.approx(slope, abs=bound)


def test_relative_errors_of_composed_results_add_up():
    wave = lattice_wave(EQUAL, k="5/2")
    errors = {name: wave.estimate(*RESULTS[name]).relative_error for name in RESULTS}
    for composed, parts in {
        ("effective_mass",): ("momentum", "momentum", "energy"),
        ("fwhm", "strain", "time"): ("strain", "speed"),
    }.items():
        total = sum(errors[part] for part in parts)
        assert wave.estimate(*composed).relative_error == pytest.approx(total, rel=1e-9)


def passage(k, omega, speed, length):
    """Momentum, energy and width of the heavy bead's velocity of a struck chain's leading pulse.

    They are those of the pulse whose force peaks at 1: ``∫ F dt`` and ``∫ F v dt`` over a contact.
    """
    at = 200
    chain = struck((1.0, omega), at + 40, k, duration=2.0 * at / speed, samples=2,
                   contact_sensors=(at, at + 1), bead_sensors=(at, at + 1, at + 2))  # fmt: skip
    run = simulate(chain, rtol=1e-7)
    coarse = np.linspace(0, chain.duration, 60001)
    first = run.signal("contact", at)(coarse)
    front = coarse[np.argmax(first > 0.02 * first.max())]
    # In units of the cell the pulse of force F is slower by F^{(k-1)/2k}.
    site = 1 / (speed * first.max() ** ((k - 1) / (2 * k)))
    time = np.linspace(front - length * site, front + 2.5 * length * site, 60001)
    forces = np.array([run.signal("contact", at + i)(time) for i in (0, 1)])
    beads = (run.signal("bead", at + i, "velocity")(time) for i in (0, 1, 2))
    velocities = np.array([*beads])
    peak = forces.max(axis=1).mean()
    speed *= peak ** ((k - 1) / (2 * k))
    powers = forces * (velocities[:-1] + velocities[1:]) / 2
    momentum, energy = np.trapezoid((forces, powers), time).mean(axis=1)
    return {
        "momentum": momentum / peak ** ((k + 1) / (2 * k)),
        "energy": energy / peak ** ((k + 1) / k),
        "velocity": measure(time, velocities[0]).fwhm * speed,
    }


# Between the points of the grid of measured deviations.
STEADY = [("7", "8/9"), ("3/2", "7/9")]
MORE = [("3/2", "41/150"), # the paper's dimer
        ("9/5", "1/35"), ("5/4", "1/9"), ("7/3", "1/7"), ("7/2", "3/7"), ("9/2", "1/60"),
        ("3/2", "1/3000"),
        ("8/5", "5/16"), ("6/5", "8/9"), ("11/2", "5/11"), ("16", "31/100"),
        ("50", "21/200")]  # fmt: skip


@pytest.mark.parametrize(
    ("k", "omega"),
    [*STEADY, *(pytest.param(*case, marks=pytest.mark.slow) for case in MORE)],
)
def test_the_error_of_a_dimers_wave(engine, k, omega):
    """± covers the steady pulse of a struck chain, and five of six are not too large."""
    k, omega = sp.Rational(k), sp.Rational(omega)
    wave = lattice_wave(Dimer(1, omega, spacing=1), k=k)
    steady = point(k, omega, 4).numbers
    known = {
        "speed": steady["speed"].value,
        "force": steady["width"].value,
        "strain": steady["strain_width"].value,
    }
    strain = wave.estimate("fwhm", "strain").value
    known |= passage(float(k), float(omega), known["speed"], strain)
    tight = 0
    for name, call in RESULTS.items():
        found = wave.estimate(*call)
        deviation = abs(found.value - known[name])
        assert deviation <= found.error, (name, found, known[name])
        tight += holds(found.error, deviation)
    assert tight >= 5
    if omega < sp.S.Half:  # whichever bead is listed first
        other = lattice_wave(Dimer(omega, 1, spacing=1), k=k)
        assert other.speed == wave.speed


def test_beside_ratios_without_a_steady_pulse_the_error_is_that_of_the_steady_one():
    """At k = 3/2 no pulse is steady for m2/m1 from 0.5 to 0.7; the grid's next ratio is 0.75."""
    steady, between = (
        dimer_error("force", sp.Rational("3/2"), ratio) for ratio in (0.75, 0.73)
    )
    assert between == pytest.approx(steady, rel=1e-6)  # the root of a rounded 0 counts


def test_the_nearest_theory_has_a_name():
    """Steady pulses alone have one; beyond the measured k its error is unknown."""
    for masses, k, theory in (
        ([1, 1, 1], "3/2", "equal"),
        (["0.123", "0.45"], "3/2", "follow"),
        ([1, "0.6"], "1.1", "follow"),
        ([1, "0.8"], 3, "alike"),
        ([1, "0.9"], 60, "alike"),
    ):
        wave = lattice_wave(Cell(masses, spacing=1), k=k)
        assert theory in wave.theory
        assert np.isfinite(wave.estimate("fwhm", "strain", "time").error)
    m = sp.Symbol("m", positive=True)  # the lighter is known, though the masses are not
    assert lattice_wave(Cell([m, 2 * m]), k="1.1").mass_ratio == sp.S.Half
    # on the grid of measured ratios, and between two of them, one of which decays
    for ratio, k in (("3/5", 2), ("13/100", 40)):
        with pytest.raises(NoSolitaryWave, match=ratio):
            lattice_wave(Dimer(1, ratio), k=k)
    assert np.isnan(lattice_wave(Dimer(1, "0.1"), k=61).estimate("speed").error)


@pytest.mark.parametrize("masses", [(1, 1), (1, "1/20"), (1, "9/10")])
def test_units_and_forces_enter_as_dimensions_demand(masses):
    """E ~ F δ, P ~ m δ/t with δ = (F/A)^{1/k}, t = √(m δ/F)."""
    k, m, A, F, D = 1.1, 4.0, 8.0, 27.0, 3.0
    delta = (F / A) ** (1 / k)
    t = np.sqrt(m * delta / F)
    one = lattice_wave(Cell(masses, spacing=1), k=k)
    scaled = Cell([4 * sp.Rational(x) for x in masses], [8, 8], 3)
    other = lattice_wave(scaled, k=k, force=27)
    for call, unit in {
        ("speed",): D / t,
        ("energy",): F * delta,
        ("momentum",): m * delta / t,
        ("effective_mass",): m,
        ("fwhm", "force", "length"): D,
        ("fwhm", "strain", "time"): t,
    }.items():
        found, unscaled = other.estimate(*call), one.estimate(*call)
        assert found.value == pytest.approx(unit * unscaled.value, rel=1e-12)
        error = pytest.approx(unit * unscaled.error, rel=1e-9, nan_ok=True)
        assert found.error == error


def test_a_wave_of_symbols():
    wave = lattice_wave(Cell(["m", "m"], ["A", "A"]), force="F")
    at = wave.at(m=2, A=3, D=1, F=5, k="3/2")
    assert at == lattice_wave(Cell([2], [3], 1), k="3/2", force=5)
    values = dict(zip(wave.cell.symbols, (3, 1, 2), strict=True))
    values |= {symbol_k: sp.Rational(3, 2), sp.Symbol("F", positive=True): 5}
    for call in (("speed",), ("fwhm", "strain", "time"), ("energy",)):
        found = float(read(wave, call).subs(values))
        assert found == pytest.approx(float(read(at, call)), rel=1e-12)
    B = sp.Rational(1, 7)  # dx/dt is V_s times τ/t at the force A (D B)^k
    scaled = at.at_force(3 * B ** sp.Rational(3, 2)).speed / at.cell.time_scale(at.k)
    assert float(at.scaled_speed(B)) == pytest.approx(float(scaled), rel=1e-14)
    assert r"\Gamma" in wave._repr_latex_()


CHAINS = {
    "equal": (Cell(["m"], ["A"]), {"m": 2, "A": 3}, "5/2"),
    "dimer": (Dimer("m1", "m2"), {"m1": 2, "m2": 0.25}, "3/2"),
}


@pytest.mark.parametrize("language", LANGUAGE)
@pytest.mark.parametrize("chain", CHAINS)
def test_a_program_computes_the_wave(tmp_path, language, chain):
    """Γ and the incomplete beta function are numbers."""
    cell, values, k = CHAINS[chain]
    wave = lattice_wave(cell, k=k, force="F")
    known = {"F": 5, **values, "D": 0.5}
    calls, expected = [], []
    for call in RESULTS.values():
        symbols = {str(symbol) for symbol in read(wave, call).free_symbols}
        # a function has the arguments that it depends on, in this order
        used = [float(known[symbol]) for symbol in known if symbol in symbols]
        calls.append(("_".join(call), *used))
        expected.append(float(read(wave.at(**known), call)))
    found = answers(language, wave.code(language), calls, tmp_path)
    assert found == pytest.approx(expected, rel=1e-14)


def read(wave, call):
    """The result of an attribute, or of a method and its arguments."""
    name, *arguments = call
    value = getattr(wave, name)
    return value(*arguments) if arguments else value
