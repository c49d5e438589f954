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
    from validation.cli import studies

    known = {"lwa": lwa.commands, "lwa-validate": studies()}
    shown = re.findall(r"^\$ (lwa\S*) (\w+)", README, re.MULTILINE)
    assert {command for program, command in shown if program == "lwa-validate"} == set(studies())
    for program, command in shown:
        assert command in known[program]
