"""Chains driven by a piston: the rules of `book/shocks.md`."""

import pytest

from book.studies.shock import shock


@pytest.mark.parametrize(
    "chain",
    [
        {"jumps": (3,)},
        {"k": "3/2", "jumps": (2, 8)},
        {"k": "3/2", "jumps": (1,), "ahead": 0},
    ],
)
def test_the_doubling_rule(chain):
    """Speed and peak within 0.6 %, 0.1 % between Toda's contacts; the plateau within 0.5 %."""
    assert shock(duration=300, **chain).ok
