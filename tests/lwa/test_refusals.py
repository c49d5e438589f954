"""Bad arguments of cells, laws and spheres that no command reaches: one line names the value."""

import pytest
import sympy as sp

from lwa import (
    Cell,
    Dimer,
    Dispersion,
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
from lwa.law import named
from lwa.spheres.hertz import stiffness

y = sp.Symbol("y", positive=True)
STEEL = Material(1, 0)
BALL, CHAIN = Sphere(1, 1, STEEL), Cell([1])
TWO_A = Cell([sp.Symbol("a"), sp.Symbol("a", positive=True)])
DIMER = Dimer("m1", "m2")

CALLS = [
    (lambda: Cell([]), "at least one mass"),
    (lambda: Cell([1, 0]), "mass 2 is 0"),
    (lambda: Cell([1], spacing=0), "spacing is 0"),
    (lambda: Cell("m1,m2"), "masses: a sequence"),
    (lambda: Cell({1, 2}), "masses: a sequence"),
    (lambda: Cell([1, 10**5000]), "mass 2 is a number beyond"),
    (lambda: Dimer(1, 2, N=0), "N is 0"),
    (lambda: Dimer(1, 2, N=1.5), "N is 1.5"),
    (lambda: homogenize(DIMER, 10**5000), "order is a number of thousands of digits"),
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
