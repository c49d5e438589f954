"""The command `lwa` and its JSON contract."""

import math
import re

import numpy as np
import pytest
import sympy as sp

from lwa import Dimer, Material, Sphere, homogenize
from lwa.base import latex
from lwa.spheres import hertz
from tests.lwa.command.answers import STEEL_AND_PTFE, result, run, said

SYMBOLS = {s.name: s for s in homogenize(Dimer("m1", "m2")).pde.H.free_symbols}


def read(text):
    """A string of the JSON, as another program would read it."""
    return sp.sympify(text, locals=SYMBOLS)


def test_derive_json(capsys):
    found = result(capsys, "derive", "--order", "4")
    theory = homogenize(Dimer("m1", "m2"))
    assert found["lambda"] == "1"
    assert {int(n) for n in found["ansatz"]} == set(theory.ansatz)
    for n, b in found["ansatz"].items():
        assert sp.cancel(read(b) - theory.ansatz[int(n)]) == 0
    for name in "GHI":
        assert sp.cancel(read(found[name]) - getattr(theory.pde, name)) == 0
    assert [term["jet"] for term in found["terms"]] == [[[2, 3]], [[2, 1], [3, 1]], [[4, 1]]]
    assert all(term["order"] == 3 and term["jet_t"] == [] for term in found["terms"])
    D = SYMBOLS["D"]
    assert sp.cancel(read(found["terms"][0]["coefficient"]) * D**2 - theory.pde.G) == 0
    assert len(found["defect"]) == 2
    assert found["conservative"] is False
    assert found["vanishing"] == [2]


def test_wave_json(capsys):
    found = result(capsys, "wave", "--k", "3/2", "--masses", "1,1")
    assert found["beta"] == "sqrt(10)/(5*D)"
    assert found["beta_value"] == pytest.approx(math.sqrt(10) / 5, rel=1e-15)
    assert found["p"] == "4/5"
    assert [root["p"] for root in found["roots"]] == ["4/5", "4/3"]
    assert set(found["fwhm"]) == set(found["fwhm_value"]) == {"strain", "force", "velocity"}
    assert round(found["fwhm_value"]["force"], 4) == 1.4909
    assert found["width_value"] == pytest.approx(math.pi / found["beta_value"], rel=1e-15)
    for name in ("a", "mu", "eta", "sigma", "s", "B", "width", "speed"):
        assert isinstance(found[name], str)
        assert isinstance(found[f"{name}_value"], float)


def test_latex_is_that_of_the_results(capsys):
    for masses in ("m1,m2", "1,1"):
        out = said(capsys, "derive", "--masses", masses, "--format", "latex")
        theory = homogenize(Dimer(*masses.split(",")))
        assert out == latex.align(theory.latex_rows()) + "\n"
        assert "H &=" in said(capsys, "wave", "--masses", masses, "--format", "latex")


def test_text_of_the_paper(capsys):
    out = said(capsys, "derive", "--order", "4")
    for line in (
        "  λ = 1",
        "  b2 = m1/(m1 + m2)",
        "  b3 = (2*m1 - m2)/(3*(m1 + m2))",
        "  b4 = m1*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**3)",
        "  G = D**2*m1**2*(k - 2)*(k - 1)/(6*(m1 + m2)**2)",
        "  vanishing identically: D^(k+2)",
    ):
        assert line in out.splitlines()
    assert "does not conserve momentum; see --closure full" in " ".join(out.split())


def test_full_closure(capsys):
    found = result(capsys, "derive", "--closure", "full", "--order", "6")
    assert found["defect"] == []
    assert found["conservative"] is False
    assert any(term["jet_t"] for term in found["terms"])
    assert {term["particle"] for term in found["slaved"]} == {2}
    out = said(capsys, "derive", "--closure", "full", "--order", "6")
    assert "u_x^(-1) u_2xτ u_3xτ" in out
    assert "see --field center" in out


def test_canonical_field(capsys):
    chain = ("--closure", "full", "--field", "center")
    found = result(capsys, "derive", *chain, "--masses", "m1,m2,m3")
    assert found["conservative"] is True
    found = result(capsys, "wave", *chain, "--k", "3/2", "--masses", "1,0.2733")
    w = 0.2733
    assert found["beta_value"] == pytest.approx((1 + w) / math.sqrt(10 * (1 - w + w * w)))
    assert found["p"] == "4/5"
    found = result(capsys, "wave", *chain)
    assert found["speed_factor"] == "2/(k*(k + 1))"
    assert "Abs" not in found["p"]


