"""Any lattice at rest under a load, and the solitary waves that run in it."""
