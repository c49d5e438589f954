"""Studies: comparisons of theory and lattice, each a command of `lwa-validate`."""
