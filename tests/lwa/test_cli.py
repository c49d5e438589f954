"""The command `lwa` and its JSON contract."""

import json
import math
import subprocess
import sys

import pytest
import sympy as sp

from lwa import Dimer, homogenize
from lwa.cli import main


def run(capsys, *arguments):
    """Exit status, standard output and standard error of one call."""
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    captured = capsys.readouterr()
    return ended.value.code, captured.out, captured.err


def result(capsys, *arguments):
    status, out, err = run(capsys, *arguments, "--format", "json")
    assert (status, err) == (0, "")
    return json.loads(out)


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


def test_derive_json_with_numbers(capsys):
    found = result(capsys, "derive", "--k", "1.5", "--masses", "1,1", "--order", "6")
    assert (found["G"], found["I"]) == ("-D**2/96", "D**2/12")
    assert found["defect"] == []
    assert found["conservative"] is True
    assert {term["order"] for term in found["terms"]} == {3, 5}


def test_low_orders_have_no_G(capsys):
    found = result(capsys, "derive", "--order", "2")
    assert found["G"] is found["H"] is found["I"] is None
    assert found["terms"] == []
    assert found["ansatz"] == {"1": "1", "2": "m1/(m1 + m2)"}
    status, out, _ = run(capsys, "derive", "--order", "1")
    assert status == 0
    assert "order 2" in out


def test_optical_branch(capsys):
    found = result(capsys, "derive", "--branch", "optical", "--order", "2")
    assert found["lambda"] == "-m1/m2"
    assert found["G"] is None


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


def test_wave_json_in_a_length_unit(capsys):
    one = result(capsys, "wave", "--k", "3/2", "--masses", "0.45,0.123")
    mm = result(capsys, "wave", "--k", "3/2", "--masses", "0.45,0.123", "--spacing", "4.76")
    assert mm["width_value"] == pytest.approx(4.76 * one["width_value"], rel=1e-15)


def test_symbols_have_no_values(capsys):
    found = result(capsys, "wave", "--k", "q", "--masses", "a,b")
    assert not [name for name in found if name.endswith("_value")]
    assert "q" in found["beta"]


def test_amplitudes_out_of_range_have_no_value_but_a_logarithm(capsys):
    found = result(capsys, "wave", "--k", "1.00001", "--masses", "1,3")
    assert math.isfinite(found["log_B_value"])
    assert "NaN" not in json.dumps(found)
    assert "Infinity" not in json.dumps(found)


@pytest.mark.parametrize("command", ["derive", "wave"])
def test_python_source_computes_what_the_theory_says(capsys, command):
    status, out, _ = run(capsys, command, "--format", "python")
    assert status == 0
    module = {}
    exec(out, module)  # our own output, which is what is on trial
    theory = homogenize(Dimer("m1", "m2"))
    values = {"k": 1.75, "m1": 2.0, "m2": 3.0, "D": 0.5}
    if command == "derive":
        expected = theory.pde.H.subs(
            {s: sp.Rational(values[s.name]) for s in theory.pde.H.free_symbols}
        )
        assert module["H"](**values) == pytest.approx(float(expected), rel=1e-14)
        table = module["coefficients"](values["k"], values["m1"], values["m2"])
        assert table[3][((2, 1), (3, 1)), ()] * values["D"] ** 2 == pytest.approx(float(expected))
    else:
        wave = theory.pde.traveling_wave().at(k=1.75, m1=2, m2=3, D=0.5)
        assert module["beta"](**values) == pytest.approx(float(wave.beta), rel=1e-14)
        assert module["fwhm_force"](**values) == pytest.approx(float(wave.fwhm("force")), rel=1e-13)


@pytest.mark.parametrize("command", ["derive", "wave"])
def test_latex_is_one_balanced_display(capsys, command):
    status, out, _ = run(capsys, command, "--format", "latex")
    assert status == 0
    assert out.startswith("\\begin{align}")
    assert out.rstrip().endswith("\\end{align}")
    assert out.count("{") == out.count("}")


def test_text_of_the_paper(capsys):
    status, out, _ = run(capsys, "derive", "--order", "4")
    assert status == 0
    for line in (
        "  λ = 1",
        "  b2 = m1/(m1 + m2)",
        "  b3 = (2*m1 - m2)/(3*(m1 + m2))",
        "  b4 = m1*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**3)",
        "  G = D**2*m1**2*(k - 2)*(k - 1)/(6*(m1 + m2)**2)",
        "  vanishing identically: D^(k+2)",
    ):
        assert line in out.splitlines()
    assert "does not conserve momentum; see --closure full" in out


