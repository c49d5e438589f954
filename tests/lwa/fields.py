"""The wave equation and its energy at explicit fields, as SymPy expressions."""

import sympy as sp
from flint import fmpq

from lwa.law import phi_symbol


def rational(value):
    """A SymPy rational as FLINT's."""
    return fmpq(int(value.p), int(value.q))


def at_compression(law, value, delta):
    """The value of an expression in φ_2, φ_3, … at a compression."""
    for n in range(2, 9):
        if value.has(phi_symbol(n)):
            value = value.xreplace({phi_symbol(n): law.phi(n).subs(law.delta, delta)})
    return value


def of_fields(pde, terms, u, x, velocity=sp.S.Zero):
    """The sum Σ coefficient · base^{a + bk} · jet for fields u(x) and u_τ(x)."""
    base, law, D = u.diff(x), pde.law, pde.cell.spacing
    total = sp.S.Zero
    for jet, coefficient in terms.items():
        a, b = map(sp.Rational, terms.power.beside(jet))
        factors = [u.diff(x, i) ** e for i, e in jet.x]
        factors += [velocity.diff(x, i) ** e for i, e in jet.t]
        if law.homogeneous:
            factors.append(base ** (a + b * law.k))
        else:
            coefficient = at_compression(law, coefficient, D * base)
            factors.append(law.at(D * base, 1) ** b * base ** (a + b))
        total += coefficient * sp.Mul(*factors)
    return total


def right_side(pde, u, x, velocity=sp.S.Zero):
    """The right-hand side of u_ττ on the acoustic branch."""
    D, p = pde.cell.spacing, u.diff(x)
    total = pde.law.of_strain(p, D, 1) * p.diff(x)
    for n, terms in pde.coefficients.items():
        total += D ** (n - 1) * of_fields(pde, terms, u, x, velocity)
    return total


def energy_density(pde, u, x, velocity=sp.S.Zero):
    """The density of the conserved energy, with the contacts' W(u_x)."""
    D, law = pde.cell.spacing, pde.law
    total = law.of_strain(u.diff(x), D, -1)
    for n, terms in pde.energy.items():
        total += D**n * of_fields(pde, terms, u, x, velocity)
    return total
