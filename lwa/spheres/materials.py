"""Materials of beads by name: Young's modulus in Pa, Poisson's ratio, density in kg/m³.

The values are typical ones at room temperature. A batch of beads differs from them by some per
cent. Polymers, which are stiffer the faster they are compressed, differ by much more.
"""

from __future__ import annotations

from typing import NamedTuple


class Solid(NamedTuple):
    """A material: E in Pa, ν, the density in kg/m³, all as decimals, and their source."""

    E: str
    nu: str
    density: str
    source: str


MATERIALS = {
    "steel 316": Solid(
        "193e9", "0.30", "8000",
        "E, density: ASM/MatWeb, AISI Type 316, annealed bar; ν: Porter et al. 2008",
    ),
    "steel 440C": Solid(
        "200e9", "0.28", "7700", "makeitfrom.com, AISI 440C, annealed",
    ),
    "aluminium": Solid(
        "68.9e9", "0.33", "2700", "ASM/MatWeb, aluminium 6061-T6",
    ),
    "brass": Solid(
        "103e9", "0.34", "8500",
        "Gere & Goodno, Mechanics of Materials, appendix: 96-110 GPa, 8400-8600 kg/m³",
    ),
    "glass": Solid(
        "72.8e9", "0.222", "2563",
        "soda-lime-magnesia-silicate: Sci. Rep., doi 10.1038/s41598-021-04045-6, table 1",
    ),
    "PTFE": Solid(
        "1.46e9", "0.46", "2178",
        "E, ν: Porter et al. 2008; density: its beads of 0.123 g and 4.76 mm",
    ),
    "delrin": Solid(
        "3.1e9", "0.35", "1420",
        "acetal homopolymer: DuPont, Delrin Design Guide, Module III, Delrin 500",
    ),
}  # fmt: skip
"""The materials by name."""
