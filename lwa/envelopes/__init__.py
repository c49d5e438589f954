"""Envelopes of a loaded chain's modes: the nonlinear Schrödinger equation, and its breathers."""
