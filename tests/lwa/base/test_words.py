"""Words of options, messages and printed errors: what a user reads."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from lwa import Estimate, InputError
from lwa.base import LONGEST_MESSAGE, arrays, files
from lwa.base.words import CLOSURES, QUANTITIES, one_of, similar
from lwa.spheres.beads import FILE


class Unprintable:
    """A value of a user's class, whose repr fails."""

    def __repr__(self):
        raise RuntimeError


@pytest.mark.parametrize(
    ("value", "known", "words"),
    [
        ("Forces", QUANTITIES, "did you mean force?"),
        ("x", QUANTITIES, "one of strain, force, velocity is wanted"),
        (b"full", CLOSURES, "linear or full is wanted"),
        ("mm", ("", "SI"), "'mm': SI is wanted"),
        ("friction", FILE, "start, sensors is wanted"),
        (Unprintable(), CLOSURES, "type Unprintable"),
        ("9" * 10**6, CLOSURES, "'999"),
    ],
)
def test_another_word_is_refused_by_name_with_the_near_ones(value, known, words):
    with pytest.raises(InputError, match="option is ") as refusal:
        one_of(value, known, "option")
    assert words in str(refusal.value)


def test_a_part_of_a_name_finds_the_whole_whatever_its_case():
    assert similar("STEEL", ["steel 316", "PTFE", "steel 440C"]) == [
        "steel 316",
        "steel 440C",
    ]
    assert similar("", QUANTITIES) == []


def test_a_message_is_one_line_of_limited_length_and_ends_with_what_to_change():
    error = InputError("masses are\n" + "1, " * 999 + "end", closure="full", k=None)
    assert len(str(error)) <= LONGEST_MESSAGE
    assert "\n" not in str(error)
    assert str(error).endswith("end; try closure='full', k=None")
    assert len(error.reason) <= LONGEST_MESSAGE


@pytest.mark.parametrize("read", [arrays.finite, files.finite])
def test_masked_numbers_are_refused_by_name(read):
    with pytest.raises(InputError, match="force is"):
        read(np.ma.array([1.0], mask=[True]), "force")


sizes = st.floats(1e-280, 1e280)


@given(sizes, st.floats(1e-13, 10))
def test_a_printed_error_covers_the_printed_digits(size, relative):
    """± is rounded up by at most a fifth, and half of the value's last digit is below it."""
    for value in (size, -size):
        found = Estimate(value, relative * size)
        number, error = map(float, repr(found).split(" ± "))
        assert found.error * (1 - 1e-9) <= error <= 1.51 * found.error
        assert abs(number - value) <= 0.51 * error + 1e-15 * size


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (1.4119284, 3e-6, "1.411928 ± 3e-06"),
        (34.6712, 0.05, "34.67 ± 0.05"),
        (1.41, 1.21e-3, "1.4100 ± 0.0013"),
        (505e6, 3e6, "5.05e+08 ± 3e+06"),
        (0.0, 0.0144, "0 ± 0.015"),
        (2.5, 0.0, "2.5"),
        (2.54321, math.nan, "2.543, error unknown"),
    ],
)
def test_numbers_with_errors_are_printed_alike(value, error, text):
    assert repr(Estimate(value, error)) == text


def test_a_quotient_of_negative_numbers_has_a_positive_error():
    found = Estimate(1.0, 0.1) / Estimate(-2.0, 0.2)
    assert (found.value, found.error) == (-0.5, pytest.approx(0.1))
    assert float(found * -2) == 1.0
