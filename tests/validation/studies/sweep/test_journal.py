"""A sweep's file: what is finished is kept, what is torn is dropped, what is foreign refused."""

import json
import os
from contextlib import contextmanager

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import InputError
from validation.pulses.pulse import Measured
from validation.pulses.steady import QUANTITIES, Point
from validation.studies.sweep.journal import Journal

SETTINGS = {"stretch": 4}
R = sp.Rational


def made(k, omega, value=1.25):
    numbers = {name: Measured(value + i / 3, value) for i, name in enumerate(QUANTITIES)}
    return Point(R(k), R(omega), (24, 32), numbers)


POINTS = [
    made("3/2", 1),
    made("3/2", "1/9", 0.1 + 0.2),
    Point(R(2), R(1), None, {}, "it “broke”\n"),
]


def write(file, points=POINTS, settings=SETTINGS):
    journal = Journal(file, settings)
    for point in points:
        journal.add(point)
    return file


@pytest.fixture
def file(tmp_path):
    return write(tmp_path / "s.jsonl")


def test_points_come_back_bit_for_bit(file):
    assert list(Journal(file, SETTINGS).points.values()) == POINTS
    assert file.read_text().count("\n") == 1 + len(POINTS)
    write(file, [made(3, 1)])
    assert list(Journal(str(file), SETTINGS).points.values()) == [*POINTS, made(3, 1)]


def test_without_a_file_it_is_kept_in_memory():
    journal = Journal(None, SETTINGS)
    journal.add(POINTS[0])
    assert list(journal.points) == [(R(3, 2), R(1))]


def test_every_point_is_on_the_disk_before_the_next(tmp_path, monkeypatch):
    file, synced = tmp_path / "s.jsonl", []
    monkeypatch.setattr(os, "fsync", lambda _: synced.append(file.read_text().count("\n")))
    journal = Journal(file, SETTINGS)
    assert not file.exists()
    for point in POINTS:
        journal.add(point)
    assert synced == [2, 3, 4]


@given(st.integers(min_value=0, max_value=10_000))
def test_a_torn_end_costs_only_the_point_that_was_being_written(tmp_path_factory, cut):
    file = write(tmp_path_factory.mktemp("torn") / "s.jsonl")
    whole = file.read_bytes()
    content = whole[: cut % (len(whole) + 1)]
    file.write_bytes(content)
    journal = Journal(file, SETTINGS)
    finished = max(0, content.count(b"\n") - 1)
    assert list(journal.points.values()) == POINTS[:finished]
    assert file.read_bytes() == content  # until there is something to write
    for point in POINTS[finished:]:
        journal.add(point)
    if finished < len(POINTS):
        assert file.read_bytes() == whole


@pytest.fixture
def full_disk(monkeypatch):
    """A context in which the disk is full."""

    def full(_):
        raise OSError(28, "No space left on device")

    @contextmanager
    def context():
        with monkeypatch.context() as disk:
            disk.setattr(os, "fsync", full)
            with pytest.raises(InputError, match=r"s\.jsonl is not written: No space left on de"):
                yield

    return context


def test_a_full_disk_leaves_nothing_half_written(file, full_disk):
    before = file.read_bytes()
    journal = Journal(file, SETTINGS)
    with full_disk():
        journal.add(made(3, 1))
    assert file.read_bytes() == before
    assert (R(3), R(1)) not in journal.points


def test_a_disk_that_is_full_at_first_takes_the_whole_file_later(tmp_path, full_disk):
    """The next point began the file without its first line: it was no sweep's file any more."""
    file = tmp_path / "s.jsonl"
    journal = Journal(file, SETTINGS)
    with full_disk():
        journal.add(POINTS[0])
    journal.add(POINTS[1])
    assert list(Journal(file, SETTINGS).points.values()) == [POINTS[1]]


