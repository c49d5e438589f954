"""The beads of the experiment of Porter et al. (2008), in SI units."""

from __future__ import annotations

from lwa.spheres.hertz import Material, Sphere

STEEL = Material("193e9", "0.3")  # stainless steel, type 316
PTFE = Material("1.46e9", "0.46")  # with the dynamic modulus that the paper uses
DIAMETER = 4.76e-3  # of all beads, in m
STEEL_BEAD = Sphere("0.45e-3", DIAMETER / 2, STEEL)  # also the striker
PTFE_BEAD = Sphere("0.123e-3", DIAMETER / 2, PTFE)
