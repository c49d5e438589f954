"""Bad input of the command `lwa`: one line that names the value, status 2, nothing else."""

import json
import os
import random
import re
import shlex

import click
import pytest

from lwa.base import LONGEST_MESSAGE
from lwa.command.cli import COMMANDS, _put, lwa
from tests.lwa.command.answers import STEEL_AND_PTFE, run

FREE = {"k": 1.5}  # without a load
MASSES = {"cell": [1, 1], "k": 1.5, "stiffnesses": 2, "spacings": 0.5, "repeat": 19}


ANSWERED = set()
"""Lines that were pasted, and answered."""


def refused(capsys, words, *arguments):
    """One line names the value and ends in a line to paste; pasted lines end in an answer."""
    seen = set()
    wanted = words
    while True:
        status, out, err = run(capsys, *arguments)
        if status == 0 and seen:
            ANSWERED.add(arguments)
            return
        assert (status, out, err.count("\n")) == (2, "", 1)
        assert len(err) <= LONGEST_MESSAGE + 1
        assert err.startswith("lwa: ")
        assert wanted in err
        wanted = ""
        reason, proposed = re.split(";? [Tt]ry: ", err)
        # Two refusals in a row never say the same.
        assert reason not in seen
        seen.add(reason)
        command, *arguments = shlex.split(proposed)
        arguments = tuple(arguments)
        # Lines of the other command are run by its tests.
        if command != "lwa" or arguments in ANSWERED:
            return


LINES = [
    ("explain", "No such command"),
    (
        "derive --k 0",
        "k is 0: exponents from 1/100 to 1000 are taken; try: lwa derive --k 3/2",
    ),
    ("derive --k __import__('os').system('true')", 'k is "__import__'),
    ("derive --masses 1,2,3 --closure linear", "try: lwa derive --masses 1,2,3 --clos"),
    ("derive --stiffnesses 1,2,3", "3 stiffnesses for 2 masses"),
    ("derive --order 0", "order is 0"),
    ("derive --order", "Try: lwa derive --help"),
    (
        "derive --closure ful",
        "closure is 'ful': did you mean full?; try: lwa derive --clos",
    ),
    ("derive --field center", "field is 'center'"),
    ("derive --closure full --branch optical", "the optical branch"),
    ("derive --law hertz2:1+1", "is wanted; try: lwa derive --law hertz2:1,2\n"),
    ("derive --law general --k 2", "--law and --k are both given"),
    ("wave --background 1 --force 2", "try: lwa wave --background 1\n"),
    # The example of the option is what was refused.
    ("expansion --masses a,b,c,d,e,f,g,h --order 4", "try: lwa expansion --k 11/10"),
    ("derive --law hertz2:delta,1", "'delta': the name means the compression"),
    ("wave --k D --masses 3,1", "D has two meanings"),
    ("wave --k 29000", "exponents from 1/100 to 1000"),
    ("wave --order 3", "order is 3"),
    # the speed of the canonical field, √(1/6)
    ("wave --k 3 --masses 1,100", "V_s = 0.408248 at B = 1"),
    ("wave --law hertz2", "law is hertz2"),
    ("wave --background 1 --closure linear", "canonical field"),
    ("wave --precompression 1 --format c", "without load"),
    ("expansion --order 100", "order is 100"),
    ("strike --velocity 1", "--example striker > chain.toml"),
    ("wave --branch optical", "try: lwa wave --branch acoustic"),
    ("shock --k=0 --behind 2 --masses 1", "k is 0"),
    (
        "wave --law hertz2:1,2 --masses 1 --spacing 1 --precompression 1",
        "--force 10",
    ),
    ("envelope", "neither --background nor --precompression"),
    ("envelope --background 1 --wavenumber 4", "0 … pi"),
    ("envelope --background 1 --wavenumber pi*2", "wavenumber is 'pi*2'"),
    ("envelope --background 1 --branch optcal", "--branch optical"),
    ("envelope --law general --precompression 1", "law is general"),
    ("envelope --law polynomial:1/2,-1/4 --masses 1 --background 3", "F′ is -2.75"),
    ("shock", "neither --behind nor --piston"),
    ("shock --law magnetic:4,1 --behind 0.123", "spacing is D"),
    # of minutes, if powers of a decimal were factored
    ("shock --k 3.1085 --masses 3,1 --piston D", "--spacing 1 --piston 1"),
]


@pytest.mark.parametrize(("line", "words"), LINES, ids=[line for line, _ in LINES])
def test_lines_are_refused(capsys, line, words):
    refused(capsys, words, *line.split())