def test_another_sweeps_file_is_refused_and_left_alone(file):
    before = file.read_bytes()
    message = r"s\.jsonl is another sweep's, with settings {'stretch': 4}: .* for stretch = 5$"
    with pytest.raises(InputError, match=message):
        Journal(file, {"stretch": 5})
    assert file.read_bytes() == before


@pytest.mark.parametrize(
    ("line", "text", "message"),
    [
        (1, "{}", "is not a sweep's file: choose another name"),
        (1, "a,b", "is not a sweep's file: choose another name"),
        (1, "[1]", "is not a sweep's file: choose another name"),
        (
            1,
            '{"format": "lwa sweep", "version": 9, "settings": {"stretch": 4}}',
            "has version 9 of its format: 2 is wanted",
        ),
        (3, '{"k": "3/2"', "is damaged in line 3: it is not JSON"),
        (3, "", "is damaged in line 3: it is not JSON"),
        (2, "\xff", "is damaged in line 2: it is not JSON"),
        (2, "[]", "is damaged in line 2: the file is []: a table of keys is wanted"),
        (2, '{"k": "3/2"}', "is damaged in line 2: omega is missing"),
        (2, '{"k": "kk", "omega": 1}', "is damaged in line 2: k is 'kk': an integer"),
        (
            2,
            '{"k": 2, "omega": 1, "sites": [1, 2], "numbers": {}}',
            "is damaged in line 2: numbers.width is miss",
        ),
        (2, '{"k": 2, "omega": 1, "sight": 1}', "is damaged in line 2: sight is unknown"),
        (2, '{"k": 2, "omega": 1, "missing": 1}', "is damaged in line 2: missing is 1: a text"),
    ],
)
def test_damage_is_told_by_its_line(file, line, text, message):
    lines = file.read_bytes().splitlines()
    lines[line - 1] = text.encode("latin-1")
    file.write_bytes(b"\n".join(lines) + b"\n")
    with pytest.raises(InputError) as refused:
        Journal(file, SETTINGS)
    assert str(refused.value).startswith(f"{file} {message}")


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("width", "[1]"),
        ("width", "[1, NaN]"),
        ("speed", "[1, Infinity]"),
        ("decay", '["1", 2]'),
        ("decay", "1"),
    ],
)
def test_a_number_must_be_two_finite_ones(file, name, value):
    head, first, *rest = file.read_text().splitlines()
    entry = json.loads(first)
    entry["numbers"][name] = "HERE"
    torn = json.dumps(entry).replace('"HERE"', value)
    file.write_text("\n".join([head, torn, *rest]) + "\n")
    with pytest.raises(InputError, match=r"s\.jsonl is damaged in line 2: "):
        Journal(file, SETTINGS)


def test_a_point_may_be_there_twice_but_not_with_other_numbers(file):
    write(file, [POINTS[0]])  # two sweeps at once may do that
    assert list(Journal(file, SETTINGS).points.values()) == POINTS
    write(file, [made("3/2", 1, 7.0)])
    message = r"is damaged in line 6: it holds k = 3/2, ω = 1 again, with other numbers$"
    with pytest.raises(InputError, match=message):
        Journal(file, SETTINGS)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("s.json", r"file is .*s\.json: a file ending in \.jsonl is wanted"),
        ("no/s.jsonl", r"file is .*: the folder .*no does not exist"),
        ("folder.jsonl", r"file is .*: a regular file is wanted"),
    ],
)
def test_bad_files(tmp_path, name, message):
    (tmp_path / "folder.jsonl").mkdir()
    with pytest.raises(InputError, match=f"^{message}$"):
        Journal(tmp_path / name, SETTINGS)


def test_a_link_keeps_its_target_and_a_file_its_mode(tmp_path):
    target, link = tmp_path / "t", tmp_path / "s.jsonl"
    target.touch(0o640)
    link.symlink_to("t")
    write(link)
    assert link.is_symlink()
    assert target.stat().st_mode & 0o777 == 0o640
    assert list(Journal(link, SETTINGS).points.values()) == POINTS
