"""Generated functions, run in their own languages, against 50 digits."""

from functools import cache
from itertools import product

import mpmath
import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Dimer, canonical_wave, homogenize
from lwa.wave.source import LANGUAGES, module, wave_functions
from tests.lwa.command.answers import run
from tests.lwa.wave.compilers import PROGRAMS, compiled, in_node

in_every_language = pytest.mark.parametrize(
    "language",
    [
        pytest.param(name, marks=pytest.mark.optional(PROGRAMS[name])) if name in PROGRAMS else name
        for name in LANGUAGES
    ],
)
"""Each generated language; some need a compiler, or Node.js."""

EXPONENTS = (1.01, 1.5, 1.999, 2.0, 3.0, 7.875)
RATIOS = (1e-3, 0.2733, 1.0, 3.0, 99.0)
GRID = {"k": EXPONENTS, "m1": (1.0,), "m2": RATIOS, "D": (1.0,)}
STIFF = {"k": (1.01, 1.5, 8.0), "m1": (0.3, 7.0), "m3": (1.1,), "D": (0.7,), "A1": (0.02, 50.0)}

WAVES = {
    "paper": (lambda: homogenize(Dimer("m1", "m2")).pde.traveling_wave(), GRID),
    "canonical": (lambda: canonical_wave(Dimer("m1", "m2")), GRID),
    "three": (lambda: canonical_wave(Cell(["m1", 2, "m3"], ["A1", 1, 8])), STIFF),
    "numbers": (lambda: homogenize(Dimer(1, 1, spacing=1), k="3/2").pde.traveling_wave(), GRID),
}
"""The paper's wave, all parameters symbols; I alone; unlike contacts; no parameter at all."""


@cache
def wave_of(name):
    return WAVES[name][0]()


@cache
def wave_functions_of(name):
    return wave_functions(wave_of(name))


def functions_in(name):
    return list(wave_functions_of(name).values())


@cache
def code_of(name, language):
    """As `TravelingWave.code` writes it, but derived once for all languages."""
    return module(functions_in(name), language, [name])


def exact(value):
    return mpmath.mpf(value)


@cache
def points(name):
    """(name → number, k, G + H + I, V²/B^{k-1}) where there is a wave, from its equation."""
    wave = wave_of(name)
    symbols = wave_functions_of(name).symbols
    names = [symbol.name for symbol in symbols]
    numbers = sp.lambdify(symbols, [wave.k, wave.G, wave.H, wave.I], "mpmath")
    rows = []
    with mpmath.workdps(50):
        for values in product(*(WAVES[name][1][s] for s in names)):
            k, G, H, I = (sp_or_mp(x) for x in numbers(*map(exact, values)))
            S = G + H + I
            factor = S and 1 - (k - 1) ** 2 / (4 * S) * ((H + 3 * I) * 2 / (k - 1) - 2 * I)
            if S > 1e-30 and factor > 0:  # k = 8, m2 = 3: S = 0
                rows.append((dict(zip(names, values, strict=True)), k, S, factor))
    return rows


def sp_or_mp(value):
    return mpmath.mpf(value.p) / value.q if isinstance(value, sp.Rational) else mpmath.mpf(value)


@pytest.fixture(scope="module")
def run_in(tmp_path_factory):
    """(language, source, functions) → name → the function of numbers."""
    processes = []

    def load(language, source, functions):
        if language == "c":
            return compiled(source, functions, tmp_path_factory.mktemp("code"))
        if language == "javascript":
            node, found = in_node(source, functions)
            processes.append(node)
            return found
        found = {}
        exec(source, found)  # our own output
        return found

    yield load
    for node in processes:
        node.communicate(timeout=30)


@pytest.fixture(scope="module")
def functions_of(run_in):
    """(wave, language) → name → the function, called by the names of its arguments."""

    @cache
    def load(name, language):
        functions = functions_in(name)
        found = run_in(language, code_of(name, language), functions)
        return {f.name: by_name(found[f.name], f) for f in functions}

    return load


def by_name(call, function):
    names = [symbol.name for symbol in function.arguments]
    return lambda **values: call(*(values[name] for name in names))


@cache
def expected(name):
    """For all points: name → number, (function, B or V_s) → value, and its rounding error."""
    rows = []
    with mpmath.workdps(50):
        for values, k, S, factor in points(name):
            beta = (k - 1) / (2 * mpmath.sqrt(S))
            found = {("beta", 0): beta, ("width", 0): mpmath.pi / beta}
            for quantity, power in (("strain", 1), ("force", k), ("velocity", 1)):
                angle = mpmath.acos(exact(2) ** (-(k - 1) / (2 * power)))
                found[f"fwhm_{quantity}", 0] = 2 * angle / beta
            for at in (0.5, 1.0, 2.0):
                found["speed", at] = mpmath.sqrt(factor) * at ** ((k - 1) / 2)
                found["amplitude", at] = (at**2 / factor) ** (1 / (k - 1))
            rest = {key: float(value - float(value)) for key, value in found.items()}
            rows.append((values, {key: float(value) for key, value in found.items()}, rest))
    return rows


