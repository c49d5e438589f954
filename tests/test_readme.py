"""The README says what is true: its Python example prints what the comments beside it say."""

import re
from pathlib import Path

README = (Path(__file__).parent.parent / "README.md").read_text()


def test_the_python_example(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    exec(example, {})
    expected = re.findall(r"^print\(.*\)\s+# ([^:\n]*)", example, re.MULTILINE)
    assert capsys.readouterr().out.splitlines() == expected
    assert len(expected) == example.count("print(")


def test_the_commands_exist():
    from lwa.command.cli import lwa
    from validation.cli import COMMANDS

    known = {"lwa": lwa.commands, "lwa-validate": COMMANDS}
    shown = re.findall(r"^\$ (lwa\S*) (\w+)", README, re.MULTILINE)
    assert len(shown) > 4
    for program, command in shown:
        assert command in known[program]
