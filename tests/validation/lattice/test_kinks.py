"""Integrals of a contact's force along a quintic, against adaptive quadrature between the kinks."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from validation.lattice.kernel.arrays import LAW, ROOM
from validation.lattice.kernel.compiled import cached
from validation.lattice.kernel.kinks import EDGES, STRAIGHT, find_edges, integrals


@cached
def compiled(laws, r, quintic, h, points, edges):
    law = laws[0]
    count, _ = find_edges(law, r, quintic, h, edges)
    # The work of a bead that moves as the contact's compression does is the fourth integral.
    return integrals(law, r, quintic, h, 1.0, points, edges, count, True, quintic, 0.0)


def force(contact, quintic, h, x):
    laws, r = contact
    law = laws[0]
    d = slope = 0.0
    for coefficient in reversed(quintic[:6]):
        d, slope = d * x + coefficient, slope * x + d
    if d <= 0:
        return 0.0
    return max(d ** law["k"] + r * d ** law["p"] * slope / h, 0.0)


def kinks(contact, quintic, h):
    """Places between 0 and 1 at which the contact begins or ends to push, by bisection."""
    x = np.linspace(0, 1, 4001)
    pushes = [force(contact, quintic, h, place) > 0 for place in x]
    found = []
    for n in np.flatnonzero(np.diff(pushes)):
        a, b = x[n], x[n + 1]
        while b - a > 1e-15:
            middle = (a + b) / 2
            same = (force(contact, quintic, h, middle) > 0) == pushes[n]
            a, b = (middle, b) if same else (a, middle)
        found.append(b)
    return found


def expected(contact, quintic, h):
    """∫ F, ∫ (1 - x) F and ∫ (1 - x)²/2 F, with x = a + (b - a) (3 u² - 2 u³) between kinks."""
    places = [0.0, *kinks(contact, quintic, h), 1.0]
    total = np.zeros(3)
    for a, b in itertools.pairwise(places):
        for n, weight in enumerate(
            (lambda x: 1.0, lambda x: 1 - x, lambda x: (1 - x) ** 2 / 2)
        ):

            def integrand(u, a=a, b=b, weight=weight):
                x = a + (b - a) * (3 * u * u - 2 * u**3)
                return (
                    6
                    * u
                    * (1 - u)
                    * (b - a)
                    * weight(x)
                    * force(contact, quintic, h, x)
                )

            total[n] += quad(integrand, 0, 1, epsabs=1e-14, epsrel=1e-12, limit=200)[0]
    return total


def contact(k, r, p):
    """With the least q = 1, 2 or 4 for which q k and q p are whole, as `_exponent` has it."""
    laws = np.zeros(1, LAW)
    laws["k"], laws["p"], laws["q"] = k, p, 4.0
    for q in (2.0, 1.0):
        if (q * k).is_integer() and (q * p).is_integer():
            laws["q"] = q
    return laws, r


# Exponents and damping (k, r, p), and the error over the greatest impulse: δ^{1/4} wants u^4, of
# which ten points resolve less.
LAWS = {
    (1.5, 0.0, 0.0): 1e-9, (1.0, 0.0, 0.0): 1e-14, (2.0, 0.0, 0.0): 1e-14,
    (1.5, 0.3, 0.0): 1e-9, (1.5, 0.3, 0.5): 1e-9, (1.5, 0.2, 0.25): 1e-7,
}  # fmt: skip


@pytest.mark.parametrize("law", LAWS)
@settings(max_examples=20)
@given(
    ends=st.tuples(st.floats(-1, -0.01), st.floats(0.01, 1)),
    rises=st.tuples(st.floats(0.5, 1.7), st.floats(0.5, 1.7)),
    opening=st.booleans(),
)
def test_a_contact_that_closes_or_opens(law, ends, rises, opening):
    """Cubics whose slopes at the ends are 0.5 … 1.7 times the mean slope."""
    start, end = ends[::-1] if opening else ends
    jump = end - start
    rise, end_rise = jump * rises[0], jump * rises[1]
    curve = (
        start,
        rise,
        3 * jump - 2 * rise - end_rise,
        rise + end_rise - 2 * jump,
        0.0,
        0.0,
        STRAIGHT,
    )
    check(law, curve, LAWS[law])


@pytest.mark.parametrize("law", LAWS)
@settings(max_examples=20)
@given(depth=st.floats(1e-5, 0.3), place=st.floats(0.1, 0.9), bend=st.floats(0.1, 3))
def test_a_contact_that_closes_and_opens(law, depth, place, bend):
    """Parabolas of a greatest compression ``depth``, at a place of the step."""
    check(
        law,
        (depth - bend * place**2, 2 * bend * place, -bend, 0.0, 0.0, 0.0, STRAIGHT),
        LAWS[law],
    )


def check(law, curve, bound):
    touching = contact(*law)
    found = compiled(*touching, curve, 1.0, np.empty((3, ROOM)), np.empty(EDGES))
    wanted = expected(touching, curve, 1.0)
    assert np.abs(found[:3] - wanted).max() <= bound * wanted[0] + 1e-16
    assert found[4] == found[3]
