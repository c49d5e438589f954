"""The engine, compiled once."""

import pytest


@pytest.fixture(scope="session", autouse=True)
def _engine(engine):
    """Compile the engine in one process of the tests."""
