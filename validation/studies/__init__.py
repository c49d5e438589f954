"""The studies, each a comparison of theory and lattice."""
