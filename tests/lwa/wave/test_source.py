"""Generated functions, run in their own languages, against 50 digits."""

import ctypes
import json
import subprocess
from contextlib import ExitStack, contextmanager
from functools import cache
from itertools import product

import mpmath
import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Dimer, canonical_wave, homogenize
from lwa.wave.source import LANGUAGES, module, wave_functions
from tests.lwa.command.answers import run

PROGRAMS = {"c": "cc", "javascript": "node"}
"""Programs that run or compile the generated languages."""

in_every_language = pytest.mark.parametrize(
    "language",
    [
        pytest.param(name, marks=pytest.mark.optional(PROGRAMS[name])) if name in PROGRAMS else name
        for name in LANGUAGES
    ],
)

STRICT = ("-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror", "-shared", "-fPIC")
ANSWER = """
for await (const line of require("readline").createInterface({input: process.stdin})) {
  const [name, ...values] = JSON.parse(line);
  console.log(JSON.stringify(eval(name)(...values)));
}
"""


@contextmanager
def running(language, source, functions, folder):
    """Yield a function that calls the generated one of a name with numbers."""
    if language == "numpy":
        found = {}
        exec(source, found)  # our own output
        yield lambda name, *values: found[name](*values)
    elif language == "c":
        file, library = folder / "lwa_wave.c", folder / "lwa_wave.so"
        file.write_text(source + "\n", encoding="utf-8")
        command = ["cc", *STRICT, "-o", library, file, "-lm"]
        subprocess.run(command, check=True, cwd=folder, timeout=120)
        loaded = ctypes.CDLL(str(library))
        for function in functions:
            call = getattr(loaded, function.name)
            call.restype = ctypes.c_double
            call.argtypes = [ctypes.c_double] * len(function.arguments)
        yield lambda name, *values: getattr(loaded, name)(*values)
    else:
        program = ["node", "--eval", f"{source}\n(async () => {{{ANSWER}}})();"]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        with subprocess.Popen(program, **pipes) as node:

            def asked(name, *values):
                node.stdin.write(json.dumps([name, *map(float, values)]) + "\n")
                node.stdin.flush()
                return json.loads(node.stdout.readline())

            yield asked


RATIOS = (1e-3, 0.2733, 1.0, 3.0, 99.0)
GRID = {"k": (1.01, 1.5, 1.6, 1.999, 2.0, 3.0, 7.875), "m1": (1.0,), "m2": RATIOS, "D": (1.0,)}
NEAR_1 = {"k": tuple(1 + 2.0**-n for n in (10, 20, 40))}
STIFF = {"k": (1.01, 1.5, 8.0), "m1": (0.3, 7.0), "m3": (1.1,), "D": (0.7,), "A1": (0.02, 50.0)}
WAVES = {
    "paper": (homogenize(Dimer("m1", "m2")).pde.traveling_wave(), GRID),
    "canonical": (canonical_wave(Dimer("m1", "m2")), GRID),
    "k near 1": (canonical_wave(Cell([1], spacing=1)), NEAR_1),
    "three": (canonical_wave(Cell(["m1", 2, "m3"], ["A1", 1, 8])), STIFF),
    "numbers": (homogenize(Dimer(1, 1, spacing=1), k="3/2").pde.traveling_wave(), {}),
    # a word of a language, names of the module's own, a Greek letter
    "names": (
        canonical_wave(Cell(["np", "width", "double", "μ"], spacing="speed"), "3/2"),
        {"np": (1.0,), "width": (2.0,), "double": (0.5,), "μ": (3.0,), "speed": (0.7,)},
    ),
}
"""The paper's wave, all parameters symbols; I alone; unlike contacts; no parameter at all."""


@pytest.fixture(scope="module")
def functions_of(tmp_path_factory):
    """(wave, language) → name → the function, called by the names of its arguments."""
    with ExitStack() as processes:

        @cache
        def load(name, language):
            functions = wave_functions(WAVES[name][0]).values()
            source = module([*functions], language, [name])
            call = processes.enter_context(
                running(language, source, functions, tmp_path_factory.mktemp("code"))
            )
            return {f.name: by_name(call, f) for f in functions}

        yield load


def by_name(call, f):
    return lambda **values: float(call(f.name, *(values[s.name] for s in f.arguments)))


