"""Random command lines of `lwa-validate`: each ends with a result or with one line that refuses."""

import json
import random
import re

import pytest

from tests.commands import ended
from validation import cli
from validation.studies.run import example

NUMBERS = (
    *(
        "0",
        "1",
        "-1",
        "3/2",
        "2",
        "5/4",
        "1/2",
        "0.3428458",
        "1e-3",
        "1e300",
        "1e-300",
        "1e400",
    ),
    *(
        "nan",
        "inf",
        "x",
        "D",
        "1/0",
        "2.5",
        "10",
        "-0",
        "1,2",
        "1,0.5",
        "٣",
        "1e99999999",
        "3:1",
    ),
    *("0x10", "1_000", "[1]", "__import__('os')", "", "9" * 400),
)
FILES = (
    "pulses.csv",
    "flat.csv",
    "nan.csv",
    "wild.csv",
    "run.csv",
    "paper.toml",
    "none.csv",
    ".",
)
RENAMED = ("time=x", "time", "a=b=c", "=", "")
UNITS = (
    "time=ms",
    "force=2 N/V",
    "speed=m/s",
    "1 force=1e999 N/V",
    "x=s",
    "time=1..e N/V",
    "=",
)
OPTIONS = {
    "exact": {"--k": NUMBERS, "--masses": NUMBERS},
    "resonances": {"--k": NUMBERS, "--count": ("1", "0", "7", "x")},
    "law": {
        "": FILES, "--masses": NUMBERS, "--spacing": NUMBERS, "--spheres": FILES,
        "--material": ("ptfe", "steel", "x", ""),
        "--unit": UNITS,
    },
    "paper": {"--velocity": NUMBERS},
    "run": {
        "": FILES, "--method": ("RKN86", "symplectic", "x"), "--rtol": NUMBERS,
        "--out": ("o.csv", "o.json", "o.npz", "x/y.csv", ""),
    },
    "compare": {"": FILES, " ": FILES, "--column": RENAMED, "--unit": UNITS},
    "pulses": {
        "": FILES, "--distance": NUMBERS, "--of": ("bead", "x"), "--column": RENAMED,
        "--unit": UNITS,
    },
    "sweep": {
        "--k": ("3/2", "x", "1:2", "0", "7"), "--omega": ("1", "x", "0", "1e300"),
        "--stretch": ("2", "0", "x"), "--file": ("s.sqlite", "pulses.csv", "x/y.sqlite", ""),
        "--jobs": ("1", "0", "x"),
    },
}  # fmt: skip
NEEDED = {"sweep": ("--k", "--omega"), "resonances": ("--count",)}
"""Options without which a command takes longer than a second."""


def line(draw):
    """A random command line."""
    name = draw.choice([*OPTIONS])
    line = [name]
    for option, values in OPTIONS[name].items():
        if not option.strip():
            line.append(draw.choice(values))
        elif option in NEEDED.get(name, ()) or draw.random() < 0.4:
            line += [option, draw.choice(values)]
    if draw.random() < 0.4:
        line += ["--format", draw.choice(("json", "csv", "text", "xml"))]
    if draw.random() < 0.1:
        line += ["--plot", draw.choice(("p.svg", "p.doc", "x/p.svg", "."))]
    return line


def pulses(draw, size):
    """A file of pulses of any size, with or without a law."""
    force = [size * draw.uniform(0.5, 3) for _ in range(9)]
    speed = [
        draw.uniform(1, 2) * (F / size) ** draw.choice((0, 1 / 6, 0.3)) for F in force
    ]
    rows = (f"{F!r},{V!r}\n" for F, V in zip(force, speed, strict=True))
    return "force,speed\n" + "".join(rows)


@pytest.mark.parametrize("count", [80, pytest.param(400, marks=pytest.mark.slow)])
@pytest.mark.filterwarnings("error")
def test_a_random_line_gives_numbers_or_one_line_of_refusal(capsys, folder, count):
    draw = random.Random(count)
    (folder / "flat.csv").write_text("force,speed\n" + "1,2\n" * 9)
    (folder / "nan.csv").write_text("force,speed\n" + "nan,2\n" * 9)
    (folder / "run.csv").write_text("time (s),bead 15 (N)\n" + "1,2\n2,3\n3,1\n")
    (folder / "paper.toml").write_text(example("paper"))
    for _ in range(count):
        for name, size in (
            ("pulses", 1.0),
            ("wild", draw.choice((1e300, 1e-300, 5e-324, 1e-9))),
        ):
            (folder / f"{name}.csv").write_text(pulses(draw, size))
        arguments = line(draw)
        status, out, err = ended(capsys, cli.main, *arguments)
        assert status in (0, 1, 2), arguments
        assert not re.search(r"\b(nan|inf)\b", out, re.IGNORECASE), arguments
        if status == 2:
            assert (out, err.count("\n")) == ("", 1), arguments
        elif "json" in arguments:
            json.loads(out)
