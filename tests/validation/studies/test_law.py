"""The contact law read off pulses: exact data, noise, the lattice, and bad files."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Material, Sphere
from validation.scenes.chains import STEEL_BEAD
from validation.scenes.scene import SceneError
from validation.studies.law import (
    _EXAMPLE,
    RATIO_ERROR,
    fit_power,
    law,
    speed_ratio,
    weights,
)
from validation.waves.solver import exact_wave

FORCES = np.geomspace(0.1, 10, 12)
GIVEN = {"masses": (2,), "spacing": 3}


def speeds(k, A, force=FORCES, mass=1, spacing=1):
    """V of the lattice's wave of F = A δ^k."""
    scaled = A ** (1 / k) * force ** ((k - 1) / k)
    c2 = float(speed_ratio(k)) * 2 / ((k + 1) * mass) * scaled
    return spacing * np.sqrt(c2)


def test_the_speed_ratio_is_that_of_the_exact_wave():
    """c² of the Hertz chain, 0.8199588, over 2/(k+1); at any other k within the error it states."""
    assert float(speed_ratio(1.5)) == pytest.approx(0.8199588213 * 1.25, rel=1e-10)
    assert float(speed_ratio(1.0)) == pytest.approx(1, rel=1e-9)
    for k in (1.05, 1.45, 2.3, 3.9):
        exact = exact_wave([1], k).c2 * (k + 1) / 2
        assert float(speed_ratio(k)) == pytest.approx(exact, rel=RATIO_ERROR)


@pytest.mark.parametrize(("k", "A"), [(1.5, 0.7), (2.0, 3.0)])
def test_a_power_law_is_recovered_from_its_speeds(k, A):
    noise = 1 + 1e-9 * np.random.default_rng(1).normal(size=len(FORCES))
    fit = fit_power(FORCES, speeds(k, A) * noise)
    assert abs(fit.k.value - k) <= fit.k.error < 1e-7
    assert abs(fit.A.value - A) <= fit.A.error < 1e-6
    assert fit.one_power
    assert abs(fit.hertz.value - A) <= fit.hertz.error or k != 1.5


def test_known_errors_weight_the_pulses():
    """Every second pulse has twenty times the noise: the scatter of k is its error."""
    rng = np.random.default_rng(3)
    exact = speeds(1.5, 1.0)
    noise = np.where(np.arange(len(FORCES)) % 2, 0.05, 0.0025)
    off = []
    for _ in range(40):
        force, speed = (1 + noise * rng.normal(size=(2, len(FORCES)))) * (FORCES, exact)
        weight = weights(force, speed, noise * force, noise * speed)
        off.append(fit_power(force, speed, weight).k.value - 1.5)
    scatter = np.std(off)
    # Residuals of 0 do not hide the noise.
    weight = weights(FORCES, exact, noise * FORCES, noise * exact)
    error = fit_power(FORCES, exact, weight).k.error
    assert 1.8 * scatter < error < 2.5 * scatter


def test_errors_in_a_file_come_in_two_positive_columns(saved):
    speed = speeds(1.5, 1.0, mass=2, spacing=3)
    columns = (FORCES, speed, FORCES / 100, speed / 100)
    names = "force,speed,force_error,speed_error"
    for given, header in (
        (columns[:3], "force,speed,force_error"),
        ((*columns[:2], 0 * FORCES, speed), names),
    ):
        with pytest.raises(SceneError, match="together, and positive"):
            law(saved(given, header))
    found = law(saved(columns, names), **GIVEN)
    for name, value in (("k", 1.5), ("A", 1.0)):
        assert found.data[name].value == pytest.approx(value, rel=1e-9)


def test_the_error_of_exact_data_covers_rounding():
    """The speeds are those of exact waves at a k where R is interpolated."""
    V = exact_wave([1], 3.4).c * FORCES ** (2.4 / 6.8)
    fit = fit_power(FORCES, V)
    for number, value in ((fit.k, 3.4), (fit.A, 1.0)):
        assert abs(number.value - value) <= number.error < 1e-9
    assert fit.k.error > 0
    assert fit.one_power
    # A ~ R^{-k}
    assert fit.A.error == pytest.approx(3.4 * RATIO_ERROR, rel=0.01)


