"""Coefficients of the compiled integrators.

RKN86  `validation.lattice.schemes.nystrom`: adaptive, the default
SRKN14 `validation.lattice.schemes.splitting`: symplectic, for runs of very many collisions
"""

from __future__ import annotations

from validation.lattice.schemes.nystrom import RKN86, Pair
from validation.lattice.schemes.splitting import SRKN14, Splitting

SCHEMES: dict[str, Pair | Splitting] = {"RKN86": RKN86, "SRKN14": SRKN14}

LAWS = {1.0: 1, 1.25: 2, 1.5: 3, 2.0: 4, 3.0: 5}
"""Numbers of the loops for exponents that need no general power (kernel/force.py)."""

GENERATED = 6
"""Number of the loop for laws that are no powers, which calls functions of their own."""
