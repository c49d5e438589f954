"""Any lattice: links with laws of their own, resonators, farther neighbours, packings."""
