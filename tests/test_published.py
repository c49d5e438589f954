"""Numbers that others published, beside ours: the rows of `book/literature.md`."""

import pytest

from book import published

# Largest differences to the published numbers, in the units of the rows; the page has the reasons
# of the large ones.
MOST = {
    "exponent": 1e-4, "equal": 0.7, "light": 0.7, "velocity": 0.25, "length": 0.5, "fwhm": 0.35,
    "duration": 2.5, "factor": 5e-3, "constant": 5e-3, "slow_pulls": 0.05, "fast_pulls": 0.05,
    "slow_pushes": 0.35, "fast_pushes": 1.9, "column_speed": 1.5e-3, "column_velocity": 5.5e-3,
    "column_displacement": 3e-3, "slow": 1e-3,
}  # fmt: skip


def test_ours_are_near():
    rows = published.rows()
    for name, most in MOST.items():
        assert abs(rows[name].off) < most, rows[name]
    here = {name: row.here for name, row in rows.items()}
    assert abs(here["speed"] + 0.8) < 0.05  # the sign is not given
    assert abs(here["overlap"]) < 0.014  # a bound
    assert here["loss_alike"] < 0.05  # "solitary", and "decays"
    assert here["loss_unlike"] > 25


@pytest.mark.slow
def test_deeper_down_the_column_the_top_counts():
    """Both exponents are beyond the published ones, towards -4/15 and -1/10."""
    deeper = published.column(3200)
    assert -4 / 15 < deeper["column_velocity"].here < -1 / 4
    assert -1 / 10 < deeper["column_displacement"].here < -0.09
