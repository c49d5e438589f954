"""Motion of a chain: equations, integrators, records, and the cost of a run."""
