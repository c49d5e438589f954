"""Lines of the command `lwa` beside the values that Python gives, and numbers worked by hand."""

import math
import re

import pytest
import sympy as sp

from lwa import Cell, Dimer, canonical_wave, homogenize, loaded_wave, shock
from lwa.base import latex
from lwa.law import named
from tests.lwa.command.answers import result, said

HERTZ, EQUAL = sp.Rational(3, 2), Cell([1], spacing=1)
QUANTITIES = ("strain", "force", "velocity")
theory = homogenize(Dimer("m1", "m2"))
pressed = loaded_wave(Dimer(1, 3), rise=1, background="1/10", k=HERTZ)
symbolic = loaded_wave(Dimer("m1", "m2"), background="p0").field
smooth = loaded_wave(EQUAL, law=named("hertz2", 1, 2), force=3, precompression=1)
front = shock(EQUAL, 2, 1, k=HERTZ)
w = 0.2733
unlike = canonical_wave(Dimer(1, 3, spacing=1), HERTZ)
CANONICAL = {
    "canonical.speed_value": unlike.at_force(8).speed,
    "canonical.fwhm_value.force": unlike.fwhm("force"),
}

ANSWERS = {
    "derive --order 4": {
        **{name: getattr(theory.pde, name) for name in "GHI"},
        **{f"ansatz.{n}": b for n, b in theory.ansatz.items()},
        "lambda": "1", "conservative": False,
        "terms.0.jet": [[2, 3]], "terms.1.jet": [[2, 1], [3, 1]], "terms.2.jet": [[4, 1]],
        "terms.0.coefficient": theory.pde.G / theory.cell.spacing**2, "terms.0.jet_t": [],
    },
    "derive --closure full --field center --masses m1,m2,m3": {"conservative": True},
    "derive --law hertz2:1,1/2 --masses 1": {"law": "delta**(5/2)/2 + delta**(3/2)"},
    "wave --k 3/2 --masses 1,1": {
        "beta": "sqrt(10)/(5*D)", "beta_value": math.sqrt(10) / 5, "p": "4/5",
        "width_value": 5 * math.pi / math.sqrt(10),
    },
    "wave --closure full --field center --k 3/2 --masses 1,0.2733": {
        "beta_value": (1 + w) / math.sqrt(10 * (1 - w + w * w)), "p": "4/5",
    },
    "wave --closure full --field center": {"speed": "sqrt(2)*B**(k/2 - 1/2)/(sqrt(k)*sqrt(k + 1))"},
    "wave --k 3/2 --masses 1,1 --force 8": {
        "compression": "4", "B": "4/D", "speed_value": math.sqrt(1.6),  # √(4/5 · 8^{1/3})
        "units": None,
    },
    "wave --force f": {"B": "f**(1/k)/D", "speed_value": None},
    "wave --k 3/2 --masses 1,3 --background 1/10": {
        "background": "1/10", "speed": str(pressed.field.speed(pressed.field.rise)),
        "speed_value": pressed.field.speed(sp.S.One),
        **{f"fwhm_value.{q}": pressed.fwhm(q) / pressed.field.cell.spacing for q in QUANTITIES},
        **{f"kdv.{name}": str(getattr(pressed.field.kdv, name))
           for name in ("sound_speed", "nonlinearity", "dispersion")},
        "kdv.width": str(pressed.field.kdv.width()), "kdv.speed": str(pressed.field.kdv.speed()),
    },
    "wave --background p0": {
        "speed": str(symbolic.speed(symbolic.rise)), "speed_value": None,
    },
    "wave --k 1/2 --masses 1 --background 1": {
        "speed_value": None, "kdv.width": "sqrt(2)*D*sqrt(-1/B)", "kdv_value.width": 2**0.5,
    },
    "wave --law polynomial:-1/2,0 --masses 1 --background 0": {"speed_value": None},
    "wave --law hertz2:1,1 --masses 1 --background 0": {"kdv": None},
    "wave --law hertz2:1,2 --masses 1 --spacing 1 --precompression 1 --force 3": {
        "speed_value": smooth.speed, "speed_error_value": smooth.estimate("speed").error,
        **{f"fwhm_value.{q}": smooth.fwhm(q) for q in QUANTITIES},
        **{f"fwhm_time_value.{q}": smooth.fwhm(q, "time") for q in QUANTITIES},
        "sound_speed_value": smooth.sound_speed,
    },
    "dispersion --masses 3,1 --order 6": {
        "acoustic": {"2": "1", "4": "-7/48", "6": "-59/5760"}, "optical.0": "16/3",
    },
    "dispersion --masses 1,2,3": {"optical": None},
    "dispersion --precompression F0": {"band_edges_value": None},
    "expansion --masses m1,m2 --order 2": {"c2_value": None},
    "expansion --k 3/2 --masses 1": {
        "order": 8, "c2.1": "-1/2", "c2.2": "2/5", "c2_value": pytest.approx(0.819959, abs=1e-5),
        "fwhm_value.force": pytest.approx(1.411928, abs=2e-5),
    },
    # Widths of both contacts on the lattice.
    "expansion --k 11/10 --masses 1,1 --stiffnesses 1,6/25 --order 6": {
        "fwhm_value.force": pytest.approx(5.035, rel=0.004),
        "fwhm_contact_2_value.force": pytest.approx(4.549, rel=0.004),
    },
    "expansion --k 3 --masses 1,2,3 --order 6": {
        "c2_value": None, "fwhm_value": dict.fromkeys(QUANTITIES),
    },
    "wave --k 3/2 --masses 1": {
        "lattice.speed_value": pytest.approx(math.sqrt(0.819967 / 1.5), rel=1e-5),
        "lattice.fwhm_value.force": pytest.approx(1.411928, rel=1e-3),
        "lattice.fwhm_error_value.force": pytest.approx(1e-3 / 2, abs=1e-3 / 2),
    },
    "wave --k 3/2 --masses 1,2,3": {"lattice": None},
    # Numbers that do not depend on which bead is the first stand beside a first field.
    "wave --k 3/2 --spacing 1 --masses 1,3 --force 8": CANONICAL,
    "wave --k 3/2 --spacing 1 --masses 3,1 --force 8 --closure full --field first": CANONICAL,
    "wave --k 3/2 --masses 1,3": {"canonical.speed_value": unlike.speed(1)},
    "wave --k 3/2 --masses 1,3 --closure full": {"canonical": None},
    "envelope --masses 1,1/2 --k 3/2 --spacing 1 --background 2 --detuning 1/1000": {
        "kind": "bright", "branch": "1", "group_velocity_value": 0, "amplitude_value.0": 0,
        "amplitude_value.1": 2 * math.sqrt(0.032 / 0.75),  # p0 √(32 Δ/(k (k - 1)))
    },
    "shock --masses 1 --spacing 1 --k 3/2 --behind 2 --ahead 1": {
        "kind": "shock", "plateau_value": front.plateau, "peak": None,
        "leading_speed.doubling": None,
        **{f"leading_speed_value.{rule}": front.leading_speed(rule)
           for rule in ("doubling", "dispersion")},
        **{f"{name}_value": getattr(front, name)
           for name in ("trailing_speed", "peak", "peak_force")},
        **{f"{name}_error_value": front.estimate(name).error
           for name in ("trailing_speed", "peak", "peak_force")},
    },
    "shock --masses 1 --spacing 1 --k 3/2 --behind 1": {
        "trailing_speed_value": None, "leading_speed_value.dispersion": None,
    },
    "shock --masses 1,1/2 --k 3/2 --behind 2 --ahead 1": {
        "peak_value": None, "leading_speed_value.dispersion": None,
    },
    "shock --masses 1 --spacing 1 --k 3/2 --piston 1 --ahead 1": {"plateau_value": 1},
    "shock --masses 1 --spacing 1 --k 3/2 --behind m1": {
        "peak": shock(EQUAL, "m1", 0, k=HERTZ).peak, "leading_speed.dispersion": None,
    },
    "shock --masses 1 --spacing 1 --k 3/2 --behind 1 --ahead 2": {
        "kind": "rarefaction", "peak_value": None,
    },
    "shock --k 3/2 --behind 1 --ahead 2": {"trailing_speed_value": None},
}  # fmt: skip
SYMBOLS = {s.name: s for s in theory.pde.H.free_symbols}


