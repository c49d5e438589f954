"""The linear chain: its exact dispersion relation, the series of its branches, and its bands."""
