"""Words that are values of options, and the refusal of any other word.

To add a word, extend its `Literal` type: readers, commands, messages and editors follow.
"""

from __future__ import annotations

from collections.abc import Collection
from difflib import get_close_matches
from typing import Any, Literal, TypeVar, get_args

from lwa.base import InputError, cut

QuantityName = Literal["strain", "force", "velocity"]
"""A quantity of a wave that has a width."""

ExtentName = Literal["length", "time"]
"""A kind of width: an extent in space, or the time of passage."""

ClosureName = Literal["linear", "full"]
"""A closure: the paper's linear ansatz, or the one that satisfies every equation of motion."""

BranchName = Literal["acoustic", "optical"]
"""A branch of the dispersion: neighbours move together, or against each other."""

FieldName = Literal["first", "center"]
"""The unknown of a wave equation: the first bead's displacement, or the canonical field."""

LanguageName = Literal["numpy", "c", "javascript"]
"""A language in which `lwa` writes source code."""

QUANTITIES: tuple[QuantityName, ...] = get_args(QuantityName)
EXTENTS: tuple[ExtentName, ...] = get_args(ExtentName)
CLOSURES: tuple[ClosureName, ...] = get_args(ClosureName)
BRANCHES: tuple[BranchName, ...] = get_args(BranchName)
FIELDS: tuple[FieldName, ...] = get_args(FieldName)
LANGUAGES: tuple[LanguageName, ...] = get_args(LanguageName)

# A message has `LONGEST_MESSAGE` characters, a third of them for the line to paste.
_SHOWN = 60  # characters of an offending value: most of a line of a terminal
_NEAR = 3  # similar words that a message names; more are no hint
_LISTED = (
    15  # known words where none is similar: all laws, closures, and keys of a file
)

Word = TypeVar("Word", bound=str)


def one_of(value: Any, known: Collection[Word], name: str) -> Word:
    """Return a word that is among the known ones.

    Parameters
    ----------
    value : Any
        The word that a user gives.
    known : collection of str
        The valid words, such as `QUANTITIES`; of a mapping, its keys.
    name : str
        Name of the argument in messages.

    Raises
    ------
    InputError
        For any other value; the message names similar words, or else the valid ones.

    Examples
    --------
    >>> one_of("forces", QUANTITIES, "quantity")
    Traceback (most recent call last):
        ...
    lwa.base.InputError: quantity is 'forces': did you mean force?
    """
    if isinstance(value, str):
        for word in known:
            if word == value:
                return word
    raise InputError(f"{name} is {shorten(value)}: {suggestion(value, known)}")


def suggestion(value: Any, known: Collection[str]) -> str:
    """Name the known words that are similar to a value, or else all of them.

    >>> suggestion("steel", ["steel 316", "steel 440C", "PTFE"])
    'did you mean steel 316 or steel 440C?'
    >>> suggestion("wood", ["steel 316", "PTFE"])
    'steel 316 or PTFE is wanted'
    """
    near = similar(value, known)
    if near:
        return f"did you mean {' or '.join(near)}?"
    if not known:
        return "none is defined"
    first = [*filter(None, known)][:_LISTED]
    if len(known) <= 2:
        return f"{' or '.join(first)} is wanted"
    return f"one of {', '.join(first)} is wanted"


def similar(value: Any, known: Collection[str]) -> list[str]:
    """The known words that contain a value or are spelt alike, whatever their case."""
    if not isinstance(value, str):
        return []
    word = value[:_SHOWN].casefold()
    names = {name.casefold(): name for name in known}
    near = [folded for folded in names if len(word) > 2 and word in folded]
    # Of ten letters seven agree: "friction" has five of eight letters of "duration".
    near += get_close_matches(word, names, _NEAR, 0.65)
    return [names[folded] for folded in dict.fromkeys(near)][:_NEAR]


def shorten(value: object) -> str:
    """The ``repr`` of an offending value, cut to one short line for a message."""
    try:
        text = repr(value)
    except Exception:  # an integer of thousands of digits, or a class of a user's
        return f"a value of type {type(value).__name__} that cannot be printed"
    return cut(text, _SHOWN)
