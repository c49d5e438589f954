"""Generated functions, run in their own languages, against 50 digits."""

import ctypes
import json
import shlex
import subprocess
from functools import cache
from itertools import product

import mpmath
import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Dimer, canonical_wave, homogenize
from lwa.base.words import QUANTITIES
from lwa.wave.source import LANGUAGES, module, wave_functions
from tests.lwa.command.answers import run

PROGRAMS = {"c": "cc", "javascript": "node"}
"""Programs that run or compile the generated languages."""

STRICT = shlex.split("-std=c99 -O2 -Wall -Wextra -pedantic -Werror -shared -fPIC")
ANSWER = """
const calls = JSON.parse(require("fs").readFileSync(0));
console.log(JSON.stringify(calls.map(([name, ...values]) => eval(name)(...values))));
"""


def answers(language, source, calls, folder):
    """Values of the generated functions for calls (name, *numbers)."""
    if language == "numpy":
        found = {}
        exec(source, found)  # our own output
        return [float(found[name](*values)) for name, *values in calls]
    if language == "javascript":
        ended = subprocess.run(
            ["node", "--eval", source + ANSWER],
            input=json.dumps(calls),
            capture_output=True,
            check=True,
            text=True,
            timeout=120,
        )
        return json.loads(ended.stdout)
    file, library = folder / "lwa_wave.c", folder / "lwa_wave.so"
    file.write_text(source + "\n", encoding="utf-8")
    subprocess.run(["cc", *STRICT, "-o", library, file, "-lm"], check=True, timeout=120)
    loaded = ctypes.CDLL(str(library))
    found = []
    for name, *values in calls:
        function = getattr(loaded, name)
        function.restype = ctypes.c_double
        found.append(function(*map(ctypes.c_double, values)))
    return found


GRID = {
    "k": (1.01, 1.5, 1.6, 1.999, 2.0, 3.5, 7.875),
    "m1": (1.0,),
    "m2": (1e-3, 0.2733, 1.0, 3.0, 99.0),
    "D": (1.0,),
}
NEAR_1 = {"k": tuple(1 + 2.0**-n for n in (10, 20, 40))}
STIFF = {
    "k": (1.01, 1.5, 8.0),
    "m1": (0.3, 7.0),
    "m3": (1.1,),
    "D": (0.7,),
    "A1": (0.02, 50.0),
}
WAVES = {
    "paper": (homogenize(Dimer("m1", "m2")).pde.traveling_wave(), GRID),
    "k near 1": (canonical_wave(Cell([1], spacing=1)), NEAR_1),
    "three": (canonical_wave(Cell(["m1", 2, "m3"], ["A1", 1, 8])), STIFF),
    # an integer of more than 64 bits, which C does not have
    "long": (canonical_wave(Dimer("m1", 10**20, spacing=1), "3/2"), {"m1": (3e19,)}),
    "numbers": (homogenize(Dimer(1, 1, spacing=1), k="3/2").pde.traveling_wave(), {}),
    # a word of a language, names of the module's own, a Greek letter
    "names": (
        canonical_wave(Cell(["np", "width", "double", "μ"], spacing="speed"), "3/2"),
        {"np": (1.0,), "width": (2.0,), "double": (0.5,), "μ": (3.0,), "speed": (0.7,)},
    ),
}
"""The paper's wave, all parameters symbols; unlike contacts; no parameter at all."""
PARTS = (0.0, 1e-3, 0.1, 0.3, 0.6, 0.9, 0.999, 1 - 1e-9, 1 + 1e-9, 1.5, 3.7)
"""Places in parts of half the width."""
OFF = mpmath.mpf("1e-14")
FIXED = {"B": 3.0, "V_s": 0.5, "F": 2.0}


