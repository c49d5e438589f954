"""Colliding pulses: the equation against the lattice, and symmetries of both."""

import json

import pytest
import sympy as sp
from click.testing import CliRunner

from book.studies.collision import collision, in_equation, on_lattice
from tests.commands import ended


def rows(document):
    return {(row["k"], row["quantity"]): row for row in document["rows"]}


@pytest.fixture(scope="module")
def hertz():
    """The command's document."""
    options = ["--k", "3/2", "--format", "json"]
    return json.loads(CliRunner().invoke(collision.command, options).stdout)


def test_the_equation_is_the_lattice_in_all_but_its_widths(hertz):
    assert hertz["ok"]
    found = {quantity: row["error_value"] for (_, quantity), row in rows(hertz).items()}
    assert found["speed"] == pytest.approx(-0.0122, abs=1e-4)
    assert found["FWHM of strain (sites)"] == pytest.approx(-0.189, abs=1e-3)
    assert abs(found["strain at x = 0, at most"]) < 0.01
    assert abs(found["strain after the collision"]) < 0.004


def test_a_collision_pushes_both_pulses_ahead(hertz):
    for side in ("equation", "lattice"):
        row = rows(hertz)["3/2", "shift by the collision (sites)"]
        assert 0.1 < row[f"{side}_value"] < 0.4
        assert row[f"{side}_error_value"] < 1e-4


@pytest.mark.slow
def test_nearer_to_k_1_the_equation_is_better(hertz):
    """A quarter of the width's error, a twentieth of the speed's, a third of the shift's."""
    near = rows(collision(exponents=(sp.Rational(11, 10),)).document())
    for (_, quantity), row in rows(hertz).items():
        assert abs(near["11/10", quantity]["error_value"]) < abs(row["error_value"]), quantity


@pytest.mark.parametrize("run", [in_equation, on_lattice])
def test_equal_pulses_meet_as_one_at_a_wall(run):
    """The beads at x = 0 rest in the mean, by symmetry: strains of both sides agree."""
    _, strains, numbers = run(sp.Rational(3, 2), 1.0, 1e-8, 601)
    assert abs(numbers["drift"]) < 1e-6
    assert numbers["meeting"] > 1
    assert numbers["after"] < 1
    assert strains[0, 0] < 1e-6


def test_a_bad_exponent_is_refused_in_one_line(capsys):
    status, _, err = ended(capsys, collision.main, "--second", "2")
    assert (status, err.count("\n")) == (2, 1)
