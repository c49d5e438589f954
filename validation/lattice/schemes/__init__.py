"""The compiled integrators, by their coefficients.

RKN86  `validation.lattice.schemes.nystrom`: adaptive, the one to take
SRKN14 `validation.lattice.schemes.splitting`: symplectic, for runs of very many collisions
"""

from __future__ import annotations

from validation.lattice.schemes.nystrom import RKN86, Pair
from validation.lattice.schemes.splitting import SRKN14, Splitting

SCHEMES: dict[str, Pair | Splitting] = {"RKN86": RKN86, "SRKN14": SRKN14}

LAWS = {1.0: 1, 1.25: 2, 1.5: 3, 2.0: 4, 3.0: 5}
"""Exponents that have loops of their own in `validation.lattice.kernel`, without a power."""

GENERATED = 6
"""The loop of laws that are no power, by functions that are compiled from their text."""
