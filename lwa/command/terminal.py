"""How a command of this project meets its user: exact options in, one clear line for a fault."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from typing import Any

import click
import sympy as sp

from lwa.exact import InputError, exact
from lwa.quantities import NoSolitaryWave


def quantity(context: click.Context, option: click.Parameter, value: str | None) -> sp.Expr | None:
    """Callback of an option that is an integer, a decimal, a fraction or a plain name."""
    return None if value is None else exact(value, _name(option))


def quantities(
    context: click.Context, option: click.Parameter, value: str | None
) -> tuple[sp.Expr, ...]:
    """Callback of an option that is a list of quantities, separated by commas; () when absent."""
    return tuple(exact(part, _name(option)) for part in value.split(",")) if value else ()


def _name(option: click.Parameter) -> str:
    return option.opts[0].lstrip("-")


def run(command: click.Command, name: str, arguments: Sequence[str] | None = None) -> None:
    """Run a command and end the process: 0, or 2 with one line on what was wrong with the input."""
    sys.exit(_status(lambda: command.main(arguments, prog_name=name, standalone_mode=False), name))


def _status(call: Callable[[], Any], name: str) -> int:
    try:
        result = call()
        sys.stdout.flush()
    except click.exceptions.NoArgsIsHelpError as help_text:
        click.echo(help_text.format_message(), err=True)
        return 2
    except click.ClickException as error:
        return _complain(name, error.format_message())
    except (InputError, NoSolitaryWave) as error:
        return _complain(name, str(error))
    except (click.Abort, KeyboardInterrupt):
        click.echo(f"{name}: interrupted", err=True)
        return 130
    except BrokenPipeError:  # the reader has seen enough; nothing is left to flush
        _drop_output()
        return 0
    except OSError as error:  # such as a disk that is full
        _drop_output()
        return _complain(name, f"{error.filename or 'the output'}: {error.strerror or error}")
    return result if isinstance(result, int) else 0


def _drop_output() -> None:
    """Nothing is left to flush at the end of the process."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _complain(name: str, message: str) -> int:
    click.echo(f"{name}: {' '.join(message.split())}", err=True)
    return 2
