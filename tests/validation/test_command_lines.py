"""Random command lines of `lwa-validate`: each ends with a result or with one line that refuses."""

import json
import random
import re

import click
import pytest

from tests.commands import ended
from validation import cli
from validation.studies.run import example

TEXTS = (
    "0", "1", "-1", "3/2", "2", "5/4", "0.3428458", "1e-3", "1e300", "1e-300", "1e400",
    "nan", "inf", "x", "D", "1/0", "10", "-0", "1,2", "1,0.5", "1:2", "3:1", "1:2:3", "٣",
    "1e99999999", "0x10", "1_000", "[1]", "__import__('os')", "", "9" * 400, "steel 316",
    "time=x", "time", "a=b=c", "=", "time=ms", "force=2 N/V", "speed=m/s", "1=1", "time=1..e N/V",
    "1 force=1e999 N/V", "o.csv", "o.json", "x/y.csv", "p.svg", "p.doc", "s.sqlite", "😀", "\udcff",
)  # fmt: skip
FILES = (
    "pulses.csv", "flat.csv", "nan.csv", "wild.csv", "run.csv", "paper.toml", "none.csv", ".",
)  # fmt: skip
LONG = {"figures"}  # whatever their options are
NEEDED = {"sweep": {"--k", "--omega"}, "resonances": {"--count"}}
"""Options without which a command takes longer than a second."""
NEVER = {"--cluster", "--help"}  # a call to an address takes five seconds


def line(draw):
    """A random command line of the options that the commands have."""
    name = draw.choice(sorted(cli.STUDIES.keys() - LONG))
    words = [name]
    for option in cli.validate.resolve_command(None, [name])[1].params:
        flag = option.opts[0]
        if isinstance(option, click.Argument):
            words += draw.choices(FILES, k=draw.choice((1, 1, 1, 2)))
        elif flag not in NEVER and (
            flag in NEEDED.get(name, ()) or draw.random() < 0.3
        ):
            words.append(flag)
            if not option.is_flag:
                words.append(value(draw, option))
    return words


def value(draw, option):
    """A value of an option, one of its own words more often than not."""
    if isinstance(option.type, click.Choice) and draw.random() < 0.8:
        return draw.choice(option.type.choices)
    return draw.choice(FILES if draw.random() < 0.1 else TEXTS)


def pulses(draw, size):
    """A file of pulses of any size, with or without a law."""
    force = [size * draw.uniform(0.5, 3) for _ in range(9)]
    text = "force,speed\n"
    for F in force:
        V = draw.uniform(1, 2) * (F / size) ** draw.choice((0, 1 / 6, 0.3))
        text += f"{F!r},{V!r}\n"
    return text


@pytest.mark.parametrize("count", [40, pytest.param(400, marks=pytest.mark.slow)])
@pytest.mark.filterwarnings("error")
def test_a_random_line_gives_numbers_or_one_line_of_refusal(capsys, folder, count):
    draw = random.Random(count)
    (folder / "flat.csv").write_text("force,speed\n" + "1,2\n" * 9)
    (folder / "nan.csv").write_text("force,speed\n" + "nan,2\n" * 9)
    (folder / "run.csv").write_text("time (s),bead 15 (N)\n" + "1,2\n2,3\n3,1\n")
    (folder / "paper.toml").write_text(example("paper"))
    for _ in range(count):
        wild = draw.choice((1e300, 1e-300, 5e-324, 1e-9))
        for name, size in (("pulses", 1.0), ("wild", wild)):
            (folder / f"{name}.csv").write_text(pulses(draw, size))
        words = line(draw)
        status, out, err = ended(capsys, cli.main, *words)
        assert status in (0, 1, 2), words
        assert not re.search(r"\b(nan|inf)\b", out, re.IGNORECASE), words
        assert "Traceback" not in err, words
        if status == 2:
            assert (out, err.count("\n")) == ("", 1), words
            assert len(err) <= 320, words
        elif "json" in words and not {"--keys", "--example"} & {*words}:
            json.loads(out)
