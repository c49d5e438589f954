"""Scenes: beads, contacts, initial states, sensors, and the files that describe them."""
