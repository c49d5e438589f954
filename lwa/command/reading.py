"""Readers of options, callbacks of click: exact numbers, lists of them, counts, contact laws."""

from __future__ import annotations

import re

import click
import sympy as sp

from lwa.base.exact import exact, integer
from lwa.law import ContactLaw, read_law


def quantity(context: click.Context, option: click.Parameter, value: str | None) -> sp.Expr | None:
    """Callback of click that reads an integer, a decimal, a fraction or a plain name."""
    return None if value is None else exact(value, called(option))


def quantities(
    context: click.Context, option: click.Parameter, value: str | None
) -> tuple[sp.Expr, ...]:
    """Callback of click that reads quantities separated by commas; () when absent."""
    return tuple(exact(part, called(option)) for part in value.split(",")) if value else ()


def angle(context: click.Context, option: click.Parameter, value: str) -> sp.Expr:
    """Callback of click that reads a quantity or a part of pi, such as pi, pi/3 or 2pi/3."""
    part = re.fullmatch(r"([0-9]*)\*?pi(?:/([1-9][0-9]*))?", value.strip())
    if part is None:
        return exact(value, called(option))
    return sp.Rational(int(part[1] or 1), int(part[2] or 1)) * sp.pi


def count(context: click.Context, option: click.Parameter, value: str) -> int:
    """Callback of click that reads an integer from 1 on."""
    name = called(option)
    return integer(exact(value, name), name, 1)


def contact_law(
    context: click.Context, option: click.Parameter, value: str | None
) -> ContactLaw | None:
    """Callback of click that reads NAME or NAME:PARAM,… of a law in `lwa.law.named`."""
    return None if value is None else read_law(value, called(option))


def called(option: click.Parameter) -> str:
    """An option's name in messages, without its dashes."""
    return option.opts[0].lstrip("-")
