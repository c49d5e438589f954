"""The experiment and the figures of Porter et al. (2008)."""
