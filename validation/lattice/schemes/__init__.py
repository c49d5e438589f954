"""Coefficients of the compiled integrators.

RKN86  `validation.lattice.schemes.nystrom`: adaptive, the default
SRKN14 `validation.lattice.schemes.splitting`: symplectic, for runs of very many collisions
"""

from __future__ import annotations

from validation.lattice.schemes.nystrom import RKN86, Pair
from validation.lattice.schemes.splitting import SRKN14, Splitting

SCHEMES: dict[str, Pair | Splitting] = {"RKN86": RKN86, "SRKN14": SRKN14}
