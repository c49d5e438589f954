"""Chains of real spheres: Hertz's contact, and the files that describe beads."""
