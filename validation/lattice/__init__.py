"""The motion of a chain: its equations, the integrators, and what a run takes."""
