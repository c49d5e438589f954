"""Units of measured files, in the spellings of recorders and with any SI prefix.

A statement of the user such as "12.5 N/V" holds a number, a unit, and behind the first slash the
file's own name of its unit. All but one of the parts may be left out: "us", "0.04 us", "N/V"; a
number alone, "4e-8", is the value in SI of an entry 1.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from lwa.base.exact import shorten
from validation.scenes.checks import SceneError

BASES = {
    "time": "s",
    "displacement": "m",
    "force": "N",
    "velocity": "m/s",
    "speed": "m/s",
    "force_error": "N",
    "speed_error": "m/s",
}
"""Units of the quantities that are read."""

# Name and unit of a column: "Force (N)", "Force [N]", "Force in N"
_HEADER = re.compile(r"^(.*?) ?(?:(?:[([] ?|\bin )([^][()\s]+) ?[])]?)?$")

# Other spellings; upper and lower case are alike.
_SPELLINGS = {
    "s": "s|secs?|seconds?",
    "m": "m|met(er|re)s?",
    "N": "N|newtons?",
    "m/s": "m/s|m/sec",
    "V": "V|volts?",
}
_POWERS = {
    **{"f": -15, "p": -12, "n": -9, "u": -6, "µ": -6, "m": -3, "c": -2, "d": -1},
    **{"": 0, "h": 2, "k": 3, "M": 6, "G": 9, "T": 12},
    **{"femto": -15, "pico": -12, "nano": -9, "micro": -6, "milli": -3, "centi": -2},
    **{"kilo": 3, "mega": 6, "giga": 9},
}
_NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


def in_si(unit: str, base: str) -> float | None:
    """Return a unit as a multiple of a base unit, or None for a unit of another quantity.

    >>> [in_si(unit, "s") for unit in ("ms", "uS", "USEC", "Microseconds", "N")]
    [0.001, 1e-06, 1e-06, 1e-06, None]
    """
    # Recorders that write in capitals mean ms by MS; MN may well be a meganewton.
    if unit.isupper() and base != "N":
        unit = unit.lower()
    parts = re.fullmatch(rf"([a-zA-Zµ]*?)(?i:{_SPELLINGS[base]})", unit)
    if parts is None:
        return None
    # M is mega and m milli, but Micro is micro.
    power = _POWERS.get(parts[1], _POWERS.get(parts[1].lower()))
    return None if power is None else 10.0**power


def known(unit: str) -> tuple[str, float] | None:
    """Return the base unit of a unit and its multiple, or None for an unknown unit."""
    for base in _SPELLINGS:
        size = in_si(unit, base)
        if size is not None:
            return base, size
    return None


def name_of(header: str) -> str:
    """Return a header without its unit, as it is compared.

    >>> name_of("# Time [ms]"), name_of("bead 8 Dynamic force (N)")
    ('time', 'bead 8 force')
    """
    return _HEADER.sub(r"\1", header).lower().replace("dynamic ", "").strip("#% ")


def found_unit(cells: Sequence[str]) -> str:
    """Return the unit that the cells above a column state, "" for none; the lowest one counts."""
    for cell in reversed(cells):
        header = _HEADER.fullmatch(cell)
        if header and header[2]:
            return header[2]
    return next(filter(known, reversed(cells)), "")


def read_statement(text: str, base: str) -> tuple[float, str] | None:
    """Return the value in SI of an entry 1, and the name of the file's unit ("" if none is named).

    Parameters
    ----------
    text : str
        A statement of the user.
    base : str
        Unit in SI of the quantity, one of `BASES`.

    Returns
    -------
    tuple or None
        None for a text that is no statement of this quantity.

    Examples
    --------
    >>> read_statement("12.5 mN/V", "N"), read_statement("us", "s"), read_statement("us", "N")
    ((0.0125, 'V'), (1e-06, 'us'), None)
    """
    parts = re.fullmatch(rf"(-?)({_NUMBER})? *(.*)", text.replace("μ", "µ").strip())
    assert parts is not None  # all may be empty
    # A sign alone turns an inverted signal: -N/V.
    sign, number, unit = parts.groups()
    size = float(f"{sign}{number or 1}")
    if number and not unit:
        return size, ""
    # Behind the unit stands whatever the file calls its own, m/s^2 say.
    words = unit.split("/")
    for count in (1, 2):  # the unit of a velocity has a slash of its own
        multiple = in_si("/".join(words[:count]).strip(), base)
        if multiple is not None:
            named = "/".join(words[count:])
            # A unit alone is the file's, too.
            return size * multiple, named or ("" if number else unit)
    return None


def read_time(text: str, name: str, example: str) -> float:
    """Return a time above 0 in SI, as a statement of the user; `SceneError` for another text.

    Parameters
    ----------
    text : str
        The statement.
    name : str
        Name of its option in Python.
    example : str
        A statement that is proposed in its place.
    """
    statement = read_statement(text, "s")
    if statement is None or not statement[0] > 0:
        option = name.replace("_", "-")
        raise SceneError(
            f"{option} is {shorten(text)}: a time above 0 is wanted", **{name: example}
        )
    return statement[0]
