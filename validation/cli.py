"""The command `lwa-validate`, with one command for each study in `validation.studies`.

Studies are found in the text of their modules, and a module is loaded when its command is called:
`--help` does not load SciPy.
"""

from __future__ import annotations

import ast
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from pathlib import Path

import click

from lwa.command.terminal import HELP, run, version

_STUDIES = Path(__file__).parent / "studies"


@cache
def studies() -> dict[str, tuple[str, str]]:
    """Return the module and the help text of each command, by the command's name.

    >>> studies()["limits"][0]
    'validation.studies.limits'
    """
    found = {}
    for file in sorted(_STUDIES.glob("*.py")):
        text = file.read_text(encoding="utf-8")
        if "\n@study(" in text:
            for node in ast.parse(text).body:
                if isinstance(node, ast.FunctionDef) and any(map(_marked, node.decorator_list)):
                    says = (ast.get_docstring(node) or "").partition("\n\n")[0]
                    found[node.name] = f"validation.studies.{file.stem}", says
    return found


def _marked(decorator: ast.expr) -> bool:
    return ast.unparse(decorator).startswith("study(")


class Studies(click.Group):
    """A Click group that loads a command when it is called."""

    def list_commands(self, context: click.Context) -> list[str]:
        """Return the names of all commands."""
        return sorted(studies())

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        """Return the command with a given name, or None."""
        if name not in studies():
            return None
        # here, for a quick start: a study loads SciPy
        found: click.Command = getattr(import_module(studies()[name][0]), name).command
        return found

    def format_commands(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of commands without loading them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, says) for name, (_, says) in sorted(studies().items())])


@click.group(cls=Studies, context_settings=HELP)
@version
def validate() -> None:
    """Simulate chains with contacts F = A δ^k and compare them with the long-wave theory.

    The exit status is 1 if a comparison fails, and 2 for bad input.
    """


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa-validate`."""
    run(validate, "lwa-validate", arguments)
