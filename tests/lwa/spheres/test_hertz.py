"""Hertz's A and the cells of spheres: the paper's formula, its limits, what is refused."""

from fractions import Fraction

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import Cell, InputError, Material, Sphere, homogenize
from lwa.spheres import hertz
from lwa.spheres.hertz import stiffness
from tests.identity import same

E1, E2, R1, R2, m1, m2 = sp.symbols("E1 E2 R1 R2 m1 m2", positive=True)
n1, n2 = sp.symbols("n1 n2", real=True)
FIRST, SECOND = Sphere(m1, R1, Material(E1, n1)), Sphere(m2, R2, Material(E2, n2))

sizes = st.fractions(min_value="1/1000", max_value=1000, max_denominator=1000)
ratios = st.fractions(min_value="-99/100", max_value="1/2", max_denominator=100)
spheres = st.builds(Sphere, sizes, sizes, st.builds(Material, sizes, ratios))


def test_the_formula_as_the_paper_writes_it():
    A = 4 * E1 * E2 * sp.sqrt(R1 * R2 / (R1 + R2)) / (3 * (E2 * (1 - n1**2) + E1 * (1 - n2**2)))
    assert same(stiffness(FIRST, SECOND), A)
    assert stiffness(FIRST, SECOND) == stiffness(SECOND, FIRST)


def test_a_wall_is_a_sphere_of_infinite_radius():
    limit = sp.limit(stiffness(FIRST, SECOND), R2, sp.oo)
    assert same(limit, stiffness(FIRST, SECOND.material))


@given(spheres, spheres)
def test_numbers_and_symbols_agree(a, b):
    given = {E1: a.material.E, n1: a.material.nu, R1: a.radius}
    given |= {E2: b.material.E, n2: b.material.nu, R2: b.radius}
    for other, sphere in ((SECOND, b), (SECOND.material, b.material)):
        ratio = stiffness(FIRST, other).subs(given) / stiffness(a, sphere)
        assert abs(ratio.n(40) - 1) < 1e-35


def test_floats_are_the_decimals_they_print_as():
    from_floats = Sphere(0.45e-3, 2.38e-3, Material(193e9, 0.3))
    from_text = Sphere("0.45e-3", Fraction(238, 100000), Material(193 * 10**9, "3/10"))
    assert from_floats == from_text
    assert not stiffness(from_floats, from_floats).has(sp.Float)


def test_the_mass_of_a_density():
    steel = Material(193e9, 0.3)
    assert Sphere.solid(2, steel, 6).mass == 64 * sp.pi
    # 7.8 g/cm³ in SI; the paper's beads, 4.76 mm in diameter, weigh 0.45 g
    assert float(Sphere.solid(2.38e-3, steel, 7970).mass) == pytest.approx(4.5e-4, rel=1e-3)


@given(st.lists(spheres, min_size=1, max_size=4))
def test_a_cell_is_as_long_as_its_spheres(row):
    cell = Cell.of_spheres(row)
    assert cell.masses == tuple(sphere.mass for sphere in row)
    assert cell.size * cell.spacing == sum(2 * sphere.radius for sphere in row)
    for i, A in enumerate(cell.stiffnesses):  # the last one joins the cell to the next
        assert stiffness(row[i], row[(i + 1) % len(row)]) == A


def test_a_dimer_of_symbols_has_the_papers_theory():
    theory = homogenize(Cell.of_spheres([FIRST, SECOND]), k=hertz.EXPONENT)
    wanted = homogenize(Cell([m1, m2], spacing=R1 + R2), k=hertz.EXPONENT)
    for found, printed in zip(
        (theory.pde.G, theory.pde.H, theory.pde.I),
        (wanted.pde.G, wanted.pde.H, wanted.pde.I),
        strict=True,
    ):
        assert sp.cancel(found - printed) == 0


@pytest.mark.parametrize("bad", [0, float("nan"), "x y"])
def test_sizes_must_be_positive(bad):
    steel = Material(1, 0)
    for name, make in (
        ("E", lambda: Material(bad, 0)),
        ("mass", lambda: Sphere(bad, 1, steel)),
        ("radius", lambda: Sphere(1, bad, steel)),
        ("radius", lambda: Sphere.solid(bad, steel, 1)),
    ):
        with pytest.raises(InputError, match=f"^{name} is "):
            make()


@pytest.mark.parametrize("bad", [-1, "0.51"])
def test_poissons_ratio(bad):
    with pytest.raises(InputError, match=r"^nu is "):
        Material(1, bad)


def test_arguments_that_are_no_spheres_are_refused():
    ball, steel = Sphere(1, 1, Material(1, 0)), Material(1, 0)
    for call, words in (
        (lambda: Sphere(1, 1, "steel"), "material is 'steel': a Material"),
        (lambda: stiffness(steel, ball), "sphere is Material"),
        (lambda: stiffness(ball, 1), "other is 1: a Sphere"),
        (lambda: Cell.of_spheres([ball, steel]), "sphere is Material"),
        (lambda: Cell.of_spheres([]), "at least one mass"),
        (lambda: Cell.of_spheres(ball), "spheres: a sequence"),
    ):
        with pytest.raises(InputError, match=f"^.*{words}"):
            call()
