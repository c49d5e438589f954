"""Exact traveling waves of the lattice, by Newton's method."""