def test_an_empty_value_takes_its_option_away():
    line = ["--k", "2", "--law", "x"]
    _put(line, {"k": [], "law": None})
    assert line == []


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"light"]', '"ligth"]', "cell number 2 is 'ligth': did you mean light"),
        ("[chain]", "[chains]", "chains is unknown: did you mean chain"),
        ("cell =", "k = 1.5\ncell =", "chain.k is given"),
        ("0.3", "0.6", "steel.nu is 0.6"),
        ("mass = 0.45e-3", "mass = 1, density = 1", "both mass and density"),
        ("mass = 0.45e-3, ", "", "heavy.mass is missing"),
        ("193e9", "nan", "E is nan"),
        ("[chain]", "precompression = 1\n[chain]", "precompression is 1"),
        ("[chain]", "[chain", "spheres.toml: not TOML"),
    ],
)
def test_files_of_spheres_are_refused(capsys, tmp_path, old, new, words):
    file = tmp_path / "spheres.toml"
    file.write_text(STEEL_AND_PTFE.replace(old, new))
    refused(capsys, words, "wave", "--spheres", str(file))


@pytest.mark.parametrize(
    ("chain", "more", "words"),
    [
        ({"cell": []}, "wave", "chain.cell is empty"),
        ({"stiffnesses": [1, 2, 3]}, "wave", "chain.stiffnesses holds 3"),
        ({"law": "hertz2"}, "wave", "chain has both k and law"),
        ({}, "wave --precompression 1", "the file has a precompression of 2"),
        ({}, "wave --background 1", "the file has a precompression of 2"),
        ({}, "wave --k 2 --spacing 1", ".json\n"),
        ({}, "strike --velocity 1", "precompression is 2"),
        (FREE, "strike", "no striker that moves"),
        (FREE, "strike --velocity v", "'v' has no value"),
        (FREE, "strike --velocity 1e300", "velocity is 1"),
        (FREE | {"cell": [1, 2]}, "strike --velocity 1", "lwa-validate run"),
        (
            {"law": "exponential:1", "k": None, "spacings": None},
            "shock --piston 1",
            "spacing is D",
        ),
    ],
)
def test_scenes_are_refused(capsys, tmp_path, chain, more, words):
    file = tmp_path / "scene.json"
    load = {} if "k" in chain else {"precompression": 2.0}
    keys = {key: value for key, value in (MASSES | chain).items() if value is not None}
    file.write_text(json.dumps(load | {"chain": keys}))
    command, *options = more.split()
    refused(capsys, words, command, "--spheres", str(file), *options)


def test_unreadable_files_are_refused(capsys, tmp_path):
    os.mkfifo(tmp_path / "pipe.toml")
    (tmp_path / "loop.toml").symlink_to(tmp_path / "loop.toml")
    for name, words in (
        ("pipe.toml", "only regular files are read"),
        ("loop.toml", "Too many levels of symbolic links"),
        ("none.toml", "lwa-validate run --example > scene.toml"),
        ("spheres.txt", "a list of spheres is a file ending in .toml or .json"),
        ("a" * 300 + ".toml", "File name too long"),
    ):
        refused(capsys, words, "wave", "--spheres", str(tmp_path / name))


ODD = (
    "1", "7", "1/2", "m", "0", "-1", "nan", "1e400", "2.5", "x y", "é", "1,2,3", "general",
)  # fmt: skip
"""Texts beside the examples of options: values of some, and refused by others."""


@pytest.mark.parametrize(
    "seed", [1, 3, *(pytest.param(n, marks=pytest.mark.slow) for n in (0, 2))]
)
def test_random_lines_answer_or_are_refused(capsys, seed):
    """No traceback, no NaN and no complex number; JSON is JSON; refusals lead to an answer."""
    draw = random.Random(seed)
    for _ in range(15):
        name = draw.choice([*COMMANDS])
        _, command, _ = lwa.resolve_command(click.Context(lwa), [name])
        style = draw.choice(("json", "text", "latex"))
        arguments = [name, "--format", style]
        for option in command.params:
            # Every second text is a valid one: a line of odd ones is refused at its start.
            valid = getattr(
                option.type, "choices", [getattr(option.type, "example", "")]
            )
            if option.name != "style" and draw.random() < 0.3:
                text = draw.choice((draw.choice(valid), draw.choice(ODD)))
                arguments += [option.opts[0], text]
        if draw.random() < 0.1:
            arguments.pop()
        status, out, _ = run(capsys, *arguments)
        if status:
            refused(capsys, "", *arguments)
        elif style == "json":
            json.loads(out, parse_constant=pytest.fail)
        elif style == "text":
            assert not re.search(r"\bnan\b|\bzoo\b", out), arguments
