"""Bad arguments that no command reaches, and waves that do not exist: one line says why."""

import pytest
import sympy as sp

import lwa
from lwa import (
    Cell,
    Dimer,
    Lattice,
    Law,
    Link,
    Power,
    canonical_wave,
    expand,
    homogenize,
)
from lwa.law import DELTA, named

CHAIN = Cell([1])
TWO_A = Cell([sp.Symbol("a"), sp.Symbol("a", positive=True)])
DIMER = Dimer("m1", "m2")
WAVE = canonical_wave(DIMER)
PAPERS = homogenize(DIMER).pde.traveling_wave()
GENERAL = lwa.general()
HERTZ = Power("3/2")
LINK = Link(0, 1, HERTZ)
EQUAL, BEADS = Cell([1], spacing=1), Lattice([1], [LINK])
PRESSED = Law(DELTA + sp.Rational(1, 10))  # pushes with 1/10 before it is compressed
BENT = named("polynomial", "1/2", "-1/4")  # F″ = 1 - 3δ/2


def loaded(law, load, rise, cell=EQUAL):
    return lwa.loaded_wave(cell, rise=rise, background=load, law=law)


def front(*strains, law=HERTZ, cell=EQUAL):
    return lwa.shock(cell, *strains, law=law)


CALLS = [
    (lambda: Cell([sp.sqrt(2) - 2]), r"mass 1 is -2 \+ sqrt\(2\): it must be positive"),
    (lambda: Cell(["m1"]).at(omega=1), "a cell with two masses"),
    (lambda: DIMER.at(m1=1, m2=2, omega=2), "omega is m2/m1: one of the masses"),
    (lambda: TWO_A.at(a=1), "'a' names two symbols"),
    (lambda: canonical_wave(CHAIN, k="3/2", law=3), "one of them"),
    (
        lambda: homogenize(Cell([1, 2], [1, 2]), law=GENERAL),
        "shares of the strain",
    ),
    (lambda: homogenize(Dimer(3, 1)).pde.energy, "closure='full'"),
    (
        lambda: homogenize(DIMER, law=GENERAL, branch="optical"),
        "its contacts also pull",
    ),
    (lambda: homogenize(CHAIN, law=GENERAL).pde.traveling_wave(), "power law"),
    (lambda: named("general", 1), "none are wanted"),
    (
        lambda: lwa.Dispersion(Cell(["a", "b"], ["d", "e"])).acoustic(10000),
        "is 10000: .* lower",
    ),
    (
        lambda: lwa.Dispersion(Cell([1, 2, 3])).optical(4),
        "needs a cell of 2 masses, not 3",
    ),
    (
        lambda: lwa.Dispersion(Cell(["1e200", "1e-200"])).bands.branches(1),
        "the range of a float",
    ),
    (lambda: WAVE.numeric().beta(1.5, 1e151), "ω = m2/m1 is not between"),
    (lambda: canonical_wave(Cell(["m1", "m2"], ["A1", "A2"])).numeric(), "two masses"),
    (lambda: canonical_wave(Cell([sp.Symbol("x y")])).code("c"), "'x y' is no name"),
    (lambda: expand(Cell([1], [8]), 6, k="3/2").c2.at("6/5"), "that of k = 3/2"),
    (lambda: expand(CHAIN, 6).c2.at(1), "k is 1"),
    (lambda: expand(CHAIN, 5).c2.at("3/2"), "from order 6 on"),
    (lambda: expand(Cell(["ε", 1])), "ε is the series' parameter"),
    (lambda: lwa.piston(EQUAL, 2, "m1", k=1), "as fast behind as ahead"),
    (lambda: loaded(HERTZ, -1, 1), "must not be negative"),
    (lambda: loaded(GENERAL, 1, 1).fwhm(), "no expression"),
    (lambda: lwa.loaded_wave(EQUAL, force=2, rise=1), "not by both"),
    (
        lambda: PRESSED.inverse(sp.Rational(1, 50)),
        "force is 1/50: the law does not reach it",
    ),
    (
        lambda: PAPERS.on_background(1),
        "canonical",
    ),
    (lambda: Link(1, 1, HERTZ), "second particle"),
    (
        lambda: Lattice([1], [LINK, Link(1, 2, HERTZ)]),
        "particles 0 to 0",
    ),
    (lambda: Lattice([1, 1], [Link(0, 2, HERTZ)]), "free"),
    (lambda: Lattice([1, 1], [LINK]), "carry no load"),
    (lambda: front(1, -1), "ahead is -1: contacts of a power law only push"),
    (lambda: front(4, 1).trailing_speed, "the trailing edge holds up to 1.3"),
    (lambda: front(1, 2).peak, "a rarefaction has no pulse"),
    (lambda: front("p", 1, law=Power("k")).kind, "the kind depends"),
    (lambda: front(1, 0, law=Power(1)), "a front without load wants k > 1"),
    (
        lambda: front(1, 0, law=BENT),
        "changes its sign between the strains 0.67[0-9]* and 0.66",
    ),
    (lambda: front(1 + sp.Rational(1, 10**16), 1), "1e-15 of it at least"),
]

ATTRACTED = Lattice([1], [LINK, Link(0, 3, Law(-DELTA / 50))])
NO_WAVES = [
    (lambda: loaded(HERTZ, 1, "-1/2"), "only B > 0"),
    (lambda: loaded(Power("1/2"), 1, "1/2"), "only B < 0"),
    (lambda: loaded(Power("1/2"), 1, -1), "would open"),
    (lambda: loaded(Power("1/2"), 0, -1), "no load"),
    (lambda: loaded(Power(1), 1, 1), "linear"),
    (lambda: loaded(named("polynomial", 1, 0), 0, "-1/10"), "does not stiffen"),
    (lambda: loaded(named("polynomial", -1, 0), 0, "7/10"), "needs F′ > 0"),
    # 1 - cos δ is 0 in floats below 1e-8
    (lambda: loaded(Law(DELTA - sp.sin(DELTA)), 0, "1e-3"), "cancel"),
    (lambda: loaded(named("magnetic", 4, 1), 0, "1.1"), "pole"),
    (lambda: loaded(named("polynomial", 0, 1), 0, 1).kdv, "F″ is 0"),
    (lambda: lwa.loaded_wave(BEADS, force=1, precompression=1), "no wave"),
    (
        lambda: lwa.loaded_wave(ATTRACTED, force=2, precompression=1),
        "I is not positive",
    ),
    (lambda: PAPERS.at(k=1, m1=1, m2=1), "k > 1$"),
    (lambda: PAPERS.at(k="8/5", m1=1, m2=1000), "V² > 0$"),  # where G + H + I > 0
]


@pytest.mark.parametrize(
    ("error", "call", "words"),
    [(lwa.InputError, *row) for row in CALLS]
    + [(lwa.NoSolitaryWave, *row) for row in NO_WAVES],
    ids=[words for _, words in CALLS + NO_WAVES],
)
def test_bad_arguments_are_refused_in_one_line(error, call, words):
    with pytest.raises(error, match=words) as refused:
        call()
    assert "\n" not in str(refused.value)
    assert len(str(refused.value)) < 200
