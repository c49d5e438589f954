"""What the hard cases' tests share."""

import pytest


@pytest.fixture
def failing():
    """The quantities of an outcome's findings that do not hold."""
    return lambda outcome: [finding.quantity for finding in outcome.findings if not finding.ok]