@in_every_language
@pytest.mark.parametrize("name", WAVES)
def test_closed_forms_are_good_to_1e14(functions_of, language, name):
    found, rows = functions_of(name, language), expected(name)
    for values, numbers, rest in rows:
        for (function, at), value in numbers.items():
            got = float(found[function](**values, B=at, V_s=at))
            error = got - value - rest[function, at]  # without rounding where it is small
            # at k = 1.01 rounding the exponent 2/(k-1) of V_s costs |ln B| = 137 half ulps
            assert abs(error) <= 1e-14 * value, (function, at, values)
    assert len(rows) == 1 or len(rows) > 5


@in_every_language
@pytest.mark.parametrize("name", ["paper", "numbers"])
def test_the_profile(functions_of, language, name):
    """Good to 1e-14 B where ξ is off by 1e-14 of itself, and 0 outside of the support."""
    profile, width = (functions_of(name, language)[f] for f in ("profile", "width"))
    B = 3.0

    def v(xi, beta, m):
        return B * mpmath.cos(beta * xi) ** m if beta * xi < mpmath.pi / 2 else exact(0)

    with mpmath.workdps(50):
        for values, k, S, _ in points(name)[::5]:
            beta, m = (k - 1) / (2 * mpmath.sqrt(S)), 2 / (k - 1)
            for fraction in (0.0, 1e-3, 0.1, 0.3, 0.6, 0.9, 0.999, 1 - 1e-9, 1 + 1e-9, 1.5, 3.7):
                xi = fraction * width(**values) / 2
                got = float(profile(xi=xi, B=B, **values))
                assert got == float(profile(xi=-xi, B=B, **values))
                off = exact("1e-14")
                low, high = (v(exact(xi) * (1 + sign * off), beta, m) for sign in (1, -1))
                assert low - B * off <= got <= high + B * off, (values, fraction)
                assert fraction < 1 or got == 0


@in_every_language
def test_widths_and_speeds_keep_their_digits_as_k_goes_to_one(functions_of, language):
    found = functions_of("canonical", language)
    with mpmath.workdps(50):
        for n in (10, 20, 40):
            values = {"k": 1 + 2.0**-n, "m1": 1.0, "m2": 1.0, "D": 1.0}
            k = exact(values["k"])
            beta = (k - 1) / mpmath.sqrt(k * (k + 1) / 6)  # I = 1/12
            assert abs(found["beta"](**values) / beta - 1) < 1e-14
            for quantity, power in (("strain", 1), ("force", k)):
                width = 2 * mpmath.acos(exact(2) ** (-(k - 1) / (2 * power))) / beta
                assert abs(found[f"fwhm_{quantity}"](**values) / width - 1) < 1e-14
            speed = mpmath.sqrt(2 / (k * (k + 1))) * exact(3) ** ((k - 1) / 2)
            assert abs(found["speed"](B=3.0, k=values["k"]) / speed - 1) < 1e-14


def test_numpy_broadcasts_and_takes_integers(functions_of):
    found = functions_of("paper", "numpy")
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


@in_every_language
def test_names_that_have_another_meaning(language, run_in):
    """A word of a language, names of the module's own, a Greek letter."""
    cell = Cell(["np", "width", "double", "μ"], spacing="speed")
    functions = list(wave_functions(canonical_wave(cell, "3/2")).values())
    found = run_in(language, module(functions, language, ["names"]), functions)
    numbers = dict(zip((*cell.masses, cell.spacing), (1.0, 2.0, 0.5, 3.0, 0.7), strict=True))
    (beta,) = (f for f in functions if f.name == "beta")
    expected = float(canonical_wave(cell, "3/2").beta.xreplace(numbers))
    assert found["beta"](*(numbers[s] for s in beta.arguments)) == pytest.approx(
        expected, rel=1e-14
    )


@pytest.mark.parametrize("language", ["numpy", "c"])
def test_the_command_prints_the_same(language, capsys):
    arguments = ("wave", "--k", "3/2", "--masses", "1,math", "--format", language)
    wave = homogenize(Dimer(1, "math"), k="3/2").pde.traveling_wave()
    assert run(capsys, *arguments) == (0, wave.code(language) + "\n", "")
