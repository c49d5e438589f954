"""Objects behave as SymPy's do: known by what they were derived from, one line to read."""

import copy
import pickle

import pytest
import sympy as sp

import lwa
from lwa import (
    Cell,
    Dimer,
    Dispersion,
    Power,
    canonical_wave,
    expand,
    homogenize,
    loaded_wave,
)
from lwa.linear.dispersion import LoadedChain

m1, m2 = sp.symbols("m1 m2", positive=True)


def dimer():
    return Dimer(m1, m2)


def theory(order=4, **kind):
    return homogenize(dimer(), order, **kind)


def paper():
    return theory().pde.traveling_wave()


MADE = {
    "cell": lambda: Dimer(m1, m2, spacing="h"),
    "decimals": lambda: Cell(["0.45", sp.sqrt(2)], [1, "0.123456789"], 2),
    "linear": theory,
    "full": lambda: theory(5, closure="full", field="center"),
    "optical": lambda: theory(branch="optical"),
    "pde": lambda: theory().pde,
    "closure": lambda: theory(5, closure="full", field="first").closure,
    "terms": lambda: theory().pde.coefficients[3],
    "energy": lambda: theory(closure="full", field="first").pde.energy[2],
    "wave": paper,
    "physical": lambda: paper().at_force("F"),
    "reduction": lambda: paper().reduction(),
    "numeric": lambda: paper().numeric(),
    "dispersion": lambda: Dispersion(dimer()),
    "law": lambda: lwa.general(),
    "power": lambda: Power("k"),
    "of a law": lambda: theory(5, law=lwa.general(), closure="full", field="center"),
    "background": lambda: loaded_wave(dimer(), background="p0"),
    "kdv": lambda: loaded_wave(dimer(), background="p0").kdv,
    "precompressed": lambda: canonical_wave(dimer()).at_force("F", precompression="F0"),
    "envelope": lambda: lwa.envelope(dimer(), law=Power("k"), background="p0"),
    "breather": lambda: lwa.envelope(Dimer(2, 1), law=Power(2), background=1).breather(
        detuning="1/100"
    ),
    "shock": lambda: lwa.shock(Dimer(2, 1), 2, 1, law=Power(2)),
    "expansion": lambda: expand(dimer(), 2),
    "series": lambda: expand(Cell(["m", 2]), 1).fwhm("velocity"),
    "sum": lambda: expand(Cell([1, "1/3"]), 6, k="6/5").c2.at(),
    "lattice": lambda: lwa.lattice_wave(Dimer("m1", "m2"), force="F"),
    "sphere": lambda: lwa.Sphere.solid("R", lwa.Material.named("PTFE")),
    "loaded": lambda: LoadedChain(dimer(), Power("3/2"), "F0"),
}


@pytest.mark.parametrize("name", MADE)
def test_equal_derivations_are_equal_pickle_and_show_in_a_notebook(name):
    """A display has braces that match, and none of Python's names of functions."""
    one, two = MADE[name](), MADE[name]()
    assert one is not two
    assert one == two
    assert len({one, two}) == 1
    for attribute in ("pde", "coefficients", "beta", "c2"):
        getattr(
            one, attribute, None
        )  # values computed by now do not count, and stay behind
    assert len(pickle.dumps(one)) < 1.2 * len(pickle.dumps(two)) + 100
    for other in (pickle.loads(pickle.dumps(one)), copy.copy(one), copy.deepcopy(one)):
        assert other == one
        assert hash(other) == hash(one)
    if name not in ("sphere", "numeric"):
        shown = one._repr_latex_()
        assert shown == f"${sp.latex(one)}$" or shown == f"$${sp.latex(one)}$$"
        assert shown.count("{") == shown.count("}")
        assert "sqrt(" not in shown


def test_other_derivations_differ():
    unlike = Dimer(m1, m2, stiffnesses=(1, 2))
    theories = [theory(5), theory(k="3/2"), *map(homogenize, (Dimer(m2, m1), unlike))]
    made = [make() for make in MADE.values()] + theories
    assert len(set(made)) == len(made)
    assert len({t.pde for t in theories}) == len(theories)


def test_repr_of_long_expressions_is_one_short_line():
    found = theory(9, closure="full", field="first")
    wave = canonical_wave(Cell(sp.symbols("a1:7")))
    for piece in (found, found.pde, found.closure, found.pde.coefficients[8], wave):
        assert "\n" not in repr(piece)
        assert len(repr(piece)) < 600


def test_at_substitutes_everywhere():
    """Specialised afterwards and derived for the numbers are the same."""
    for kind in ({}, {"closure": "full", "field": "center"}, {"branch": "optical"}):
        own, derived = homogenize(Dimer(2, 3), k="3/2", **kind), theory(**kind)
        assert derived.at(k="3/2", m1=2, m2=3) == own
        assert derived.at(k="3/2", m1=2, omega="3/2") == own
        assert derived.pde.at(k="3/2", m1=2, m2=3) == own.pde
    wave = paper()
    assert wave.at(omega=1, k="3/2").beta == sp.sqrt(10) / (5 * wave.D)
    assert Dispersion(dimer()).at(omega=1).I == lwa.D**2 / 12
