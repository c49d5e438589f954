"""The command `lwa expansion`: the lattice's own wave as a series in k - 1."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from lwa.base.words import QUANTITIES
from lwa.cell import k
from lwa.command.answer import Answer, Lines, Row, Values, attempt
from lwa.command.chain import ChainInput
from lwa.command.options import (
    MASSES,
    STIFFNESSES,
    command,
    exponent_option,
    order_option,
)
from lwa.expansion.expand import expand
from lwa.expansion.series import EpsilonSeries

_ORDER = 8
"""Order of a series in numbers: of equal spheres, sums then err by 1e-5."""

_SYMBOLIC_ORDER = 4
"""Order of a series with symbols, whose terms grow with the order."""

_ERRORS = "estimate of a sum's error, by its last terms and by radiation"


@command(
    "lwa expansion --k 3/2 --masses 1 --order 10",
    "lwa expansion --k 11/10 --masses 1,0.7",
    page="expansion",
)
@exponent_option(k.name)
@MASSES
@STIFFNESSES
@order_option("Highest power of ε = k - 1; by default 8, or 4 with symbols.", None)
def expansion(chain: ChainInput, order: int | None) -> Answer:
    """Expand the solitary wave of the beads themselves in ``ε = k - 1``, and sum the series.

    Each sum comes with an estimate of its absolute error, at the peak force 1 on the first contact
    and with lengths in D; k and the cell must be numbers. `lwa wave` has the closed form of the
    lattice's wave, where there is one, for every k.

    Behind a striker the two contacts of a dimer bear different forces: the widths and their errors
    hold for the mean of the two.

    In JSON c² is the sum of ``c2[n] ε^n``. `fwhm` is that of the first contact, `fwhm_contact_2`
    that of the second where contacts are unlike, and so on.
    """
    cell = chain.cell
    expanded = expand(cell, order or _SYMBOLIC_ORDER, law=chain.law)
    # Whether an expansion is one in numbers is known when it is made; four orders take no time.
    if order is None and expanded.numeric:
        expanded = expand(cell, _ORDER, law=chain.law)
    # The coefficients of c² alone are in JSON: the other series are computed from its parts.
    head: Values = {
        "k": expanded.k,
        "masses": cell.masses,
        "stiffnesses": cell.stiffnesses,
        "order": expanded.order,
        "c2": [expanded.c2.prefactor * a for a in expanded.c2.coefficients],
    }
    # Series and their names in text, by their names in JSON
    series = {"c2": ("c²", expanded.c2)}
    # Unlike contacts have unlike widths; series with symbols are long enough for one.
    contacts = 1
    if expanded.numeric and not cell.equal_contacts:
        contacts = cell.size
    for i in range(contacts):
        for q in QUANTITIES:
            key = f"fwhm.{q}"
            label = f"FWHM of the {q}"
            if i:
                key = f"fwhm_contact_{i + 1}.{q}"
                label += f", contact {i + 1}"
            series[key] = (label, expanded.fwhm(q, i))
    series["momentum"] = ("momentum", expanded.momentum)
    series["energy"] = ("energy", expanded.energy)
    rows: Lines = [
        chain.text,
        "ε = k - 1; peak force 1 on the first contact, lengths in D",
        "",
    ]
    if expanded.numeric:
        rows.append(f"at k = {expanded.k}, order {expanded.order}:")
        for key, (label, part) in series.items():
            rows.append(Row(key, label, attempt(part.at)))
        # A mass of the pulse as a particle: what a striker meets.
        mass = attempt(expanded.effective_mass.at)
        rows.append(Row("effective_mass", "effective mass P²/2E", mass))
        rows.append("")
    rows.append(_series_lines(series))
    return Answer(head, rows, shown=[expanded], errors=_ERRORS)


def _series_lines(series: Mapping[str, tuple[str, EpsilonSeries]]) -> Iterator[str]:
    """Lines of text with the coefficients of each series."""
    for label, part in series.values():
        factors = []  # before the sum
        if part.prefactor != 1:
            factors.append(str(part.prefactor))
        if part.power != 0:
            factors.append(f"ε^({part.power})")
        yield f"{label} = {' '.join([*factors, 'Σ a_n ε^n'])}"
        for n, a in enumerate(part.coefficients):
            yield f"  a{n} = {a}"
