"""Traveling waves: closed forms, NumPy functions, waves in physical units and under load, code."""
