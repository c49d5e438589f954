"""A test of an optional part is skipped where the part is missing, and fails where it must be."""

from types import SimpleNamespace

import pytest

from tests.conftest import COMPLETE, pytest_runtest_setup


def needing(*parts):
    return SimpleNamespace(iter_markers=lambda name: [SimpleNamespace(args=parts)])


def test_a_missing_part_skips_the_test_or_fails_it(monkeypatch):
    monkeypatch.delenv(COMPLETE, raising=False)
    pytest_runtest_setup(needing("json"))
    with pytest.raises(pytest.skip.Exception, match=r"^no_such_part is not installed$"):
        pytest_runtest_setup(needing("json", "no_such_part"))
    monkeypatch.setenv(COMPLETE, "1")
    pytest_runtest_setup(needing("json"))
    with pytest.raises(pytest.fail.Exception, match=r"^no_such_part is not installed$"):
        pytest_runtest_setup(needing("no_such_part"))
