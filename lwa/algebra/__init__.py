"""The graded differential algebra of the strain: jets, and the rings of their coefficients."""
