"""Traveling waves: closed forms below, floats, units, backgrounds and plots above them."""