def test_a_stiffness_beyond_the_numbers_of_a_computer_is_refused():
    """A ~ V³ at k = 3/2."""
    V = speeds(1.5, 1.0)
    assert fit_power(FORCES, 1e100 * V).A.value == pytest.approx(1e300, rel=1e-6)
    with pytest.raises(SceneError, match="no number of a computer"):
        fit_power(FORCES, 1e120 * V)


def test_a_curved_law_is_not_one_power():
    x = np.log(FORCES)
    fit = fit_power(FORCES, np.exp(x / 6 + 0.02 * x**2))
    assert fit.curvature.value == pytest.approx(0.02, rel=1e-9)
    assert not fit.one_power


def test_the_example_has_blows_on_the_steel_balls_that_help_names():
    """Hertz's stiffness of balls of 19.05 mm, by the modulus of 193 GPa."""
    ball = Sphere("29e-3", "9.525e-3", Material(E="193e9", nu="0.3"))
    (stiffness,) = Cell.of_spheres([ball]).stiffnesses
    force, _, speed, _ = np.loadtxt(_EXAMPLE.splitlines(), delimiter=",", skiprows=1).T
    # c is proportional to A^(1/3): a percent of the speed, by its rounding and scatter.
    of_balls = speeds(1.5, float(stiffness), force, 29e-3, 19.05e-3)
    assert speed == pytest.approx(of_balls, rel=0.01)


def test_the_modulus_comes_back_from_the_speeds_of_its_spheres(folder, saved):
    """Steel of 206 GPa under another modulus; a material of no sphere is refused."""
    steel = STEEL_BEAD.material
    sphere = Cell.of_spheres([replace(STEEL_BEAD, material=replace(steel, E=206e9))])
    mass, spacing = float(sphere.masses[0]), float(sphere.spacing)
    V = speeds(1.5, float(sphere.stiffnesses[0]), mass=mass, spacing=spacing)
    file = saved((FORCES, V), "force (N),speed (m/s)")
    ball = "[beads.ball]\nmass = 0.45e-3\nradius = 2.38e-3\nmaterial = 'steel 316'\n"
    (folder / "beads.toml").write_text(f"{ball}[chain]\ncell = ['ball']\n")
    found = law(file, spheres="beads.toml", material="steel 316").document()
    assert found["E_value"] == pytest.approx(206e9, rel=1e-9)
    assert abs(found["E_value"] - 206e9) <= found["E_error_value"]
    with pytest.raises(SceneError, match="material is 'PTFE'"):
        law(file, spheres="beads.toml", material="PTFE")


def test_the_command(document, folder, saved):
    """Without masses and a distance the law is in their units, and a note says so."""
    noise = 1e-6 * np.random.default_rng(3).normal(size=len(FORCES))
    V = speeds(1.5, 1.0, mass=2, spacing=3) * (1 + noise)
    data = saved((FORCES, V), "force (N),speed (m/s)")
    found = document(f"law {data} --masses 2 --spacing 3 --plot law.svg")
    assert found["k_value"] == pytest.approx(1.5, abs=found["k_error_value"])
    assert found["one_power"] is True
    assert (folder / "law.svg").exists()
    for given, told in (({}, True), ({"masses": (2,)}, True), (GIVEN, False)):
        text = law(data, **given).text()
        assert ("see --masses" in text) == told
        assert "One power is enough" in text


ROWS = "".join(f"{n},{n}\n" for n in range(1, 9))


@pytest.mark.parametrize(
    ("text", "options", "named"),
    [
        ("force,time\n1,2\n", {}, "no column is .speed."),
        ("F,V\n" + ROWS, {}, "columns={'force': '1', 'speed': '2'}$"),
        ("force,speed\n1,2\n", {}, "at least 6 pulses"),
        ("force,speed\n" + "-1,2\n" * 9, {}, "positive force and speed"),
        ("force,speed\n" + "1,2\n" * 9, {}, "1 different forces"),
        ("force,speed\n" + ROWS, {"masses": (1, 2, 3)}, "the cell has 3 beads"),
        ("force,speed\n" + ROWS, {"masses": (sp.Symbol("m"),)}, "mass is m"),
        ("force,speed\n" + ROWS, {"spacing": sp.Symbol("D")}, "spacing is D"),
    ],
)
def test_bad_files_are_refused(tmp_path, text, options, named):
    file = tmp_path / "data.csv"
    file.write_text(text)
    with pytest.raises(SceneError, match=named):
        law(file, **options)
