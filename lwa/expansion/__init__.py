"""The lattice's own wave: its expansion near the linear law, and closed forms for every k."""
