"""Bloch modes of a loaded cell, in floats or in exact numbers, in the units of the cell."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import sympy as sp

from lwa.base.exact import InputError, demand_numbers
from lwa.cell import Cell
from lwa.envelopes.response import DRIVEN, SOUND, TOUCHING, Contacts, Mode
from lwa.law import ContactLaw

K2, K3, K4 = sp.symbols("K2 K3 K4", positive=True)
"""Coefficients of the force ``K2 δ + K3 δ² + K4 δ³`` on top of the load, under `lwa.general`."""


class LoadedLaw(NamedTuple):
    """A contact law about a static compression: the force ``F′ (δ + s δ²/δ0 + t δ³/δ0²)`` on top.

    Parameters
    ----------
    slope : Expr
        ``F′``.
    s, t : Expr
        The nonlinearities.
    length : Expr
        The unit δ0 of the compression: the static one, or 1 without load and under `lwa.general`.
    """

    slope: sp.Expr
    s: sp.Expr
    t: sp.Expr
    length: sp.Expr

    @classmethod
    def of(cls, law: ContactLaw, delta: sp.Expr) -> LoadedLaw:
        """Return a law about a compression."""
        if law.formless:
            return cls(K2, K3 / K2, K4 / K2, sp.S.One)
        slope = law.at(delta, 1)
        if delta.is_zero:
            s = law.at(delta, 2) / slope / 2
            t = law.at(delta, 3) / slope / 6
            return cls(slope, s, t, sp.S.One)
        s = law.phi(2).subs(law.delta, delta) / 2
        t = law.phi(3).subs(law.delta, delta) / 6
        return cls(slope, s, t, delta)


def cell_mode(
    cell: Cell,
    law: ContactLaw,
    compression: sp.Expr,
    wavenumber: sp.Expr,
    branch: int,
    floats: bool,
) -> Mode:
    """Return the mode of a branch of a loaded cell, in the units of the cell.

    Parameters
    ----------
    cell : Cell
        The chain.
    law : ContactLaw
        The law of its contacts.
    compression : Expr
        Mean static compression of the contacts.
    wavenumber : Expr
        κ per cell.
    branch : int
        Number of the branch, from 0.
    floats : bool
        True for floats, False for exact numbers.

    Raises
    ------
    InputError
        Where branches touch, for sound, and where the mode drives a mode of twice its frequency.
    """
    loaded = LoadedLaw.of(law, compression * cell.shares(law.exponent)[0])
    compliances = cell.compliances(law.exponent)
    mass = cell.masses[0]
    contacts = Contacts(
        masses=np.array([m / mass for m in cell.masses]),
        c=np.array([sp.powsimp(part / compliances[0]) for part in compliances]),
        s=loaded.s,
        t=loaded.t,
    )
    if floats:
        numbers = (*contacts.masses, *contacts.c, contacts.s, contacts.t, wavenumber)
        free = set().union(*(x.free_symbols for x in numbers))
        demand_numbers(free, "floats need numbers")
        mode = contacts.floats().mode(float(wavenumber), branch)
    elif wavenumber.is_zero and branch == 0:
        raise InputError(SOUND)
    elif cell.size == 1:
        mode = equal_beads(contacts.s, contacts.t, wavenumber)
    else:
        mode = pair_at_edge(contacts, sp.cos(wavenumber), branch)
    rate = sp.powsimp(cell.stiffnesses[0] * loaded.slope / mass)  # unit of ω²
    length = loaded.length
    return Mode(
        square=sp.sympify(mode.square) * rate,
        slope=mode.slope * rate,
        curvature=mode.curvature * rate,
        cubic=mode.cubic * rate / (mass * length**2),
        mean=_scaled(mode.mean, 1 / (mass * length)),
        size=_scaled(mode.size, 1 / mass),
        shape=_scaled(mode.shape, 1 / sp.sqrt(mass)),
    )


def _scaled(values: Iterable[Any], unit: sp.Expr) -> list[sp.Expr]:
    """Values in a unit."""
    return [sp.sympify(value) * unit for value in values]


def equal_beads(s: sp.Expr, t: sp.Expr, wavenumber: sp.Expr) -> Mode:
    """The mode of a cell of one bead in closed form, in the units of `lwa.envelopes.response`.

    With S and C for ``sin κ/2`` and ``cos κ/2``: ``ω = |d| = 2S`` and ``c_g = C``, hence
    ``e0 = -2s |d|²/(1 - C²) = -8s``. The second harmonic has
    ``G = 4 sin²κ/(4 sin²κ - 16 S²) = -C²/S²`` and ``e2 = s d² C²/S²``.
    """
    S = sp.sin(wavenumber / 2)
    C = sp.cos(wavenumber / 2)
    return Mode(
        square=4 * S**2,
        slope=4 * S * C,
        curvature=-(S**2),
        cubic=48 * t * S**4 - 32 * s**2 * S**2 * (1 + S**2),
        mean=[-8 * s],
        size=[4 * S**2],
        shape=[sp.S.One],
    )


def pair_at_edge(contacts: Contacts, edge: sp.Integer, branch: int) -> Mode:
    """The mode of two beads at the edge of a band in closed form.

    At ``κ = 0`` the beads swing against each other. At ``κ = π`` one of two unlike beads between
    equal contacts swings alone, and one of two unlike contacts between equal beads works alone.

    The second harmonic has the wavenumber 0. It shifts the first bead by y against the second, and
    so compresses the contacts by y and -y::

        (K2_1 + K2_2 - 4x μ) y = K3_2 d_2² - K3_1 d_1²,    μ = m_1 m_2/(m_1 + m_2).

    Parameters
    ----------
    contacts : Contacts
        The cell under load; at ``κ = π`` masses or contacts are alike. Of symbols the first mass is
        taken to be the heavier one, and the first contact the stiffer one.
    edge : {1, -1}
        ``cos κ``.
    branch : int
        0 for the acoustic branch, 1 for the optical one.

    Raises
    ------
    InputError
        Where the branches touch, and where the second harmonic is a mode that the mode drives.
    """
    m1, m2 = contacts.masses
    c1, c2 = contacts.c
    total = m1 + m2
    reduced = m1 * m2 / total
    stiffness = 1 / c1 + 1 / c2
    light = 0 if (m1 - m2).is_negative else 1
    if edge == 1:
        x = stiffness / reduced
        phi = np.array([m2, -m1]) / sp.sqrt(m1 * m2 * total)
        if light == 1:
            phi = -phi
    elif m1 != m2:
        bead = light if branch == 1 else 1 - light
        mass = contacts.masses[bead]
        x = 2 / (c1 * mass)
        phi = np.array([sp.S.Zero, sp.S.Zero])
        phi[bead] = 1 / sp.sqrt(mass)
    elif c1 != c2:
        stiff = 1 if (c1 - c2).is_positive else 0
        contact = stiff if branch == 1 else 1 - stiff
        x = 2 / (contacts.c[contact] * m1)
        # The beads on both sides of the contact move against each other.
        phi = np.array([1, -1 if contact == 0 else 1]) / sp.sqrt(2 * m1)
    else:
        raise InputError(TOUCHING)
    size = np.array([phi[0] - phi[1], phi[1] - edge * phi[0]]) ** 2
    K3 = contacts.s / contacts.c**2
    K4 = contacts.t / contacts.c**3
    drive = K3[1] * size[1] - K3[0] * size[0]
    y = sp.S.Zero
    if drive != 0:
        rate = stiffness - 4 * x * reduced
        if rate.is_zero:
            raise InputError(DRIVEN)
        y = drive / rate
    # c_g is 0 at the edge, and so is the lasting force.
    mean = -2 * contacts.c * K3 * size
    return Mode(
        square=x,
        slope=sp.S.Zero,
        # m_1 m_2 x² - (K2_1 + K2_2)(m_1 + m_2) x + 2 K2_1 K2_2 (1 - cos κ) = 0 twice by κ
        curvature=edge / (c1 * c2 * (stiffness * total - 2 * m1 * m2 * x)),
        cubic=(3 * K4 * size**2 + 2 * K3 * size * mean).sum() - 2 * drive * y,
        mean=mean,
        size=size,
        shape=phi,
    )
