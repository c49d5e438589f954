"""The command `lwa` and its JSON contract."""

import re

import numpy as np
import pytest
import sympy as sp

from lwa import Dimer, Material, Sphere, homogenize
from lwa.base import latex
from lwa.spheres import hertz
from tests.lwa.command.answers import STEEL_AND_PTFE, result, said


def test_latex_is_that_of_the_results(capsys):
    for masses in ("m1,m2", "1,1"):
        out = said(capsys, "derive", "--masses", masses, "--format", "latex")
        theory = homogenize(Dimer(*masses.split(",")))
        assert out == latex.align(theory.latex_rows()) + "\n"
        assert "H &=" in said(capsys, "wave", "--masses", masses, "--format", "latex")


@pytest.fixture
def spheres(tmp_path):
    """The file of the paper's dimer, with more or other lines where they are given."""
    file = tmp_path / "spheres.toml"

    def write(old="", new=""):
        file.write_text(STEEL_AND_PTFE.replace(old, new) if old else STEEL_AND_PTFE + new)
        return str(file)

    return write


def test_spheres_at_a_force_are_in_si_units(capsys, spheres):
    steel, ptfe = Material("193e9", "0.3"), Material("1.46e9", "0.46")
    A = hertz.stiffness(Sphere(1, "2.38e-3", steel), Sphere(1, "2.38e-3", ptfe))
    cell = Dimer("0.45e-3", "0.123e-3", stiffnesses=(A, A), spacing="4.76e-3")
    wave = homogenize(cell, k="3/2").pde.traveling_wave().at_force(10)
    found = result(capsys, "wave", "--spheres", spheres(), "--force", "10")
    for name in ("compression", "speed", "bead_velocity", "force"):
        assert found[f"{name}_value"] == float(getattr(wave, name))
        assert abs(sp.N(sp.sympify(found[name]) / getattr(wave, name) - 1, 50)) < 1e-40
    for quantity in ("strain", "force", "velocity"):
        assert found["fwhm_value"][quantity] == float(wave.fwhm(quantity))
        assert found["fwhm_time_value"][quantity] == float(wave.fwhm(quantity, "time"))
    assert found["B_value"] == float(wave.strain)
    assert (found["units"]["speed"], found["units"]["fwhm_time"]["force"]) == ("m/s", "s")
    out = said(capsys, "wave", "--spheres", spheres(), "--force", "10")
    for words in ("masses 0.00045, 0.000123 kg", f"A = {float(A):.15g}", "D = 0.00476 m"):
        assert words in out
    assert f"speed dx/dt = {found['speed_value']:.10f}"[:22] in out


def test_the_units_are_what_the_values_are_in(capsys, spheres):
    """The same spheres in grams, millimetres and milliseconds: N are N, and E is in 10^6 Pa."""
    found = result(capsys, "wave", "--spheres", spheres(), "--force", "10")
    lines = [
        ("193e9", "193e3"),
        ("1.46e9", "1.46e3"),
        ("2.38e-3", "2.38"),
        ("0.45e-3", "0.45"),
        ("0.123e-3", "0.123"),
    ]
    content = STEEL_AND_PTFE
    for old, new in lines:
        content = content.replace(old, new)
    other = result(capsys, "wave", "--spheres", spheres(STEEL_AND_PTFE, content), "--force", "10")
    factors = {"kg": 1e3, "m": 1e3, "s": 1e3, "N": 1.0, "m/s": 1.0, "1/m": 1e-3}
    units = found["units"] | {"fwhm": "m", "fwhm_time": "s"}
    for name in (name.removesuffix("_value") for name in found if name.endswith("_value")):
        factor = factors[units[name]] if name in units else 1.0
        for a, b in zip(flat(found[f"{name}_value"]), flat(other[f"{name}_value"]), strict=True):
            assert b == pytest.approx(factor * a, rel=1e-14), name


def flat(value):
    return list(value.values()) if isinstance(value, dict) else np.ravel(value)


def test_spheres_without_a_force_have_one_in_symbols(capsys, spheres):
    found = result(capsys, "wave", "--spheres", spheres())
    at = result(capsys, "wave", "--spheres", spheres(), "--force", "10")
    assert found["force"] == "F"
    assert found["fwhm_value"] == at["fwhm_value"]
    assert not {"speed_value", "force_value", "fwhm_time_value"} & set(found)
    speed = sp.sympify(found["speed"]).subs("F", 10)
    assert float(speed) == pytest.approx(at["speed_value"], rel=1e-15)
    out = said(capsys, "wave", "--spheres", spheres())
    assert "·F**(1/6) m/s" in out


@pytest.mark.parametrize("options", ["", "--k 1", "--k 3/2 --masses 1,2", "--k 1.000000001"])
def test_powers_of_the_full_closure_are_written_once(capsys, options):
    """u_x^(k-1), u_x^(-1), never a sum of numbers, nor a power 0 or 1."""
    for style, power in (("text", r"\^\(([^)]*)\)"), ("latex", r"u_\{x\}\^\{([^}]*)\}")):
        arguments = ("derive", "--closure", "full", "--order", "5", *options.split())
        out = said(capsys, *arguments, "--format", style)
        powers = [p for p in re.findall(power, out) if "/" not in p and "D" not in p]
        assert powers
        assert all(re.fullmatch(r"-?[2-9]|-1|-?k(/2)?([+-]\d+)?", p) for p in powers)