@cache
@mpmath.workdps(50)
def expected(name):
    """A function's name, its arguments by name, and bounds of its value, by the closed forms.

    Values are good to 1e-14, near the edge of the domain of waves to 1e-14 over the distance; the
    profile to 1e-14 B where ξ is off by 1e-14 of itself.
    """
    wave, grid = WAVES[name]
    formulas = {
        "coefficient_sum": wave.coefficient_sum,
        "speed_factor": wave.speed_factor,
        "log_speed_factor": sp.log(wave.speed_factor),
        "beta": wave.beta,
        "width": wave.width,
        "speed": wave.speed(),
        "amplitude": wave.amplitude(),
        "time_scale": wave.time_scale,
        "strain": wave.at_force("F").strain,
        "speed_at_force": wave.at_force("F").speed,
        "power": wave.m,
    }
    for quantity in QUANTITIES:
        formulas[f"fwhm_{quantity}"] = wave.fwhm(quantity)
    letters = sorted(sp.Tuple(*formulas.values()).free_symbols, key=str)
    numbers = sp.lambdify(letters, list(formulas.values()), "mpmath")
    rows = []
    for values in product(*grid.values()):
        given = FIXED | dict(zip(grid, values, strict=True))
        arguments = [mpmath.mpf(given[str(letter)]) for letter in letters]
        point = dict(zip(formulas, numbers(*arguments), strict=True))
        if min(point["coefficient_sum"], point["speed_factor"]) <= 0:
            continue
        m, beta = point.pop("power"), point["beta"]
        near = min(1, point["coefficient_sum"], point["speed_factor"])
        for function, value in point.items():
            if 1e-300 < abs(value) < 1e300:
                off = abs(value) * OFF / near
                rows.append((function, given, value - off, value + off))
        for part in PARTS if name in ("three", "numbers") else ():
            xi = float(part * mpmath.pi / beta / 2)
            bounds = []
            for phase in (beta * xi * (1 + OFF), beta * xi * (1 - OFF)):
                bounds.append(3 * max(0, mpmath.cos(min(phase, mpmath.pi / 2))) ** m)
            doubt = 3 * OFF if part < 1 else 0  # outside of the support v is 0
            for place in (xi, -xi):
                at = given | {"xi": place}
                rows.append(("profile", at, bounds[0] - doubt, bounds[1] + doubt))
    assert len(rows) > 10
    return rows


LANGUAGE = [
    pytest.param(name, marks=pytest.mark.optional(PROGRAMS[name]))
    if name in PROGRAMS
    else name
    for name in LANGUAGES
]


@pytest.mark.parametrize("language", LANGUAGE)
@pytest.mark.parametrize("name", WAVES)
def test_closed_forms_and_profiles_are_good_to_1e14(tmp_path, language, name):
    functions, rows = wave_functions(WAVES[name][0]), expected(name)
    calls = [
        (function, *(values[s.name] for s in functions[function].arguments))
        for function, values, _, _ in rows
    ]
    source = module([*functions.values()], language, [name])
    found = answers(language, source, calls, tmp_path)
    for value, (function, values, low, high) in zip(found, rows, strict=True):
        assert low <= value <= high, (function, values)


def test_numpy_broadcasts_and_takes_integers():
    found = {}
    exec(WAVES["paper"][0].code("numpy"), found)
    chain = {"k": 1.5, "m1": 1, "m2": 1, "D": 1}
    xi = np.linspace(-9, 9, 37)
    outside = np.abs(xi) > found["width"](**chain) / 2
    assert np.all((found["profile"](xi=xi, B=2, **chain) == 0) == outside)
    ratio = np.array([1, 10])
    large = found["beta"](k=2, m1=10**12, m2=ratio * 10**12, D=3)  # 10^26: no int64
    assert large == pytest.approx(found["beta"](k=2, m1=1, m2=ratio, D=3), rel=1e-15)


def test_arguments_have_one_order_in_all_languages():
    functions = wave_functions(canonical_wave(Cell(["z", "a"], ["y", "b"], "L"), "q"))
    names = {name: [s.name for s in f.arguments] for name, f in functions.items()}
    assert names["profile"] == ["xi", "B", "q", "z", "a", "y", "b", "L"]
    assert (
        names["beta"] == names["width"] == names["fwhm_force"] == names["profile"][2:]
    )
    assert names["speed"] == ["B", "q"]
    assert names["amplitude"] == ["V_s", "q"]
    # a symbol of the chain yields to the arguments
    assert "def beta(k, B_, D):" in canonical_wave(Cell(["B", 1])).code("numpy")


def test_the_command_prints_the_same(capsys):
    wave = homogenize(Dimer(1, "math"), k="3/2").pde.traveling_wave()
    line = ["wave", "--k", "3/2", "--masses", "1,math", "--format", "c"]
    assert run(capsys, *line) == (0, wave.code("c") + "\n", "")
