"""Answers of the command `lwa`, and a file of spheres for it."""

import json

from lwa.command.cli import main
from tests.commands import ended

STEEL_AND_PTFE = """
[materials]
steel = {E = 193e9, nu = 0.3}
ptfe = {E = 1.46e9, nu = 0.46}
[beads]
heavy = {mass = 0.45e-3, radius = 2.38e-3, material = "steel"}
light = {mass = 0.123e-3, radius = 2.38e-3, material = "ptfe"}
[chain]
cell = ["heavy", "light"]
"""
"""A file of the paper's dimer."""


def run(capsys, *arguments):
    """Exit status, standard output and standard error of one call."""
    return ended(capsys, main, *arguments)


def said(capsys, *arguments):
    """The standard output of a call that succeeds."""
    status, out, err = run(capsys, *arguments)
    assert (status, err) == (0, "")
    return out


def result(capsys, *arguments):
    """The JSON of a call that succeeds."""
    return json.loads(said(capsys, *arguments, "--format", "json"))
