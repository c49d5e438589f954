"""The pages whose cells make records and series: the cells are run, and their results judged."""

import contextlib
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom

from tests.book.prose import BOOK, CELL
from validation.pulses.pulse import first_pulse

sys.path.append(str(BOOK))  # the pages' own modules
from pulse import struck_pulse

pytestmark = pytest.mark.slow


def cells_of(page):
    """Names that the cells of a page define; IPython's lines are left out."""
    names = {}
    # The page's cells run in the folder of its record.
    with contextlib.chdir(BOOK):
        for _, code in CELL.findall(Path(f"{page}.md").read_text(encoding="utf-8")):
            exec(re.sub(r"^[%!].*$", "", code, flags=re.M), names)
    return names


@pytest.fixture(scope="module")
def page():
    return cells_of("experiment")


def test_errors_of_pulses_and_speeds_are_one_standard_deviation(page):
    """Of 48 arrivals, peaks and widths 26 to 39 are within one error, with 95 % probability."""
    off, speeds = [], []
    for one, run in zip(page["found"], page["runs"], strict=True):
        true = [first_pulse(run.signal("contact", contact)) for contact in (19, 39)]
        for row, pulse in zip(one["sensors"], true, strict=True):
            for name in ("arrival", "peak", "fwhm"):
                value = getattr(pulse, name) - (250e-6 if name == "arrival" else 0)
                off.append((row[f"{name}_value"] - value) / row[f"{name}_error_value"])
        speed, row = (
            20 * 19.05e-3 / (true[1].arrival - true[0].arrival),
            one["speeds"][0],
        )
        speeds.append((row["speed_value"] - speed) / row["speed_error_value"])
    assert binom.interval(0.95, len(off), 0.6827) == (26, 39)
    assert 26 <= np.count_nonzero(np.abs(off) < 1) <= 39
    assert 0.6 < np.mean(np.square(off)) < 1.5
    assert np.abs(off + speeds).max() < 3


def test_the_law_is_the_chains(page):
    fitted, A = page["fitted"].document(), float(page["chain"].stiffnesses[0])
    assert abs(fitted["k_value"] - 1.5) < fitted["k_error_value"] < 0.005
    assert abs(fitted["A_value"] - A) < fitted["A_error_value"] < 0.04 * A
    assert fitted["correlation_value"] > 0.9
    assert fitted["one_power"]


def test_the_simulation_agrees_with_the_record(page):
    rows = page["beside"].document()["rows"]
    assert len(rows) == 6
    for row in rows:
        assert abs(row["difference_value"]) < 3 * row["difference_error_value"]
        assert row["difference_error_value"] < 0.005 * row["simulated_value"]


def test_the_modulus_of_the_wall_is_read_within_its_error(page):
    read, true = page["read"], float(page["glass"].E)
    assert abs(read.value - true) < 3 * read.error < 0.1 * true


def test_the_decay_near_a_mass_ratio_of_0_57():
    early, late = (
        struck_pulse(1.5, "0.57", *ends).decay for ends in ((40, 80), (80, 160))
    )
    assert 6 < early / late < 7
