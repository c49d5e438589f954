"""Shocks and rarefactions of a chain driven by a wall: the Riemann problem."""
