"""The README's example, commands, demonstrations, picture and version."""

import json
import re
import runpy
import shlex
import tomllib
from pathlib import Path

import pytest
from PIL import Image

from lwa.command.cli import COMMANDS, main as lwa_main
from tests.commands import ended
from validation.cli import STUDIES, main as validate_main

ROOT = Path(__file__).parent.parent
README, CHANGELOG, CATALOGUE = (
    (ROOT / name).read_text()
    for name in ("README.md", "CHANGELOG.md", "book/reference.md")
)
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())


def test_the_python_example(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    exec(example, {})
    expected = re.findall(r"^print\(.*\)\s+# ([^:\n]*)", example, re.MULTILINE)
    assert capsys.readouterr().out.splitlines() == expected
    assert len(expected) == example.count("print(")


BLOCK = re.findall(r"^\$ (.*?)(?:\s{2,}#.*)?$", CATALOGUE.split("```")[1], re.MULTILINE)


@pytest.mark.parametrize(
    "programs",
    [
        ("lwa wave", "lwa-validate run", "lwa-validate pulses", "lwa-validate compare"),
        pytest.param(("lwa",), marks=pytest.mark.slow),
    ],
    ids=["some", "all"],
)
def test_the_commands_run_one_after_the_other(capsys, folder, engine, programs):
    mains = {"lwa": lwa_main, "lwa-validate": validate_main}
    for line in filter(lambda x: x.startswith(programs), BLOCK):
        command, _, file = line.partition(" > ")
        name, *arguments = shlex.split(command)
        status, out, err = ended(capsys, mains[name], *arguments)
        assert status == 0, (line, err)
        if file:
            Path(file).write_text(out)


def test_every_command_and_demonstration_is_listed():
    studies = [file.stem for file in (ROOT / "book" / "studies").glob("[!_]*.py")]
    known = {"lwa": COMMANDS, "lwa-validate": STUDIES, "python": studies}
    shown = re.findall(
        r"^\$ (lwa\S*|python) (?:book/studies/)?(\w+)", CATALOGUE, re.MULTILINE
    )
    for program, commands in known.items():
        assert {command for name, command in shown if name == program} == set(commands)
    for program, command in re.findall(r"`(lwa|lwa-validate) (\w+)", CHANGELOG):
        assert command in known[program]


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


def test_a_registrys_page_has_no_link_into_the_repository():
    """The package's description is the README without its picture and links to files."""
    hook = PROJECT["tool"]["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]
    text = README
    for rule in hook["substitutions"]:
        text = re.sub(rule["pattern"], rule["replacement"], text)
    assert hook["fragments"] == [{"path": "README.md"}]
    assert 300 < len(README) - len(text) < 1200
    assert "## Examples" in text
    assert re.findall(r"\]\((\w+)", text).count("https") == text.count("](")


def test_citation_and_changelog_agree():
    """Version and date of the release, in all three places."""
    cited = (ROOT / "CITATION.cff").read_text()
    release = tuple(
        re.search(rf"^{key}: (\S+)$", cited, re.MULTILINE)[1]
        for key in ("version", "date-released")
    )
    newest = re.search(r"^## \[(.*?)\] - (\S+)$", CHANGELOG, re.MULTILINE)
    assert newest.groups() == release
    assert PROJECT["project"]["version"] == release[0]