def test_expansion(capsys):
    found = result(capsys, "expansion", "--k", "3/2", "--masses", "1", "--order", "10")
    assert [sp.Rational(a) for a in found["c2"][:3]] == [1, -sp.S.Half, sp.Rational(2, 5)]
    assert len(found["c2"]) == 11
    assert set(found["fwhm_value"]) == {"strain", "force", "velocity"}
    assert abs(found["fwhm_value"]["force"] - 1.411928) < found["error_estimate"] < 1e-4
    assert abs(found["c2_value"] - 0.819959) < found["error_estimate"]
    symbolic = result(capsys, "expansion", "--masses", "m1,m2", "--order", "2")
    assert "c2_value" not in symbolic
    out = said(capsys, "expansion", "--k", "2", "--masses", "1", "--order", "6")
    assert "±" in out
    assert "c² = Σ a_n ε^n" in out


def test_dispersion(capsys):
    found = result(capsys, "dispersion", "--masses", "3,1", "--order", "6")
    assert found["acoustic"] == {"2": "1", "4": "-7/48", "6": "-59/5760"}
    assert found["optical"]["0"] == "16/3"
    assert result(capsys, "dispersion", "--masses", "1,2,3")["optical"] is None
    out = said(capsys, "dispersion")
    assert "κ^4: -(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)" in out


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
    for name in ("strain", "compression", "speed", "bead_velocity", "force"):
        assert found[f"{name}_value"] == float(getattr(wave, name))
        assert abs(sp.N(sp.sympify(found[name]) / getattr(wave, name) - 1, 50)) < 1e-40
    for quantity in ("strain", "force", "velocity"):
        assert found["fwhm_value"][quantity] == float(wave.fwhm(quantity))
        assert found["fwhm_time_value"][quantity] == float(wave.fwhm(quantity, "time"))
    assert found["stiffnesses_value"] == [float(A)] * 2
    assert found["masses_value"] == [0.45e-3, 0.123e-3]
    assert (found["B_value"], found["spacing_value"]) == (found["strain_value"], 0.00476)
    assert (found["units"]["speed"], found["units"]["fwhm_time"]) == ("m/s", "s")
    out = said(capsys, "wave", "--spheres", spheres(), "--force", "10")
    for line in ("  spacing D = 0.00476 m", "  masses = 0.00045, 0.000123 kg"):
        assert line in out.splitlines()
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
    factors["N/m^(3/2)"] = 1e3**-1.5
    for name in (name.removesuffix("_value") for name in found if name.endswith("_value")):
        factor = factors[found["units"][name]] if name in found["units"] else 1.0
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


def test_a_force_in_the_cells_own_units(capsys):
    found = result(capsys, "wave", "--k", "3/2", "--masses", "1,1", "--force", "8")
    assert (found["compression"], found["B"]) == ("4", "4/D")
    assert found["speed_value"] == pytest.approx(math.sqrt(1.6), rel=1e-15)  # √(4/5 · 8^{1/3})
    assert "units" not in found
    found = result(capsys, "wave", "--force", "f")
    assert found["strain"] == "f**(1/k)/D"
    assert not [name for name in found if name.endswith("_value")]
    status, out, _ = run(capsys, "wave", "--k", "3/2", "--masses", "m", "--force", "f")
    assert (status, "peak contact force F = f" in out) == (0, True)


@pytest.mark.parametrize("options", ["", "--k 1", "--k 3/2 --masses 1,2", "--k 1.000000001"])
def test_powers_of_the_full_closure_are_written_once(capsys, options):
    """u_x^(k-1), u_x^(-1), never a sum of numbers, nor a power 0 or 1."""
    for style, power in (("text", r"\^\(([^)]*)\)"), ("latex", r"u_\{x\}\^\{([^}]*)\}")):
        arguments = ("derive", "--closure", "full", "--order", "5", *options.split())
        out = said(capsys, *arguments, "--format", style)
        powers = [p for p in re.findall(power, out) if "/" not in p and "D" not in p]
        assert powers
        assert all(re.fullmatch(r"-?[2-9]|-1|-?k(/2)?([+-]\d+)?", p) for p in powers)
