"""The next step: examples at the end of a help, and the line to paste behind a refusal."""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping, Sequence
from typing import Any

import click

from lwa.base import LONGEST_MESSAGE, InputError, Refusal


def called(option: click.Parameter) -> str:
    """Name of an option in messages, without its dashes."""
    return option.opts[0].lstrip("-")


class ValueOption(click.Option):
    """An option with an example, which the refusal of another text proposes."""

    def __init__(self, *names: Any, example: str, **settings: Any) -> None:
        super().__init__(*names, **settings)
        self.example = example

    def process_value(self, ctx: click.Context, value: Any) -> Any:
        """Read the text of the option."""
        try:
            return super().process_value(ctx, value)
        except InputError as refusal:
            change = {called(self): self.example}
            raise InputError(refusal.reason, **change) from None


def help_end(examples: Sequence[str], page: str) -> str:
    """The end of a command's help.

    Parameters
    ----------
    examples : sequence of str
        Lines that run one after another in an empty folder.
    page : str
        Name of the book's page on the command, without an ending; empty for none.
    """
    # Click leaves the lines of a paragraph after \b as they are.
    parts = ["\b\nExamples:", *(f"  {line}" for line in examples)]
    if page:
        parts += ["", f"In the book: {page}.html"]
    return "\n".join(parts)


def next_step(
    refusal: Refusal, command: click.Command, name: str, arguments: Sequence[str]
) -> str:
    """The reason of a refusal and, if an option is to be changed, the line to paste."""
    chosen: click.Command | None = command
    if isinstance(command, click.Group):
        chosen = command.get_command(click.Context(command), arguments[0])
    options = {called(option): option for option in chosen.params} if chosen else {}
    change = refusal.change or _example(refusal.reason, options, arguments)
    if not change or not options.keys() >= change.keys():
        return str(refusal)
    line = shlex.join([name, *corrected(arguments, change)])
    text = f"{refusal.reason}; try: {line}"
    if len(text) + len(name) + 2 <= LONGEST_MESSAGE:
        return text
    parts = [f"--{option} {value}" for option, value in change.items()]
    return f"{refusal.reason}; try {' '.join(parts)}"


_SUBJECT = re.compile(r"(\w+) is |'(\w+)' has no value")
"""The option at the start of a reason, or the symbol for which a number is wanted."""


def _example(
    reason: str, options: Mapping[str, click.Parameter], arguments: Sequence[str]
) -> dict[str, object]:
    """The example of the option that a reason is about; {} if it is about no option."""
    subject = _SUBJECT.match(reason)
    if subject is None:
        return {}
    for name, option in options.items():
        if not isinstance(option, ValueOption) or option.example in arguments:
            continue
        text = option.default
        if f"--{name}" in arguments[:-1]:
            text = arguments[arguments.index(f"--{name}") + 1]
        symbols = re.findall(r"\w+", str(text))
        if name == subject[1] or subject[2] in symbols:
            return {name: option.example}
    return {}


def corrected(arguments: Sequence[str], change: Mapping[str, object]) -> list[str]:
    """The arguments of a command with some options changed.

    Parameters
    ----------
    arguments : sequence of str
        The words behind the name of the program.
    change : mapping
        Values by the names of options without dashes; None for an option that is left out.

    Examples
    --------
    >>> corrected(["wave", "--k=0", "--force", "1"], {"k": "3/2", "force": None})
    ['wave', '--k', '3/2']
    """
    kept = []
    words = iter(arguments)
    for word in words:
        option, equals, _ = word.partition("=")
        if not option.startswith("--") or option[2:] not in change:
            kept.append(word)
        elif not equals:
            next(words, None)  # the option's value
    for name, value in change.items():
        if value is not None:
            kept += [f"--{name}", str(value)]
    return kept
