"""The README's example, commands, demonstrations, picture and version."""

import json
import re
import runpy
import tomllib
from pathlib import Path

import pytest
from PIL import Image

ROOT = Path(__file__).parent.parent
README, CHANGELOG, CATALOGUE = (
    (ROOT / name).read_text() for name in ("README.md", "CHANGELOG.md", "book/commands.md")
)


def test_the_python_example(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    exec(example, {})
    expected = re.findall(r"^print\(.*\)\s+# ([^:\n]*)", example, re.MULTILINE)
    assert capsys.readouterr().out.splitlines() == expected
    assert len(expected) == example.count("print(")


def test_the_commands_exist():
    from lwa.command.cli import COMMANDS
    from validation.cli import STUDIES

    known = {"lwa": COMMANDS, "lwa-validate": STUDIES}
    shown = re.findall(r"^\$ (lwa\S*) (\w+)", CATALOGUE, re.MULTILINE)
    for program, commands in known.items():
        assert {command for name, command in shown if name == program} == set(commands)
    for program, command in re.findall(r"`(lwa|lwa-validate) (\w+)", CHANGELOG):
        assert command in known[program]


def test_the_demonstrations_are_listed():
    shown = re.findall(r"^\$ python book/studies/(\w+)\.py", CATALOGUE, re.MULTILINE)
    there = {file.stem for file in (ROOT / "book" / "studies").glob("*.py")} - {"__init__"}
    assert sorted(shown) == sorted(there)


def test_the_picture_shows_what_its_script_computes(engine):
    """The numbers drawn stand in the file; lattice and theory give the same numbers today."""
    (file,) = re.findall(r"^!\[[^]]+\]\((.*)\)$", README, re.MULTILINE)
    with Image.open(ROOT / file) as image:
        drawn = json.loads(image.text["Comment"])
    now = runpy.run_path(str(ROOT / "book" / "picture.py"))["passage"]()
    numbers = now.numbers
    assert drawn.keys() == numbers.keys()
    for name, values in numbers.items():  # five digits, and the integration's error
        largest = max(values) if isinstance(values, list) else values
        assert drawn[name] == pytest.approx(values, rel=0, abs=1e-4 * largest)
    for speed in (float(now.theory.speed), now.lattice_speed):
        assert f"at {speed:.1f} m/s" in README


def test_citation_and_changelog_agree():
    """Version and date of the release, in all three places."""
    cited = (ROOT / "CITATION.cff").read_text()
    release = tuple(
        re.search(rf"^{key}: (\S+)$", cited, re.MULTILINE)[1]
        for key in ("version", "date-released")
    )
    newest = re.search(r"^## \[(.*?)\] - (\S+)$", CHANGELOG, re.MULTILINE)
    assert newest.groups() == release
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["version"] == release[0]
