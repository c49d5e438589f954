"""The lattice runs of `limits` take ten seconds: once for all tests."""

import pytest

from validation.studies.limits import limits


@pytest.fixture(scope="session")
def limits_result():
    return limits()
