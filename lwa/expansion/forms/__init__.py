"""Closed forms of the lattice's own wave, their errors, and their source text."""