@cache
def points(name):
    """Numbers by name, k, β, and (function, B, V_s or F) → value, of the equation's G, H and I."""
    wave, grid = WAVES[name]
    letters = {s.name: s for x in (wave.k, wave.I) for s in x.free_symbols}
    formulas = [wave.k, wave.G, wave.H, wave.I, wave.time_scale, wave.at_force(2).strain]
    numbers = sp.lambdify([letters[name] for name in grid], formulas, "mpmath")
    rows = []
    for values in product(*grid.values()):
        k, G, H, I, scale, B = map(mpmath.mpmathify, numbers(*map(mpmath.mpf, values)))
        S = G + H + I
        factor = S and 1 - (k - 1) ** 2 / (4 * S) * ((H + 3 * I) * 2 / (k - 1) - 2 * I)
        if S < 1e-30 or factor <= 0:  # k = 8, m2 = 3: S = 0
            continue
        beta = (k - 1) / (2 * mpmath.sqrt(S))
        found = {("beta", 0): beta, ("width", 0): mpmath.pi / beta}
        for quantity, power in (("strain", 1), ("force", k), ("velocity", 1)):
            angle = mpmath.acos(mpmath.mpf(2) ** (-(k - 1) / (2 * power)))
            found[f"fwhm_{quantity}", 0] = 2 * angle / beta
        for at in (0.5, 1.0, 2.0):
            found["speed", at] = mpmath.sqrt(factor) * at ** ((k - 1) / 2)
            found["amplitude", at] = (at**2 / factor) ** (1 / (k - 1))
        found["time_scale", 0], found["strain", 2] = scale, B
        found["speed_at_force", 2] = scale * mpmath.sqrt(factor) * B ** ((k - 1) / 2)
        rows.append((dict(zip(grid, values, strict=True)), k, beta, found))
    return rows


@in_every_language
@pytest.mark.parametrize("name", WAVES)
@mpmath.workdps(50)
def test_closed_forms_are_good_to_1e14(functions_of, language, name):
    functions, rows = functions_of(name, language), points(name)
    assert len(rows) == 1 or len(rows) > 2
    for values, _, _, numbers in rows:
        for (function, at), value in numbers.items():
            if 1e-300 < value < 1e300:
                found = functions[function](**values, B=at, V_s=at, F=at)
                # at k = 1.01 rounding the exponent 2/(k-1) of V_s costs |ln B| = 137 half ulps
                assert abs(found / value - 1) <= 1e-14, (function, at, values)


@in_every_language
@pytest.mark.parametrize("name", ["paper", "numbers"])
@mpmath.workdps(50)
def test_the_profile(functions_of, language, name):
    """Good to 1e-14 B where ξ is off by 1e-14 of itself, and 0 outside of the support."""
    profile, width = (functions_of(name, language)[f] for f in ("profile", "width"))
    B, off = 3.0, mpmath.mpf("1e-14")
    for values, k, beta, _ in points(name)[::5]:
        for fraction in (0.0, 1e-3, 0.1, 0.3, 0.6, 0.9, 0.999, 1 - 1e-9, 1 + 1e-9, 1.5, 3.7):
            xi = fraction * width(**values) / 2
            found = profile(xi=xi, B=B, **values)
            assert found == profile(xi=-xi, B=B, **values)
            phases = (min(beta * xi * (1 + sign * off), mpmath.pi / 2) for sign in (1, -1))
            low, high = (B * max(0, mpmath.cos(phase)) ** (2 / (k - 1)) for phase in phases)
            assert low - B * off <= found <= high + B * off, (values, fraction)
            assert fraction < 1 or found == 0


def test_numpy_broadcasts_and_takes_integers():
    functions, found = wave_functions(WAVES["paper"][0]), {}
    exec(module([*functions.values()], "numpy", []), found)
    k, w = np.array([[1.25], [1.5]]), np.array([0.1, 1.0, 10.0])
    beta = found["beta"](k=k, m1=1, m2=w, D=1)
    assert beta.shape == (2, 3)
    assert beta[1, 1] == found["beta"](k=1.5, m1=1, m2=1, D=1)
    xi = np.linspace(-9, 9, 37)
    v = found["profile"](xi=xi, B=2, k=1.5, m1=1, m2=1, D=1)
    outside = np.abs(xi) > found["width"](k=1.5, m1=1, m2=1, D=1) / 2
    assert outside.sum() > 10
    assert np.all((v == 0) == outside)
    large = found["beta"](k=2, m1=10**12, m2=np.array([10**12, 10**13]), D=3)  # 10^26: no int64
    assert large == pytest.approx(found["beta"](k=2, m1=1, m2=np.array([1, 10]), D=3), rel=1e-15)


def test_arguments_have_one_order_in_all_languages():
    functions = wave_functions(canonical_wave(Cell(["z", "a"], ["y", "b"], "L"), "q"))
    names = {name: [s.name for s in f.arguments] for name, f in functions.items()}
    assert names["profile"] == ["xi", "B", "q", "z", "a", "y", "b", "L"]
    assert names["beta"] == names["width"] == names["fwhm_force"] == names["profile"][2:]
    assert names["speed"] == ["B", "q"]
    assert names["amplitude"] == ["V_s", "q"]
    assert "def speed(B, k):" in canonical_wave(Cell(["B", 1])).code("numpy")


@pytest.mark.parametrize("language", ["numpy", "c"])
def test_the_command_prints_the_same(language, capsys):
    arguments = ("wave", "--k", "3/2", "--masses", "1,math", "--format", language)
    wave = homogenize(Dimer(1, "math"), k="3/2").pde.traveling_wave()
    assert run(capsys, *arguments) == (0, wave.code(language) + "\n", "")
