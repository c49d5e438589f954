"""Materials of beads: names for scene files, and their elastic constants."""

from __future__ import annotations

from lwa.spheres.hertz import MATERIALS
from validation.report.command import study
from validation.report.result import Report
from validation.report.table import Column, Table

_COLUMNS = (
    Column("name", "material"),
    Column("E_value", "E (Pa)"),
    Column("nu_value", "ν"),
    Column("density_value", "density (kg/m³)"),
)
_NOTE = """\
A bead of a file names its material, as in material = "PTFE". A material of the file's own may be
like another one but for the constants that are stated: [materials.soft], like = "PTFE", E = 6e8."""


@study(
    page="recipes",
    examples=("lwa-validate materials", "lwa-validate materials --format csv"),
)
def materials() -> Report:
    """Names and constants of the materials of beads.

    ``rows``: ``name``, Young's modulus ``E_value`` in Pa, Poisson's ratio ``nu_value`` and
    ``density_value`` in kg/m³. Sources: `lwa.spheres.hertz`.
    """
    rows = []
    for name, material in MATERIALS.items():
        row: dict[str, object] = {"name": name}
        for constant in ("E", "nu", "density"):
            row[f"{constant}_value"] = float(getattr(material, constant))
        rows.append(row)
    return Report("Materials", (Table.of(_COLUMNS, rows, "rows", note=_NOTE),))