def entry(found, path):
    """The value at a dotted path of a document; None without one."""
    for key in path.split("."):
        if isinstance(found, list):
            found = found[int(key)]
        else:
            found = None if found is None else found.get(key)
    return found


@pytest.mark.parametrize("line", ANSWERS)
def test_a_line_gives_the_values_of_python(capsys, line):
    found = result(capsys, *line.split())
    for path, expected in ANSWERS[line].items():
        ours = entry(found, path)
        if isinstance(expected, sp.Expr) and isinstance(ours, str):
            # The command's own text: JSON's exact values are promised to be readable by SymPy.
            assert sp.cancel(sp.sympify(ours, locals=SYMBOLS) - expected) == 0, path
        elif isinstance(expected, sp.Expr | float):
            assert ours == pytest.approx(float(expected), rel=1e-13), path
        else:
            assert ours == expected, path


TEXTS = {
    "derive --order 4": (
        "u_ττ = u_x^(k-1) u_xx + G u_x^(k-3) u_xx^3 + H u_x^(k-2) u_xx u_xxx + I u_x^(k-1) u_4x\n",
        "  λ = 1\n", "  b2 = m1/(m1 + m2)\n", "  b3 = (2*m1 - m2)/(3*(m1 + m2))\n",
        "  b4 = m1*(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**3)\n",
        "  G = D**2*m1**2*(k - 2)*(k - 1)/(6*(m1 + m2)**2)\n",
        "  vanishing identically: D^(k+2)\n", "does not conserve momentum",
    ),
    "derive --closure full --field first --order 6": (
        "u_x^(-1) u_xxτ u_xxxτ", "see --field center",
    ),
    "derive --law hertz2:1,1/2": (
        "phi2 = (15*delta + 6)/(10*delta + 12)", "F' u_xx + G F' u_x^(-2) u_xx^3",
    ),
    "derive --law exponential --format latex": (r"F' u_{xx} + G F' u_{x}^{-2} u_{xx}^{3}",),
    "wave --k 3/2 --masses m --force f": ("peak contact force F = f\n",),
    "wave --k 3/2 --masses 1,3 --background 1/10": (
        "at B = 1, D = 1:\n", "FWHM of the strain = 2.672, error unknown\n",
    ),
    "wave --k 3/2 --masses 1 --background 1": ("V_s = 1.0725 ± 0", "±: bound"),
    "wave --masses 1 --background p0 --format latex": (
        r"V_{s} &= ", r"c_{0} &= ", "p_{0} &= p_{0}",
    ),
    "wave --k 1/2 --masses 1 --background 1": ("B < 0",),
    "expansion --k 2 --masses 1 --order 6": ("±", "c² = Σ a_n ε^n"),
    "wave --k 2 --masses 1 --force 123456789012/1234567891": ("F = 123456789012/1234567891\n",),
    "expansion --k 3 --masses 1,2,3 --order 6": ("velocity: no sum at k = 3", "c²: no sum"),
    "wave --k 3/2 --masses 1 --format latex": (
        r"V_{s}\big|_{\mathrm{lattice}} &= 0.739354 \pm", r"\right) D",
    ),
    "wave --k 3/2 --masses 1,3/5": ("Note: m2/m1 is 3/5 at k = 3/2: the light beads resonate",),
    "dispersion --format latex": (r"\kappa^{4}",),
    "dispersion": ("κ^4: -(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)",),
    "dispersion --masses 1 --precompression 2": ("band 1",),
    "wave --k 3/2 --masses 0.123,0.45 --force 1 --spacing 1": ("≈ 1.671023972577", "≈ 2.096362"),
    "wave --k 3/2 --masses 1,1": ("V_s = 2*sqrt(30)*B**(1/4)/15 ≈ 0.730296743340221 B^(1/4)\n",),
    "envelope --masses 1,1/2 --k 3/2 --spacing 1 --background 2 --detuning 1/1000": (
        "bright breather, |Ψ| = a sech(b n):",
    ),
    "shock --masses 1 --spacing 1 --k 3/2 --behind 2 --ahead 1": (
        "peak strain, doubling = 2.89 ± 0.04\n", "±: bound",
    ),
    "shock --masses 1 --spacing 1 --k 3/2 --behind 1": (
        "no sound runs there", "go on oscillating",
    ),
}  # fmt: skip


