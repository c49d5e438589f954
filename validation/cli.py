"""The command `lwa-validate`: the lattice, measured against the theory.

Every `validation.report.command.study` in `validation.studies` is a command of it. They are found
by reading the modules' text, and one is loaded only when it is called: help wants no SciPy.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import cache
from importlib import import_module
from pathlib import Path

import click

from lwa.command.terminal import HELP, run, version

_STUDIES = Path(__file__).parent / "studies"


@cache
def studies() -> dict[str, tuple[str, str, str]]:
    """Command → its module, its function and its help in one line.

    >>> studies()["limits"][:2]
    ('validation.studies.limits', 'limits')
    """
    found = (entry for file in sorted(_STUDIES.rglob("*.py")) for entry in _in(file))
    return {name: (module, function, says) for name, module, function, says in found}


def _in(file: Path) -> Iterator[tuple[str, str, str, str]]:
    text = file.read_text(encoding="utf-8")
    if "\n@study(" not in text:
        return
    module = ".".join(("validation", "studies", *file.relative_to(_STUDIES).with_suffix("").parts))
    for node in ast.parse(text).body:
        if not isinstance(node, ast.FunctionDef):
            continue
        for mark in node.decorator_list:
            match mark:
                case ast.Call(func=ast.Name(id="study"), keywords=words):
                    names = [ast.literal_eval(word.value) for word in words if word.arg == "name"]
                    says = (ast.get_docstring(node) or "").partition("\n\n")[0]
                    yield (names or [node.name])[0], module, node.name, says


class Studies(click.Group):
    """A group whose commands are loaded one by one."""

    def list_commands(self, context: click.Context) -> list[str]:
        """Their names."""
        return sorted(studies())

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        """One of them."""
        if name not in studies():
            return None
        module, function, _ = studies()[name]
        # here, for a quick start: a study loads SciPy and what else it needs
        found: click.Command = getattr(import_module(module), function).command
        return found

    def format_commands(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """The list of them, without loading any."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, says) for name, (_, _, says) in sorted(studies().items())])


@click.group(cls=Studies, context_settings=HELP)
@version
def validate() -> None:
    """The lattice of F = A δ^k contacts, measured against the long-wave theory.

    Ends with 1 when a comparison does not hold and with 2 on bad input.
    """


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa-validate`."""
    run(validate, "lwa-validate", arguments)
