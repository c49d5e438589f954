"""The command `lwa-validate`, with one command for each study in `validation.studies`.

Studies are found in the text of their modules, and a module is loaded when its command is called:
`--help` does not load SciPy.
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
    """Module, function and help of each command.

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
    """A Click group that loads a command when it is called."""

    def list_commands(self, context: click.Context) -> list[str]:
        """Names of all commands."""
        return sorted(studies())

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        """The command of this name, or None."""
        if name not in studies():
            return None
        module, function, _ = studies()[name]
        # here, for a quick start: a study loads SciPy
        found: click.Command = getattr(import_module(module), function).command
        return found

    def format_commands(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of commands without loading them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, says) for name, (_, _, says) in sorted(studies().items())])


@click.group(cls=Studies, context_settings=HELP)
@version
def validate() -> None:
    """Simulate chains with contacts F = A δ^k and compare them with the long-wave theory.

    The exit status is 1 if a comparison fails, and 2 for bad input.
    """


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the command `lwa-validate`."""
    run(validate, "lwa-validate", arguments)
