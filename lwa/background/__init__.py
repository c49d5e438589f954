"""Waves on a background strain or under a load, from the compact wave to KdV."""
