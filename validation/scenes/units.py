"""Units of measured files, in the spellings of recorders and with any SI prefix.

A statement of the user such as "12.5 N/V" holds a number, a unit, and behind the first slash the
file's own name of its unit. All but one of the parts may be left out: "us", "0.04 us", "N/V"; a
number alone, "4e-8", is the value in SI of an entry 1.
"""

from __future__ import annotations

import re

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

# Other spellings; upper and lower case are alike.
_SPELLINGS = {
    "s": "s|secs?|seconds?",
    "m": "m|met(er|re)s?",
    "N": "N|newtons?",
    "m/s": "m/s|m/sec",
    "V": "V|volts?",
    "m/s²": r"m/s\^?[2²]|g",
}
_POWERS = {
    **{"f": -15, "p": -12, "n": -9, "u": -6, "µ": -6, "m": -3, "c": -2, "d": -1},
    **{"": 0, "h": 2, "k": 3, "M": 6, "G": 9, "T": 12},
    **{"femto": -15, "pico": -12, "nano": -9, "micro": -6, "milli": -3, "centi": -2},
    **{"kilo": 3, "mega": 6, "giga": 9},
}
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


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
    prefix = parts[1] if parts[1] in _POWERS else parts[1].lower()
    return 10.0 ** _POWERS[prefix] if prefix in _POWERS else None


def same(one: str, other: str = "") -> bool:
    """Whether two texts, or a text and itself, name a unit of the same quantity and size."""
    sizes = [(in_si(one, base), in_si(other or one, base)) for base in _SPELLINGS]
    return any(size is not None and size == second for size, second in sizes)


def read_statement(text: str, quantity: str) -> tuple[float, str]:
    """Return the value in SI of an entry 1, and the name of the file's unit ("" if none is named).

    Raises `SceneError` for a text that is no statement of this quantity.

    >>> read_statement("12.5 mN/V", "force"), read_statement("us", "time")
    ((0.0125, 'V'), (1e-06, 'us'))
    """
    base = BASES[quantity]
    parts = re.fullmatch(rf"({_NUMBER})? *(.*)", text.replace("μ", "µ").strip())
    assert parts is not None  # both may be empty
    number = float(parts[1] or 1)
    words = parts[2].split("/")
    if parts[1] and not parts[2]:
        return number, ""
    for count in (1, 2):  # the unit of a velocity has a slash of its own
        size = in_si("/".join(words[:count]).strip(), base)
        if size is not None:
            named = "/".join(words[count:])
            # A unit alone is the file's, too.
            return number * size, named or (parts[2] if not parts[1] else "")
    raise SceneError(
        f"unit of {quantity} is {shorten(text)}: such as {base}, m{base}, 0.04 {base} or "
        f"12.5 {base}/V is wanted"
    )