@pytest.mark.parametrize("line", TEXTS)
def test_a_line_prints_what_a_reader_looks_for(capsys, line):
    out = said(capsys, *line.split())
    for words in TEXTS[line]:
        assert words in out, words


@pytest.mark.parametrize("load", ["--background", "--precompression"])
def test_a_load_of_zero_changes_nothing(capsys, load):
    options = ("wave", "--k", "3/2", "--masses", "1,2")
    assert result(capsys, *options, load, "0") == result(capsys, *options)


def test_the_lattices_own_wave_stands_first_if_its_error_is_known(capsys):
    for line, first in (
        ("--k 3/2 --masses 1", True),
        ("--k 3/2 --masses 0.45,0.123", True),
        ("--masses 1", False),
        ("--k 5 --masses 1,1/10", False),
    ):
        out = said(capsys, "wave", *line.split())
        assert (out.index("the lattice's own wave") < out.index("β")) == first, line


def test_latex_is_that_of_the_results(capsys):
    out = said(capsys, "derive", "--format", "latex")
    rows = theory.latex_rows()
    assert out.startswith(latex.align(rows).removesuffix("\n\\end{align}"))
    # As G, H and I, the defect of order 3 stands at D².
    defect = r"{u_{\tau\tau}^{(1)} - u_{\tau\tau}^{(2)}} &= D^{2} "
    assert defect in out
    assert "(2)" not in said(capsys, "derive", "--masses", "1,1", "--format", "latex")
    assert "H &=" in said(capsys, "wave", "--format", "latex")


@pytest.mark.parametrize(
    "options", ["", "--k 1", "--k 3/2 --masses 1,2", "--k 1.000000001"]
)
def test_powers_of_the_full_closure_are_written_once(capsys, options):
    """u_x^(k-1), u_x^(-1), never a sum of numbers, nor a power 0 or 1."""
    for style, power in (
        ("text", r"\^\(([^)]*)\)"),
        ("latex", r"u_\{x\}\^\{([^}]*)\}"),
    ):
        line = f"derive --closure full --order 5 --format {style} {options}"
        powers = [
            p
            for p in re.findall(power, said(capsys, *line.split()))
            if not {*p} & {*"/D"}
        ]
        assert powers
        assert all(re.fullmatch(r"-?[2-9]|-1|-?k(/2)?([+-]\d+)?", p) for p in powers)
