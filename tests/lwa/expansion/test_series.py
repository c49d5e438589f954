"""Series in ε: their k, equality and pickling, symbols of the caller, limits of size."""

import pytest
import sympy as sp

from lwa import Cell, Dimer, InputError, expand
from tests.lwa.expansion.test_exact_waves import series


def test_sums_scale_as_dimensions_demand():
    """Peak force 1, δ = A^{-1/k}: c² ~ 1/(m δ), momentum ~ √(m δ), energy ~ δ; widths in sites."""
    unit, other = (
        series(expand(Cell([m], [A]), 8, k="6/5")) for m, A in ((1, 1), (4, 8))
    )
    delta = 8 ** (-5 / 6)
    scales = {
        "c2": 1 / (4 * delta),
        "momentum": (4 * delta) ** 0.5,
        "energy": delta,
        "effective_mass": 4,
    }
    for name, row in unit.items():
        scaled = row.at() * scales.get(name, 1)
        found = other[name].at()
        assert found.value == pytest.approx(scaled.value, rel=1e-14)
        assert found.error == pytest.approx(scaled.error, rel=1e-9)


@pytest.mark.slow
def test_k_replaces_the_symbol_wherever_it_stands():
    """Prefactor, shares of unlike contacts, radiation."""
    k, cell = sp.Rational(101, 100), Cell([1, 3], [1, 2])
    symbolic, numeric = expand(cell, 6), expand(cell, 6, k=k)
    for read in (lambda e: e.c2, lambda e: e.fwhm("velocity")):
        ours, own = read(symbolic).at(k), read(numeric).at()
        assert ours.value == pytest.approx(own.value, rel=1e-14)
        assert ours.error == pytest.approx(own.error, rel=1e-9)
    assert symbolic.at(k=k) == numeric


def test_an_unlike_contacts_radiation_counts_in_the_error():
    """The error at rational shares, in parts of the value, is that of their neighbours."""
    cells = Cell([100, 200], [1, "2.999"]), Cell([1, 2], [1, 3])
    near, there = (expand(cell, 6, k="26/25").c2.at() for cell in cells)
    assert near.error / near.value == pytest.approx(there.error / there.value, rel=1e-2)


def test_a_sum_whose_terms_grow_too_soon_is_refused():
    """The terms grow from the first on; without them the width is 2.68, in a struck chain 2.98."""
    with pytest.raises(InputError, match="no sum"):
        expand(Dimer(1, "13/20"), 12, k="23/20").fwhm("force").at()


def test_what_takes_seconds_is_not_refused():
    """The sums of these take five seconds at most; order 500 would take hours."""
    for masses, order in (((1, 2, 3), 12), ((1, 2, 3, 4), 10)):
        assert expand(Cell(masses), order, k="3/2").order == order
    with pytest.raises(InputError, match="500"):
        expand(Cell([1]), 500)


def test_a_series_shows_in_a_notebook():
    widths = expand(Cell([1]), 12).fwhm("force")
    assert len(repr(widths)) < 200
    assert "1/10 - log(2)/60" in repr(widths)
    numbers = expand(Cell([1]), 8, k="3/2")
    for shown in (numbers, numbers.c2):  # the lattice's c² is 0.819960
        assert "0.81996" in repr(shown)
    first = r"\left(\frac{1}{10} - \frac{\log{\left(2 \right)}}{60}\right) \varepsilon"
    assert first in widths._repr_latex_()
    assert r" + \dots\Bigr)" in widths._repr_latex_()
    assert r"c^2 &= 1 - \frac{1}{2} \varepsilon" in expand(Cell([1]))._repr_latex_()


def test_at_gives_symbols_their_values():
    wave = expand(Dimer("m1", "m2"), 2)
    assert wave.at(m1=2, omega="1/2", k="3/2") == expand(Cell([2, 1]), 2, k="3/2")
    with pytest.raises(InputError, match="m3"):
        wave.at(m3=1)
