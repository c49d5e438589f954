"""The graded differential algebra of the strain: its jets, and the rings of their coefficients."""
