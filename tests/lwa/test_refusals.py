"""Bad arguments that no command reaches: one line names the value."""

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp

from lwa import (
    Cell,
    Dimer,
    Dispersion,
    ExpandedWave,
    InputError,
    Law,
    Material,
    Power,
    Sphere,
    canonical_wave,
    expand,
    general,
    homogenize,
    loaded_wave,
)
from lwa.law import DELTA, named
from lwa.spheres.hertz import stiffness

y = sp.Symbol("y", positive=True)
STEEL = Material(1, 0)
BALL, CHAIN = Sphere(1, 1, STEEL), Cell([1])
TWO_A = Cell([sp.Symbol("a"), sp.Symbol("a", positive=True)])
DIMER, TWO = Dimer("m1", "m2"), Cell([1, 2])
WAVE, ONE = canonical_wave(DIMER), canonical_wave(Cell([1], spacing=1), "3/2")
AT_X = Cell([sp.Symbol("X"), 2])

CALLS = [
    (lambda: Cell([]), "at least one mass"),
    (lambda: Cell([1, 0]), "mass 2 is 0"),
    (lambda: Cell([sp.sqrt(2) - 2]), r"mass 1 is -2 \+ sqrt\(2\): it must be positive"),
    (lambda: Cell([-y]), "mass 1 is -y: it must be positive"),
    (lambda: Cell([1], spacing="0.0"), "spacing is 0"),
    (lambda: Cell("m1,m2"), "masses: a sequence"),
    (lambda: Cell({1, 2}), "masses: a sequence"),
    (lambda: Cell([1, 10**5000]), "mass 2 is a number beyond"),
    (lambda: Dimer(1, 2, N=0), "N is 0"),
    (lambda: Dimer(1, 2, N=1.5), "N is 1.5"),
    (lambda: homogenize(DIMER, 10**5000), "order is .*: an integer from 1 on"),
    (lambda: Dispersion(Cell([1, 1], [1, 2]), "1e-9"), "exponents from 1/100 to 1000"),
    (lambda: Cell(["m1"]).at(omega=1), "a cell with two masses"),
    (lambda: Cell(["m1", "m2", 3]).at(omega=1), "a cell with two masses"),
    (lambda: DIMER.at(m1=1, m2=2, omega=2), "omega is m2/m1: one of the masses"),
    (lambda: DIMER.at(omega=-1), "omega is -1"),
    (lambda: DIMER.at(m3=1), "'m3' is not among the symbols: D, m1, m2"),
    (lambda: TWO_A.at(a=1), "'a' names two symbols"),
    *(
        (lambda call=call: call([1, 2]), r"cell is \[1, 2\]")
        for call in (homogenize, canonical_wave, expand, loaded_wave, Dispersion)
    ),
    (lambda: homogenize(CHAIN, law="hertz2"), "law is 'hertz2'"),
    (lambda: canonical_wave(CHAIN, k="3/2", law=3), "one of them"),
    (lambda: homogenize(CHAIN, law=Power(2), k=[1]), "one of them"),
    (lambda: homogenize(Dimer(1, 2, stiffnesses=[1, 2]), law=general()), "shares of the strain"),
    (lambda: homogenize(DIMER, law=general(), branch="optical"), "its contacts also pull"),
    (lambda: homogenize(CHAIN, law=general()).pde.traveling_wave(), "power law"),
    (lambda: named("hertz2").at([1.0]), "an array of forces needs numbers"),
    (lambda: Law("x**2", y), "a SymPy expression"),
    (lambda: Law(y, "y"), "the symbol of δ"),
    (lambda: named("general", 1), "none are wanted"),
    (lambda: homogenize(CHAIN, law=Law(y * sp.Symbol("a"), y)).at(a="y"), "a .y.: the name means"),
    *(
        (lambda delta=delta: Power("3/2").at(delta), "delta is")
        for delta in (None, "1", float("nan"), 1j, sp.I, sp.oo, ["x"])
    ),
    (lambda: Dispersion(TWO).bands.branches(float("nan")), "wavenumber is nan"),
    (lambda: Dispersion(TWO).bands.branches([[1], [2, 3]]), "wavenumber is"),
    (lambda: Dispersion(TWO).acoustic(10000), "order is 10000: .* lower order"),
    (lambda: Dispersion(Cell(["a", "b"], ["d", "e"])).acoustic(10000), "lower order"),
    (lambda: Dispersion(Cell([1, 2, 3])).optical(4), "needs a cell of 2 masses, not 3"),
    (lambda: Dispersion(Cell([1, "m2"])).bands.branches(1), "'m2' has no value"),
    (lambda: Dispersion(Cell([1, 2], [1, 2]), "k").bands.edges(), "'k' has no value"),
    (lambda: Dispersion(Cell(["1e200", "1e-200"])).bands.branches(1), "the range of a float"),
    (lambda: ONE.at_force(1, of="wall"), "of is 'wall': contact or bead"),
    (lambda: ONE.at_force([1, 2]), r"force is \[1, 2\]: a number or a symbol is wanted"),
    (lambda: ONE.at_force(1).curve([0], "pressure"), "quantity is 'pressure'"),
    (lambda: ONE.at_force(1).curve("now"), "t is 'now': real numbers"),
    (lambda: ONE.at_force(1).curve([np.inf]), "t is inf: finite numbers"),
    (lambda: ONE.at_force(1).curve([0], of="wall"), "of is 'wall'"),
    (lambda: ONE.at_force("F").curve([0]), "has no value: a curve needs numbers"),
    (lambda: ONE.at_force(1).fwhm("force", "area"), "extent is 'area'"),
    (lambda: WAVE.numeric().beta(np.nan, 1.0), "k is nan"),
    (lambda: WAVE.numeric().beta(1.5, -1.0), r"ω = m2/m1 is -1\.0: it must be positive"),
    (lambda: WAVE.numeric().speed(1.5, 1.0, B=-1.0), r"B is -1\.0: it must be positive"),
    (lambda: WAVE.numeric(missing="zero"), "missing is 'zero'"),
    (lambda: canonical_wave(Cell(["m1", "m2"], ["A1", "A2"])).numeric(), "two masses"),
    (lambda: WAVE.code("rust"), "language is 'rust': one of numpy"),
    (lambda: canonical_wave(Cell([sp.Symbol("x y")])).code("c"), "'x y' is no name"),
    (lambda: expand(DIMER, 6).c2.at("3/2"), "has no value"),
    (lambda: expand(Cell([1], [8]), 6, k="3/2").c2.at("6/5"), "that of k = 3/2"),
    (lambda: expand(CHAIN, 6).c2.at(1), "k is 1"),
    (lambda: expand(CHAIN, 5).c2.at("3/2"), "from order 6 on"),
    (lambda: expand(TWO, 8).c2.at("3/2"), "over 10% of it"),
    (lambda: expand(TWO, 1).log_force(2), "contact is 2"),
    (lambda: expand(AT_X, 1).log_force(), "X names a property of the chain"),
    (lambda: expand(CHAIN, 2).fwhm("speed"), "quantity is"),
    (lambda: expand(Cell(["a", "b"]), 100), "takes more than .* terms"),
    (lambda: expand(Cell([1], [Fraction(1, 10**400 + 1)]), 4), "digits"),
    (lambda: expand(Cell(["ε", 1]), 1), "ε is k - 1"),
    (lambda: expand(CHAIN, 2, law=general()), "only a power law has a k"),
    (lambda: expand(CHAIN, 2, law=Law(sp.exp(DELTA) - 1, DELTA)), "only a power law has a k"),
    (lambda: ExpandedWave(expand(CHAIN, 10, k="3/2"), -1), "force is -1"),
    (lambda: ExpandedWave(expand(CHAIN, 10, k="3/2"), "F"), "force is "),
    (lambda: Material(0, 0), "E is 0"),
    (lambda: Material(1, "0.51"), "nu is '0.51'"),
    (lambda: Material(1, 0, -1), "density is -1"),
    (lambda: Material.named("wood"), "'wood': one of steel 316, steel 440C"),
    (lambda: Sphere(1, 1, "steel"), "material is 'steel': a Material"),
    (lambda: Sphere(1, 0, STEEL), "radius is 0"),
    (lambda: Sphere.solid(1, STEEL), "a Material with a density"),
    (lambda: stiffness(BALL, 1), "other is 1: a Sphere"),
    (lambda: Cell.of_spheres([BALL, STEEL]), "sphere is Material"),
    (lambda: Cell.of_spheres(BALL), "spheres: a sequence"),
]


@pytest.mark.parametrize(("call", "words"), CALLS, ids=[words for _, words in CALLS])
def test_bad_arguments_are_refused_in_one_line(call, words):
    with pytest.raises(InputError, match=words) as refused:
        call()
    assert "\n" not in str(refused.value)
    assert len(str(refused.value)) < 200
