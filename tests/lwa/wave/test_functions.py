"""Generated functions, run in their own languages, against 50 digits."""

import keyword
from functools import cache
from itertools import product

import mpmath
import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Dimer, InputError, NoSolitaryWave, canonical_wave, homogenize
from lwa.code import LANGUAGES, Function
from lwa.wave.functions import wave_functions
from tests.lwa.code.compilers import PROGRAMS, compiled, in_node
from tests.lwa.command.answers import run

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
    return wave_functions_of(name).source(language, [name])


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
        if language in ("c", "fortran"):
            return compiled(source, language, functions, tmp_path_factory.mktemp("code"))
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
def test_near_the_edge_of_existence_the_error_is_that_of_the_arguments(functions_of, language):
    """k = 3, ω → ω*, where G + H + I = 0: β at an ω that is off by 4 ulps."""
    beta = functions_of("paper", language)["beta"]
    with mpmath.workdps(50):
        edge = (1 + mpmath.sqrt(25)) / 2  # 12 + 2ω(1 - ω) = 0

        def exact_beta(w):
            return 2 / (2 * mpmath.sqrt((12 + 2 * w * (1 - w)) / (6 * (1 + w) ** 2)))

        for distance in (1e-2, 1e-5, 1e-9, 1e-12):
            w = float(edge) * (1 - distance)
            low, high = (exact_beta(exact(w) * (1 + s * exact(2) ** -50)) for s in (-1, 1))
            assert low <= beta(k=3.0, m1=1.0, m2=w, D=1.0) <= high


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


@pytest.mark.parametrize("V", [1e-2, 0.9, 1.1, 30.0])
@in_every_language
def test_an_amplitude_far_from_one_loses_its_logarithm_of_roundings(functions_of, language, V):
    amplitude = functions_of("paper", language)["amplitude"]
    with mpmath.workdps(50):
        for k in (1.015625, 1.03125, 1.0625):
            k, omega = exact(k), exact(0.25)
            S = (k * (k + 1) + 2 * (k - 2) * omega * (1 - omega)) / (6 * (1 + omega) ** 2)
            wave = wave_of("paper").at(k=sp.Rational(float(k)), m1=1, m2="1/4", D=1)
            factor = sp_or_mp(wave.speed_factor)
            B = (exact(V) ** 2 / factor) ** (1 / (k - 1))
            got = float(amplitude(V_s=V, k=float(k), m1=1.0, m2=0.25))
            assert S > 0
            assert abs(got / B - 1) <= 2.0**-52 * (4 + abs(mpmath.log(B)))


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


# Words of every language, the module's own, letters beyond ASCII, and text that is no name at all.
NAMES = [
    *keyword.kwlist, "double", "fabs", "linux", "integer", "end", "baremodule", "var",
    "Math", "arguments", "dp", "lwa_wave",
    "beta", "width", "speed", "amplitude", "profile", "fwhm_strain", "p", "a", "mu", "eta", "sigma",
    "s", "xi", "Xi", "XI", "b", "v_s", "inside", "k_2", "k_2_", "r_1", "sum_1", "dp", "DP", "np",
    "numpy", "self", "main", "beta_", "math_", "μ1", "μ", "λ", "lambda", "Λ", "ς", "σ", "M1", "m1",
    "é", "_", "_x", "__init__", "1x", "", "x y", "x-y", "a'b", 'a"b', "x\ny", "x\\", "*/", "// ??/",
    "!x", "#", "x;return 0", "M_PI", "M_LN2", "HUGE_VAL", "NAN", "INFINITY", "y0", "j1", "gamma",
    "exp", "Sin", "SQRT", "print", "float", "map", "real", "Real", "result", "module", "call", "I",
    "l", "O", "E", "pi", "size", "unix", "x" * 100, "x" * 31 + "y", "x" * 31 + "z", "日本",
]  # fmt: skip


@in_every_language
def test_any_name_at_once(language, run_in):
    """One function of all names: Σ n s_n distinguishes each from every other."""
    symbols = [sp.Symbol(name) for name in dict.fromkeys(NAMES)]
    n = len(symbols)
    total = sp.Add(*((i + 1) * symbol for i, symbol in enumerate(symbols)))
    functions = [
        Function("beta", "Σ n s_n", tuple(symbols), total),
        Function("profile", "twice", tuple(symbols), 2 * sp.Function("beta")(*symbols)),
    ]
    found = run_in(language, LANGUAGES[language](functions).module(["names"]), functions)
    unit = np.eye(n)
    assert [found["beta"](*row) for row in unit] == [i + 1 for i in range(n)]
    assert found["profile"](*unit[n // 2]) == 2 * (n // 2 + 1)


def test_renamed_symbols_are_listed_in_comments():
    code = canonical_wave(Dimer("math", "μ1")).code("numpy")
    assert "# math_ is the symbol 'math'\n# mu1 is the symbol 'μ1'\n" in code
    wave = canonical_wave(Dimer("M1", "m1"))
    assert "! m1_ is the symbol 'm1'\n" in wave.code("fortran")
    assert "symbol" not in wave.code("c")


def test_numbers_of_any_size():
    """Masses beyond 2^63 are exact, numbers beyond a double refused."""
    wave, found = canonical_wave(Dimer(10**30, "1/3")), {}
    exec(wave.code("numpy"), found)
    assert found["beta"](1.5, 1) == pytest.approx(float(wave.at(k=1.5, D=1).beta), rel=1e-14)
    for number in (10**400, sp.Rational(1, 10**400)):
        with pytest.raises(InputError, match="beyond"):
            canonical_wave(Dimer("m1", "m2", spacing=number)).code("c")


def test_refusals():
    with pytest.raises(InputError, match="language is 'rust': one of numpy"):
        wave_of("paper").code("rust")
    with pytest.raises(NoSolitaryWave):
        wave_of("paper").at(k=3, m1=1, m2=100).code("c")


@pytest.mark.parametrize("language", ["numpy", "c"])
def test_the_command_prints_the_same(language, capsys):
    arguments = ("wave", "--k", "3/2", "--masses", "1,math", "--format", language)
    wave = homogenize(Dimer(1, "math"), k="3/2").pde.traveling_wave()
    assert run(capsys, *arguments) == (0, wave.code(language) + "\n", "")


def test_a_theory_with_awkward_names_is_a_module(capsys):
    _, out, _ = run(capsys, "derive", "--masses", "math,coefficients", "--format", "numpy")
    found = {}
    exec(out, found)
    plain = homogenize(Dimer("m1", "m2")).pde
    values = {"k": sp.Rational(7, 4), "m1": 2, "m2": 3, "D": sp.S.Half}
    expected = plain.H.xreplace({s: sp.sympify(values[s.name]) for s in plain.H.free_symbols})
    assert found["H"](1.75, 2, 3, 0.5) == pytest.approx(float(expected), rel=1e-14)
    table = found["coefficients"](1.75, 2, 3)
    assert table[3][((2, 1), (3, 1)), ()] * 0.25 == pytest.approx(float(expected), rel=1e-14)
    assert set(table) == set(plain.coefficients)
