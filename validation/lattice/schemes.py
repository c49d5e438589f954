"""Symmetric splittings of y'' = F(y)/m, by their coefficients.

A step of h applies kick 0, drift 0, kick 1, drift 1, …: a kick adds b h F(y)/m to v, a drift adds
a h v to y. Coefficients are as printed, to all digits, in
  Verlet  Verlet 1967: half a kick, a drift, half a kick
  PEFRL   Omelyan, Mryglod and Folk 2002, Comput. Phys. Commun. 146, 188
  others  Blanes and Moan 2002, J. Comput. Appl. Math. 142, 313: S_6 and, for forces that do not
          depend on v, SRKN_6^b, SRKN_11^b and SRKN_14^a
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lwa.compact.numeric import Array


@dataclass(frozen=True, eq=False)
class Scheme:
    """A splitting, whose first kick or last drift is 0."""

    order: int
    kicks: Array
    drifts: Array

    @property
    def stages(self) -> int:
        """Evaluations of the forces per step."""
        return len(self.kicks) - 1


def _scheme(order: int, kicks: list[float], drifts: list[float], middle: str) -> Scheme:
    """From the first halves but for their last, which make the sums 1; one row has a middle."""

    def whole(half: list[float], odd: bool) -> list[float]:
        last = 1 - 2 * sum(half) if odd else 0.5 - sum(half)
        return [*half, last, *([] if odd else [last]), *half[::-1]]

    b, a = whole(kicks, middle == "kick"), whole(drifts, middle == "drift")
    b, a = ([0.0, *b], a) if len(b) < len(a) else (b, [*a, 0.0])
    return Scheme(order, np.array(b), np.array(a))


# fmt: off
SCHEMES = {
    "SRKN14": _scheme(6,
        [0.09171915262446165, 0.183983170005006, -0.05653436583288827, 0.004914688774712854,
         0.143761127168358, 0.328567693746804],
        [0.0378593198406116, 0.102635633102435, -0.0258678882665587, 0.314241403071447,
         -0.130144459517415, 0.106417700369543, -0.00879424312851058], "drift"),
    "SRKN11": _scheme(6,
        [0.0414649985182624, 0.198128671918067, -0.0400061921041533, 0.0752539843015807,
         -0.0115113874206879],
        [0.123229775946271, 0.290553797799558, -0.127049212625417, -0.246331761062075,
         0.357208872795928], "drift"),
    "SRKN6": _scheme(4,
        [0.0829844064174052, 0.396309801498368, -0.0390563049223486],
        [0.245298957184271, 0.604872665711080], "kick"),
    "S6": _scheme(4,
        [0.0792036964311957, 0.353172906049774, -0.0420650803577195],
        [0.209515106613362, -0.143851773179818], "kick"),
    "PEFRL": _scheme(4, [0.7123418310626054], [0.1786178958448091, -0.06626458266981849], "drift"),
    "Verlet": _scheme(2, [], [], "drift"),
}
# fmt: on

LAWS = {1.0: 1, 1.25: 2, 1.5: 3, 2.0: 4, 3.0: 5}
"""Exponents that have loops of their own in `validation.lattice.kernel`, without a power."""