def test_full_closure(capsys):
    found = result(capsys, "derive", "--closure", "full", "--order", "6")
    assert found["defect"] == []
    assert found["conservative"] is False
    assert any(term["jet_t"] for term in found["terms"])
    assert {term["particle"] for term in found["slaved"]} == {2}
    status, out, _ = run(capsys, "derive", "--closure", "full", "--order", "6")
    assert status == 0
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


def test_text_of_the_wave(capsys):
    status, out, _ = run(capsys, "wave", "--k", "3/2", "--masses", "1,1")
    assert status == 0
    assert "β = sqrt(10)/(5*D) ≈ 0.632455532033676 D^-1" in out
    assert "p = 4/5" in out
    assert "the other root, p = 4/3" in out


def test_expansion(capsys):
    found = result(capsys, "expansion", "--k", "3/2", "--masses", "1", "--order", "10")
    assert [sp.Rational(a) for a in found["c2"][:3]] == [1, -sp.S.Half, sp.Rational(2, 5)]
    assert len(found["c2"]) == 11
    assert set(found["fwhm_value"]) == {"strain", "force", "velocity"}
    assert abs(found["fwhm_value"]["force"] - 1.411928) < found["error_estimate"] < 1e-4
    assert abs(found["c2_value"] - 0.819959) < found["error_estimate"]
    symbolic = result(capsys, "expansion", "--masses", "m1,m2", "--order", "2")
    assert "c2_value" not in symbolic
    status, out, _ = run(capsys, "expansion", "--k", "2", "--masses", "1", "--order", "3")
    assert status == 0
    assert "±" in out
    assert "c² = Σ a_n ε^n" in out


def test_dispersion(capsys):
    found = result(capsys, "dispersion", "--masses", "3,1", "--order", "6")
    assert found["acoustic"] == {"2": "1", "4": "-7/48", "6": "-59/5760"}
    assert found["optical"]["0"] == "16/3"
    assert result(capsys, "dispersion", "--masses", "1,2,3")["optical"] is None
    status, out, _ = run(capsys, "dispersion")
    assert status == 0
    assert "κ^4: -(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)" in out


BAD = [
    ("derive", "--k", "0"),
    ("derive", "--k", "nan"),
    ("derive", "--k", "1/0"),
    ("derive", "--k", "__import__('os').system('true')"),
    ("derive", "--masses", "0,1"),
    ("derive", "--masses", "1,-2"),
    ("derive", "--masses", "1,nan"),
    ("derive", "--masses", "1,2,3"),
    ("derive", "--masses", "1,,2"),
    ("derive", "--masses", "lambda: 0,1"),
    ("derive", "--stiffnesses", "1"),
    ("derive", "--order", "0"),
    ("derive", "--order", "2.5"),
    ("derive", "--order", "99999999999999999999"),
    ("derive", "--closure", "none"),
    ("derive", "--field", "center"),
    ("derive", "--closure", "full", "--field", "last"),
    ("derive", "--closure", "full", "--branch", "optical"),
    ("derive", "--branch", "up"),
    ("derive", "--format", "xml"),
    ("derive", "--spacing", "-1"),
    ("derive", "--nonsense"),
    ("wave", "--k", "1"),
    ("wave", "--k", "1/2"),
    ("wave", "--order", "3"),
    ("wave", "--k", "3", "--masses", "1,100"),
    ("wave", "--branch", "optical"),
    ("dispersion", "--order", "0"),
    ("expansion", "--order", "0"),
    ("expansion", "--k", "1"),
    ("expansion", "--k", "1/2", "--masses", "1"),
    ("expansion", "--order", "100"),
    ("dispersion", "--masses", "1,-1"),
    ("explain",),
]


@pytest.mark.parametrize("arguments", BAD, ids=" ".join)
def test_bad_input_is_one_line_and_status_two(capsys, arguments):
    status, out, err = run(capsys, *arguments)
    assert (status, out) == (2, "")
    assert err.startswith("lwa: ")
    assert err.count("\n") == 1


def test_the_installed_command():
    command = [sys.executable, "-c", "from lwa.cli import main; main()"]
    good = subprocess.run(
        [*command, "wave", "--k", "3/2", "--masses", "1,1"], capture_output=True, text=True
    )
    assert good.returncode == 0
    bad = subprocess.run([*command, "derive", "--k", "0"], capture_output=True, text=True)
    assert (bad.returncode, bad.stdout, bad.stderr.count("\n")) == (2, "", 1)


def test_a_reader_that_stops_early_is_no_fault():
    code = "import sys; from lwa.cli import main; main(['derive', '--order', '8'])"
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    process.stdout.close()
    assert process.stderr.read() == b""
    process.stderr.close()
    assert process.wait() in (0, 1)
